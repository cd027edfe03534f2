// body/numbered_files.cpp: finds the files of a sequence of frames.
#include "body/body_samples.hpp"
#include "core/error.hpp"
#include "io/mesh_file.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <span>
#include <system_error>

namespace toile::internal {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t digits_at_most = 15;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Parses a number of digits only.
std::int64_t value(std::string_view text) {
  std::int64_t n = 0;
  for (const char c : text) n = 10 * n + (c - '0');
  return n;
}

bool all_digits(std::string_view text) {
  return !text.empty() && text.size() <= digits_at_most && std::all_of(text.begin(), text.end(), is_digit);
}

// A file name without its number.
struct Pattern {
  std::string before, after;
  std::size_t width = 0;  // 0: any; otherwise padded with zeros to this width

  std::optional<std::int64_t> number_in(std::string_view name) const {
    if (name.size() <= before.size() + after.size() || !name.starts_with(before) || !name.ends_with(after))
      return std::nullopt;
    const std::string_view middle = name.substr(before.size(), name.size() - before.size() - after.size());
    if (!all_digits(middle)) return std::nullopt;
    if (width > 0 && (middle.size() < width || (middle.size() > width && middle.front() == '0'))) return std::nullopt;
    return value(middle);
  }
};

// "walk_%04d.obj" -> {"walk_", ".obj", 4}.
std::optional<Pattern> pattern_of(std::string_view name) {
  const std::size_t percent = name.find('%');
  if (percent == std::string_view::npos) return std::nullopt;
  std::size_t end = percent + 1;
  while (end < name.size() && is_digit(name[end])) ++end;
  const std::string_view width = name.substr(percent + 1, end - percent - 1);
  if (end >= name.size() || name[end] != 'd' || name.find('%', end) != std::string_view::npos) return std::nullopt;
  if (!width.empty() && (width.size() > 3 || width.front() != '0')) return std::nullopt;
  return Pattern{std::string(name.substr(0, percent)), std::string(name.substr(end + 1)),
                 static_cast<std::size_t>(value(width))};
}

// Around the last number in the stem of a file's name.
std::optional<Pattern> around_last_number(std::string_view name) {
  const std::size_t stem = name.rfind('.');  // of a name with an extension
  std::size_t end = stem;
  while (end > 0 && !is_digit(name[end - 1])) --end;
  std::size_t begin = end;
  while (begin > 0 && is_digit(name[begin - 1])) --begin;
  if (begin == end || end - begin > digits_at_most) return std::nullopt;
  return Pattern{std::string(name.substr(0, begin)), std::string(name.substr(end))};
}

// The first mesh extension that any file has: a folder of OBJ files may hold other files.
std::string_view ending_of_frames(std::span<const std::string> names) {
  for (const MeshReader& reader : mesh_readers())
    for (const std::string_view ending : reader.endings)
      if (std::any_of(names.begin(), names.end(), [&](const std::string& name) { return name.ends_with(ending); }))
        return ending;
  return mesh_readers().front().endings.front();
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error))
    names.push_back(i->path().filename().string());
  if (error) throw IoError(folder.string(), "cannot list the folder: " + error.message());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

std::vector<NumberedFile> numbered_files(const std::string& path) {
  const bool is_folder = fs::is_directory(path);
  const fs::path folder = is_folder ? fs::path(path) : fs::path(path).parent_path();
  std::optional<Pattern> pattern;
  if (!is_folder) {
    pattern = pattern_of(fs::path(path).filename().string());
    if (!pattern)
      throw InputError(printable(path), "body sequence", "a folder, a .pc2 file, or a file name with one %d or %04d",
                       "none of these");
  }
  std::vector<NumberedFile> frames;
  const std::vector<std::string> names = names_in(folder.empty() ? fs::path(".") : folder);
  const std::string_view ending = ending_of_frames(names);
  for (const std::string& name : names) {
    const std::string file = (folder / name).string();
    if (is_folder) {
      if (!name.ends_with(ending)) continue;
      const auto around = around_last_number(name);
      if (!around) throw InputError(printable(file), "body sequence", "a number in the name of every frame", "none");
      if (!pattern) pattern = around;
      if (around->before != pattern->before || around->after != pattern->after)
        throw InputError(printable(file), "body sequence",
                         "a name like " + printable(pattern->before) + "<number>" + printable(pattern->after) +
                             ", as the other frames (or give a pattern with %d)",
                         printable(name));
    }
    if (const auto number = pattern->number_in(name)) frames.push_back({*number, file});
  }
  if (frames.empty()) throw InputError(printable(path), "body sequence", "numbered files of meshes", "none");
  std::sort(frames.begin(), frames.end(), [](const NumberedFile& a, const NumberedFile& b) {
    return a.number < b.number || (a.number == b.number && a.path < b.path);
  });
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const std::int64_t expected = frames[i - 1].number + 1, got = frames[i].number;
    if (got != expected)
      throw InputError(printable(frames[i].path), "body sequence", "frame number " + std::to_string(expected),
                       got < expected ? std::to_string(got) + " twice" : std::to_string(got));
  }
  return frames;
}

}  // namespace toile::internal
