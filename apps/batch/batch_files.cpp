#include "batch_files.hpp"

#include "io/file.hpp"
#include "io/json_text.hpp"

#include <algorithm>
#include <filesystem>

namespace toile::internal {
namespace {

void add_reasons(JsonText& json, std::string_view codes, std::string_view details, const std::vector<Reason>& reasons) {
  json.key(codes);
  json.begin_array();
  for (const Reason& reason : reasons) json.value(reason.code);
  json.end_array();
  json.key(details);
  json.begin_object();
  for (const Reason& reason : reasons) json.member(reason.code, reason.detail);
  json.end_object();
}

void write_file(const std::string& directory, const char* name, const std::string& bytes) {
  AtomicFile file((std::filesystem::path(directory) / name).string());
  file.write(bytes);
  file.commit();
}

}  // namespace

BatchCounts count(std::span<const JobVerdict> verdicts, int jobs) {
  BatchCounts counts;
  counts.jobs = jobs;
  std::map<std::string, int> reasons;
  for (const JobVerdict& verdict : verdicts) {
    ++(verdict.passed() ? counts.passed : verdict.is_error() ? counts.errors : counts.failed);
    if (!verdict.passed()) ++reasons[verdict.reasons.empty() ? "" : verdict.reasons.front().code];
  }
  counts.reasons.assign(reasons.begin(), reasons.end());
  std::stable_sort(counts.reasons.begin(), counts.reasons.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  return counts;
}

std::string verdict_line(const JobVerdict& verdict) {
  JsonText json(0);
  json.begin_object();
  json.member("id", verdict.id);
  json.member("line", verdict.line);
  json.member("verdict", verdict.verdict);
  add_reasons(json, "reasons", "reason_details", verdict.reasons);
  add_reasons(json, "qualifications", "qualification_details", verdict.qualifications);
  for (const JobFigure& figure : verdict.figures) {
    json.key(figure.name);
    if (const auto* number = std::get_if<double>(&figure.value)) {
      json.value(*number);
    } else if (const auto* text = std::get_if<std::string>(&figure.value)) {
      json.value(*text);
    } else {
      json.null();
    }
  }
  json.member("key", verdict.key);
  json.member("message", verdict.message);
  json.key("command");
  json.begin_array();
  for (const std::string& word : verdict.words) json.value(word);
  json.end_array();
  json.member("folder", "runs/" + verdict.id);
  json.end_object();
  return json.str();
}

void write_batch_files(const std::string& directory, const std::string& name, std::span<const JobVerdict> verdicts,
                       int jobs) {
  std::string lines;
  for (const JobVerdict& verdict : verdicts) lines += verdict_line(verdict) + '\n';
  write_file(directory, "verdicts.jsonl", lines);
  if (can_index()) write_file(directory, "index.sqlite", index_of(verdicts));
  write_file(directory, "index.html", page_of(directory, name, verdicts, jobs));
}

}  // namespace toile::internal
