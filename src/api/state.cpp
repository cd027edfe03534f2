// api/state.cpp: a simulation between two frames, as bytes and back.
//
//   "TOILESIM"  uint32 format  uint64 input hash  interaction  state of the engine  uint64 checksum of all before
#include "api/implementation.hpp"
#include "core/hash.hpp"
#include "core/state_archive.hpp"
#include "io/file.hpp"

#include <cstring>

namespace toile {
namespace {

constexpr std::string_view magic = "TOILESIM";
constexpr std::uint32_t format = 3;
constexpr std::size_t head_bytes = magic.size() + sizeof format + sizeof(std::uint64_t);

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class T>
T read_at(std::string_view bytes, std::size_t place) {
  T value;
  std::memcpy(&value, bytes.data() + place, sizeof value);
  return value;
}

[[noreturn]] void refuse(const char* place, const std::string& expected, const std::string& got) {
  throw internal::InputError("state", place, expected, got);
}

// The bytes between head and checksum.
std::string_view checked(std::string_view bytes, std::uint64_t input_hash) {
  constexpr std::size_t sum_bytes = sizeof(std::uint64_t);
  if (bytes.size() < head_bytes + sum_bytes || !bytes.starts_with(magic))
    refuse("header", "a state of a simulation", std::to_string(bytes.size()) + " bytes of something else");
  const auto found = read_at<std::uint32_t>(bytes, magic.size());
  if (found != format) refuse("format", std::to_string(format), std::to_string(found));
  const std::string_view before = bytes.substr(0, bytes.size() - sum_bytes);
  if (read_at<std::uint64_t>(bytes, before.size()) != internal::checksum(before.data(), before.size()))
    refuse("checksum", "that of its bytes", "another: they are not whole");
  const auto inputs = read_at<std::uint64_t>(bytes, magic.size() + sizeof format);
  if (inputs != input_hash)
    refuse("input_hash", internal::hex_of(input_hash) + ", that of this simulation's cloth, body and options",
           internal::hex_of(inputs));
  return before.substr(head_bytes);
}

}  // namespace

State State::load(const std::string& path) {
  return translated([&] { return State(internal::read_file(path)); });
}

void State::save(const std::string& path) const {
  translated([&] {
    internal::AtomicFile file(path);
    file.write(bytes_);
    file.commit();
  });
}

State Simulation::state() const {
  return translated([&] {
    Implementation& own = *implementation_;
    own.live("state");
    std::string bytes(magic);
    append(bytes, format);
    append(bytes, own.recipe->input_hash);
    internal::StateWriter archive;
    archive(own.interaction);
    bytes += archive.take();
    bytes += own.engine->state();
    append(bytes, internal::checksum(bytes.data(), bytes.size()));
    return State(std::move(bytes));
  });
}

void Simulation::set_state(const State& state) {
  translated([&] {
    const Implementation& old = *implementation_;
    const std::string_view bytes = checked(state.bytes(), old.recipe->input_hash);
    // A new object: an invalid state leaves the old one unchanged, and nothing of the old one remains after a valid state.
    auto fresh = std::make_unique<Implementation>(old.recipe);
    fresh->take_up(bytes);
    implementation_ = std::move(fresh);
  });
}

}  // namespace toile
