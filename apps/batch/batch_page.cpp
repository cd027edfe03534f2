// apps/batch/batch_page.cpp: index.html: page.html with the verdicts in it.
#include "batch_files.hpp"
#include "embedded.hpp"
#include "io/file.hpp"
#include "io/json_text.hpp"

#include <cstdint>
#include <filesystem>

namespace toile::internal {
namespace {

// Pictures are part of the page, some 10 kB each, up to a number that browsers still like; those of more jobs are read from the runs.
constexpr std::size_t most_pictures_within = 2000;

std::string base64(std::string_view bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    std::uint32_t three = 0;
    for (std::size_t j = 0; j < 3; ++j)
      three = three << 8 | (k + j < bytes.size() ? static_cast<unsigned char>(bytes[k + j]) : 0U);
    for (std::size_t j = 0; j < 4; ++j) text += k + j <= bytes.size() ? digits[three >> (18 - 6 * j) & 63] : '=';
  }
  return text;
}

std::string picture_of(const std::string& directory, const std::string& id, bool within) {
  const std::string name = "runs/" + id + "/thumbnail.png";
  const std::string path = (std::filesystem::path(directory) / name).string();
  if (!std::filesystem::exists(path)) return {};
  return within ? "data:image/png;base64," + base64(read_file(path)) : name;
}

// No text of a job can end the element that holds the data.
std::string within_script(std::string json) {
  for (std::size_t at = json.find('<'); at != std::string::npos; at = json.find('<', at))
    json.replace(at, 1, "\\u003c");
  return json;
}

}  // namespace

std::string page_of(const std::string& directory, const std::string& name, std::span<const JobVerdict> verdicts,
                    int jobs) {
  JsonText json(0);
  json.begin_object();
  json.member("name", name);
  json.member("jobs", jobs);
  json.key("verdicts");
  json.begin_array();
  for (const JobVerdict& verdict : verdicts) json.raw(verdict_line(verdict));
  json.end_array();
  json.key("pictures");
  json.begin_array();
  for (const JobVerdict& verdict : verdicts)
    json.value(picture_of(directory, verdict.id, verdicts.size() <= most_pictures_within));
  json.end_array();
  json.end_object();
  std::string page = embedded_text("apps/batch/page.html");
  constexpr std::string_view place = "@VERDICTS@";
  return page.replace(page.find(place), place.size(), within_script(json.str()));
}

}  // namespace toile::internal
