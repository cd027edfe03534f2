#include "sim/checkpoint.hpp"

#include "core/error.hpp"
#include "core/hash.hpp"
#include "core/stopwatch.hpp"
#include "io/file.hpp"

#include <bit>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

namespace toile::internal {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian, and so must the machine be");

constexpr std::string_view magic = "TOILESTATE";
constexpr std::uint32_t format = 8;  // changes with the order and the members that the classes remember
constexpr std::size_t head_bytes = magic.size() + sizeof format + 2 * sizeof(std::uint64_t);

double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class T>
T take(std::string_view& bytes) {
  T value;
  std::memcpy(&value, bytes.data(), sizeof value);
  bytes.remove_prefix(sizeof value);
  return value;
}

std::uint64_t checksum_of(std::string_view head, std::string_view state) {
  Hash sums;
  for (const std::uint64_t sum : {checksum(head.data(), head.size()), checksum(state.data(), state.size())})
    sums.add_bytes(&sum, sizeof sum);
  return sums.value();
}

}  // namespace

Checkpoints::Checkpoints(const RunWriter& writer, std::uint64_t input_hash, const CheckpointOptions& options)
    : writer_(&writer), input_hash_(input_hash), options_(options), last_s_(now_s()) {}

Checkpoints::~Checkpoints() {
  if (pending_.valid()) pending_.wait();
}

bool Checkpoints::due() {
  ++frames_;
  if (options_.every_frames > 0) return frames_ >= options_.every_frames;
  return now_s() - last_s_ >= options_.every_s &&
         (!pending_.valid() || pending_.wait_for(std::chrono::seconds(0)) == std::future_status::ready);
}

void Checkpoints::save(std::string state) {
  wait();
  frames_ = 0;
  last_s_ = now_s();
  auto write = [writer = writer_, input_hash = input_hash_, state = std::move(state)] {
    writer->synchronize();
    std::string head(magic);
    append(head, format);
    append(head, input_hash);
    append(head, static_cast<std::uint64_t>(state.size()));
    AtomicFile file(writer->path("checkpoint.bin"));
    file.write(head);
    file.write(state);
    const std::uint64_t sum = checksum_of(head, state);
    file.write(&sum, sizeof sum);
    file.commit();
  };
  try {
    pending_ = std::async(std::launch::async, write);
  } catch (const std::system_error&) {  // no thread available
    write();
  }
}

void Checkpoints::wait() {
  if (pending_.valid()) pending_.get();
}

std::optional<std::string> read_checkpoint(const std::string& path, std::uint64_t input_hash) {
  if (!std::filesystem::exists(path)) return std::nullopt;
  const std::string file = read_file(path);
  const auto refuse = [&](std::string_view place, std::string_view expected, const std::string& got) {
    throw InputError(printable(path), place, expected, got);
  };
  std::string_view bytes = file;
  if (bytes.size() < head_bytes + sizeof(std::uint64_t) || !bytes.starts_with(magic))
    refuse("header", "a state of a run of Toile", std::to_string(bytes.size()) + " bytes of something else");
  bytes.remove_prefix(magic.size());
  if (const auto found = take<std::uint32_t>(bytes); found != format)
    refuse("format", std::to_string(format) + ", which this program writes", std::to_string(found));
  const auto inputs = take<std::uint64_t>(bytes);
  const auto size = take<std::uint64_t>(bytes);
  if (size != bytes.size() - sizeof(std::uint64_t))
    refuse("size", std::to_string(size) + " bytes of state", std::to_string(bytes.size() - sizeof(std::uint64_t)));
  std::string state(bytes.substr(0, static_cast<std::size_t>(size)));
  bytes.remove_prefix(static_cast<std::size_t>(size));
  if (take<std::uint64_t>(bytes) != checksum_of(std::string_view(file).substr(0, head_bytes), state))
    refuse("checksum", "that of the state", "another: the file has changed");
  if (inputs != input_hash)
    refuse("input_hash", hex_of(input_hash) + ", that of the scene and its files now", hex_of(inputs));
  return state;
}

}  // namespace toile::internal
