#include "job_verdict.hpp"

#include "exit_code.hpp"
#include "io/file.hpp"
#include "io/json.hpp"
#include "io/run_folder.hpp"
#include "job_record.hpp"
#include "worker_pool.hpp"

#include <cstring>
#include <filesystem>

namespace toile::internal {
namespace {

// Where the report has it.
struct FigureOfReport {
  std::string_view name;
  bool is_number;
  std::array<std::string_view, 3> keys;  // one within the other; empty: no more
};
constexpr std::array<FigureOfReport, 15> figures_of_report = {{
    {"ended", false, {"ended"}},
    {"input_hash", false, {"input_hash"}},
    {"state_hash", false, {"state_hash"}},
    {"vertices", true, {"cloth", "vertices"}},
    {"triangles", true, {"cloth", "triangles"}},
    {"frames", true, {"frames"}},
    {"stretch_p99", true, {"stretch", "p99"}},
    {"stretch_max", true, {"stretch", "max"}},
    {"stretch_gauge_p99", true, {"stretch", "gauge_p99"}},
    {"stretch_gauge_max", true, {"stretch", "gauge_max"}},
    {"cloth_body_edges", true, {"penetrations", "cloth_body_edges", "last"}},
    {"cloth_cloth_edges", true, {"penetrations", "cloth_cloth_edges", "last"}},
    {"gap_mm_p50", true, {"gap_mm", "p50"}},
    {"still_mm_per_s_p99", true, {"still", "speed_mm_per_s_p99"}},
    {"seconds_per_frame", true, {"seconds_per_frame", "total"}},
}};

// The report of a run that came to its end; empty when there is none, or it is damaged.
std::optional<Json> finished_report(const std::string& folder) {
  const std::filesystem::path place(folder);
  const std::string path = (place / "report.json").string();
  if (!std::filesystem::exists(path) || std::filesystem::exists(place / "unfinished.json")) return std::nullopt;
  try {
    const std::string text = read_file(path, Json::text_limit);
    if (!is_intact(text)) return std::nullopt;
    return Json::parse(text, printable(path));
  } catch (const Error&) {
    return std::nullopt;
  }
}

JobFigure figure_of(const std::optional<Json>& report, const FigureOfReport& wanted) {
  JobFigure figure{wanted.name, wanted.is_number, {}};
  const Json* at = report ? &*report : nullptr;
  for (const std::string_view key : wanted.keys)
    if (!key.empty() && at != nullptr) at = at->is_object() ? at->find(key) : nullptr;
  if (at != nullptr && wanted.is_number && at->is_number()) figure.value = at->number();
  if (at != nullptr && !wanted.is_number && at->is_string()) figure.value = at->string();
  return figure;
}

std::vector<Reason> reasons_of(const Json& report, std::string_view codes, std::string_view details) {
  std::vector<Reason> reasons;
  const Json* const told = report.find(details);
  for (const Json& code : report.at(codes).array())
    reasons.push_back({code.string(), told != nullptr ? told->string_or(code.string(), "") : ""});
  return reasons;
}

// Why a process that ended so left no verdict.  The codes are in docs/reason-codes.md.
Reason reason_without_verdict(const WorkerEnd& end, const JobLimits& limits) {
  if (end.stopped_by == stopped_by_its_limit)
    return {end.stopped_by, "not done within its " + std::to_string(static_cast<long>(limits.seconds)) +
                                " s; the batch goes on with it when it is started again"};
  if (end.signal != 0)
    return {"killed", "its process was ended by signal " + std::to_string(end.signal) + " (" +
                          std::string(::strsignal(end.signal)) + ")"};
  const auto code = [&]() -> const char* {
    switch (static_cast<ExitCode>(end.exit_code)) {
      case ExitCode::usage:
      case ExitCode::bad_input:
        return "bad_input";
      case ExitCode::bad_start:
        return "bad_start";
      case ExitCode::io:
        return "io";
      case ExitCode::resource_limit:
        return "resource_limit";
      case ExitCode::interrupted:
        return stopped_with_the_batch;
      default:
        return "internal";
    }
  };
  return {code(), end.message};
}

}  // namespace

std::string hash_of_finished_report(const std::string& folder) {
  const std::optional<Json> report = finished_report(folder);
  return report ? report->string_or("report_hash", "") : "";
}

std::optional<JobVerdict> verdict_of_job(const Job& job, const std::string& key, const std::string& folder) {
  const std::optional<JobRecord> record = read_job_record(folder);
  if (!record || record->key != key) return std::nullopt;
  std::optional<Json> report;
  if (record->reported) {
    report = finished_report(folder);
    if (!report) return std::nullopt;  // its files are gone, or others
  }
  JobVerdict verdict;
  verdict.id = job.id;
  verdict.line = job.line;
  verdict.key = key;
  verdict.words = record->words;
  try {
    if (report) {
      verdict.verdict = report->at("verdict").string();
      verdict.reasons = reasons_of(*report, "reasons", "reason_details");
      verdict.qualifications = reasons_of(*report, "qualifications", "qualification_details");
    }
  } catch (const InputError&) {  // a report of nobody's
    return std::nullopt;
  }
  // Beside a report it is about pictures, or says what the report does.
  if (!report || record->end.exit_code == static_cast<int>(ExitCode::io)) verdict.message = record->end.message;
  if (!report) {
    verdict.verdict = "error";
    verdict.reasons = {reason_without_verdict(record->end, job.limits)};
  }
  for (const FigureOfReport& wanted : figures_of_report) verdict.figures.push_back(figure_of(report, wanted));
  verdict.figures.push_back({"exit_code", true, static_cast<double>(record->end.exit_code)});
  verdict.figures.push_back({"seconds", true, record->end.seconds});
  verdict.figures.push_back({"cpu_seconds", true, record->end.cpu_seconds});
  verdict.figures.push_back({"memory_peak_mb", true, record->end.memory_peak_mb});
  return verdict;
}

}  // namespace toile::internal
