#include "verify/integrity.hpp"

#include "core/hash.hpp"
#include "io/file.hpp"
#include "io/run_folder.hpp"

#include <filesystem>

namespace toile::internal {
namespace {

std::string join(const std::string& directory, std::string_view name) {
  return (std::filesystem::path(directory) / name).string();
}

}  // namespace

Integrity::Integrity(const std::string& directory, std::string_view text, const Json& report)
    : files_(report.find("files")) {
  if (!is_intact(text)) changes_.emplace_back("report.json is not as it was written, by its report_hash");
  if (files_ == nullptr || !files_->is_object()) {
    files_ = nullptr;
    return;
  }
  for (const auto& [name, file] : files_->object()) {
    if (!file.is_object()) continue;  // a picture
    const std::string path = join(directory, name);
    if (!std::filesystem::exists(path)) {
      changes_.push_back(printable(name) + " is not there");
    } else if (const Json* sum = file.find("checksum")) {
      if (sum->string() != checksum_of_file(path)) changes_.push_back(printable(name) + " is not as it was written");
    }
  }
}

Integrity::Inputs Integrity::check_inputs(const std::string& directory, const Json& report) {
  Inputs result;
  const Json* inputs = report.find("inputs");
  if (inputs == nullptr) return result;
  for (const Json& input : inputs->array()) {
    ++result.known;
    const std::string& seen = input.at("path").string();
    const std::string path = join(directory, seen);  // `seen` itself when it is absolute
    if (!std::filesystem::is_regular_file(path)) {
      ++result.missing;
    } else if (checksum_of_file(path) != input.at("checksum").string()) {
      result.changed.push_back(seen);
    }
  }
  return result;
}

const Json* Integrity::entry(std::string_view name) const {
  const Json* file = files_ == nullptr ? nullptr : files_->find(name);
  return file != nullptr && file->is_object() ? file : nullptr;
}

void Integrity::check_header(std::string_view name, const Pc2Reader& reader) {
  const Json* file = entry(name);
  if (file == nullptr) {
    changes_.push_back(std::string(name) + " is not among the files of the report");
    return;
  }
  const std::size_t written = file->at("frame_checksums").array().size();
  if (written != static_cast<std::size_t>(reader.samples()))
    changes_.push_back(std::string(name) + " has " + std::to_string(reader.samples()) + " frames, and " +
                       std::to_string(written) + " were written");
  else if (file->at("header_checksum").string() != hex_of(reader.header_checksum()))
    changes_.push_back(std::string(name) + ": its header is not as it was written");
}

void Integrity::check_frame(std::string_view name, int frame, const Pc2Reader& reader) {
  const Json* file = entry(name);
  if (file == nullptr) return;
  const Json::Array& frames = file->at("frame_checksums").array();
  if (static_cast<std::size_t>(frame) < frames.size() &&
      frames[static_cast<std::size_t>(frame)].string() != hex_of(reader.frame_checksum()))
    changes_.push_back(std::string(name) + ": frame " + std::to_string(frame) + " is not as it was written");
}

void Integrity::check_cache(const std::string& directory, std::string_view name) {
  if (entry(name) == nullptr || !std::filesystem::exists(join(directory, name))) return;
  Pc2Reader reader(join(directory, name));
  check_header(name, reader);
  std::vector<Vec3> x;
  for (int frame = 0; frame < reader.samples(); ++frame) {
    reader.read(frame, x);
    check_frame(name, frame, reader);
  }
}

}  // namespace toile::internal
