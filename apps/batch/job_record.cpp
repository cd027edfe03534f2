#include "job_record.hpp"

#include "io/file.hpp"
#include "io/json.hpp"
#include "io/json_text.hpp"
#include "sim/report.hpp"

#include <filesystem>

namespace toile::internal {
namespace {

std::string record_path(const std::string& folder) { return (std::filesystem::path(folder) / "job.json").string(); }

}  // namespace

void write_job_record(const std::string& folder, const JobRecord& record) {
  JsonText json;
  json.begin_object();
  json.member("toile_version", toile_version());
  json.member("id", record.id);
  json.member("key", record.key);
  json.key("command");
  json.begin_array();
  for (const std::string& word : record.words) json.value(word);
  json.end_array();
  json.member("reported", record.reported);
  json.member("exit_code", record.end.exit_code);
  json.member("signal", record.end.signal);
  json.member("stopped_by", record.end.stopped_by);
  json.member("message", record.end.message);
  json.member("seconds", record.end.seconds);
  json.member("cpu_seconds", record.end.cpu_seconds);
  json.member("memory_peak_mb", record.end.memory_peak_mb);
  json.end_object();
  make_directories(folder);
  AtomicFile file(record_path(folder));
  file.write(json.str());
  file.write("\n");
  file.commit();
}

std::optional<JobRecord> read_job_record(const std::string& folder) {
  const std::string path = record_path(folder);
  if (!std::filesystem::exists(path)) return std::nullopt;
  try {
    const Json json = Json::load(path);
    JobRecord record;
    record.id = json.at("id").string();
    record.key = json.at("key").string();
    for (const Json& word : json.at("command").array()) record.words.push_back(word.string());
    record.reported = json.at("reported").boolean();
    record.end.exit_code = static_cast<int>(json.at("exit_code").integer());
    record.end.signal = static_cast<int>(json.at("signal").integer());
    record.end.stopped_by = json.at("stopped_by").string();
    record.end.message = json.at("message").string();
    record.end.seconds = json.at("seconds").number();
    record.end.cpu_seconds = json.at("cpu_seconds").number();
    record.end.memory_peak_mb = json.at("memory_peak_mb").number();
    return record;
  } catch (const Error&) {  // the job runs again
    return std::nullopt;
  }
}

void remove_job_record(const std::string& folder) { remove_file(record_path(folder)); }

}  // namespace toile::internal
