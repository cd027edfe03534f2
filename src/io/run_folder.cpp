#include "io/run_folder.hpp"

#include "core/error.hpp"
#include "core/hash.hpp"
#include "io/file.hpp"
#include "io/json_text.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <filesystem>
#include <system_error>
#include <utility>

namespace toile::internal {
namespace {

constexpr std::string_view seal_key = "\"report_hash\": \"";
constexpr std::size_t hash_digits = 16;

std::string join(const std::string& directory, std::string_view name) {
  return (std::filesystem::path(directory) / name).string();
}

bool is_there(const std::string& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0;
}

// The contents of a JSON file of ours; empty when it does not exist or is not ours.
std::optional<Json> load_ours(const std::string& path) {
  if (!is_there(path)) return std::nullopt;
  try {
    Json json = Json::load(path);
    if (json.is_object() && json.find("toile_version") != nullptr) return json;
  } catch (const Error&) {  // not a file of ours: it lists nothing
  }
  return std::nullopt;
}

// The names that the JSON file lists as Toile's.
void add_listed(const std::string& path, std::vector<std::string>& names) {
  const std::optional<Json> json = load_ours(path);
  if (!json) return;
  const Json* files = json->find("files");
  if (files == nullptr || !files->is_object()) return;
  names.push_back(std::filesystem::path(path).filename().string());
  for (const auto& [name, what] : files->object()) names.push_back(name);
}

std::string host_name() {
  char name[256] = "";
  if (::gethostname(name, sizeof name - 1) != 0) return "";
  return printable(name);
}

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  char text[32] = "";
  if (::gmtime_r(&now, &utc) != nullptr) std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

// Opens the folder and locks it; -1 when another process has it.
int locked_folder(const std::string& directory) {
  const int folder = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) throw IoError(directory, "cannot open: " + std::generic_category().message(errno));
  int result;
  do {
    result = ::flock(folder, LOCK_EX | LOCK_NB);
  } while (result != 0 && errno == EINTR);
  if (result == 0) return folder;
  const int error = errno;
  ::close(folder);
  if (error == EWOULDBLOCK) return -1;
  throw IoError(directory, "cannot lock the folder: " + std::generic_category().message(error));
}

}  // namespace

std::optional<UnfinishedRun> read_unfinished_run(const std::string& directory) {
  const std::string path = join(directory, "unfinished.json");
  if (!is_there(path)) return std::nullopt;
  const Json json = Json::load(path);
  UnfinishedRun run;
  run.version = json.at("toile_version").string();
  for (const Json& word : json.at("arguments").array()) run.arguments.push_back(word.string());
  run.working_directory = json.at("working_directory").string();
  run.process = "process " + std::to_string(json.at("process").integer()) + " on " + json.at("host").string() +
                " since " + json.at("since").string() + ": " + printable(json.at("command").string());
  run.fps = json.number_or("fps", 0);
  run.body_vertices = static_cast<int>(std::clamp(json.number_or("body_vertices", 0), 0.0, 2e9));
  run.motion_first_frame = static_cast<int>(std::clamp(json.number_or("motion_first_frame", -1), -1.0, 2e9));
  if (const Json* rest_stretch = json.find("rest_stretch")) run.rest_stretch = *rest_stretch;
  return run;
}

bool is_written_to(const std::string& directory) {
  const int folder = locked_folder(directory);
  if (folder < 0) return true;
  ::close(folder);
  return false;
}

RunFolder::RunFolder(std::string directory, Use use, const Owner& owner, std::span<const std::string> inputs)
    : directory_(directory.empty() ? "." : std::move(directory)), use_(use), owner_(owner) {
  if (use_ == Use::new_run) {
    std::error_code ignored;
    std::filesystem::path part = std::filesystem::absolute(directory_).lexically_normal();
    if (!part.has_filename()) part = part.parent_path();
    for (; part.has_relative_path() && !std::filesystem::exists(part, ignored); part = part.parent_path())
      made_ = part.string();
    make_directories(directory_);
  }
  lock();
  try {
    refuse_inputs(inputs);
    if (use_ == Use::pictures) {
      refuse_strangers(picture_file_names);
      return;
    }
    was_unfinished_ = is_there(path("unfinished.json"));
    begun_ = use_ == Use::resume;
    if (begun_ && !was_unfinished_) throw IoError(directory_, "no unfinished run to go on with");
    refuse_strangers(run_file_names);
    const AtomicFile probe(path("report.json"));  // not committed: leaves nothing, but fails now if it must fail
    // An unfinished run can be resumed until another one begins: its unfinished.json stays.
    if (use_ == Use::new_run && !was_unfinished_) write_unfinished({});
  } catch (...) {
    undo();
    throw;
  }
}

RunFolder::~RunFolder() {
  if (use_ == Use::new_run && !begun_ && !was_unfinished_) ::unlink(path("unfinished.json").c_str());
  undo();
}

// A run that did not begin removes the folders that it created, as far as they are empty.
void RunFolder::undo() const {
  if (!begun_ && !made_.empty()) {
    std::filesystem::path part = std::filesystem::absolute(directory_).lexically_normal();
    if (!part.has_filename()) part = part.parent_path();
    std::error_code ignored;
    while (std::filesystem::remove(part, ignored) && part != made_) part = part.parent_path();
  }
  ::close(lock_);
}

std::string RunFolder::path(std::string_view name) const { return join(directory_, name); }

void RunFolder::lock() {
  lock_ = locked_folder(directory_);
  if (lock_ >= 0) return;
  std::string who = "another process of Toile";
  try {
    if (const auto run = read_unfinished_run(directory_)) who = run->process;
  } catch (const Error&) {  // it is being written at this moment
  }
  throw IoError(directory_, "another run writes here (" + who + "): wait for it, or name another folder with --out");
}

void RunFolder::refuse_strangers(std::span<const std::string_view> names) const {
  std::vector<std::string> listed;
  add_listed(path("report.json"), listed);
  add_listed(path("unfinished.json"), listed);
  for (const std::string_view name : names) {
    if (!is_there(path(name)) || std::find(listed.begin(), listed.end(), name) != listed.end()) continue;
    throw IoError(path(name),
                  "not written by an earlier run of Toile (no report.json there lists it), and would be "
                  "replaced: name another folder with --out, or move it away");
  }
}

void RunFolder::refuse_inputs(std::span<const std::string> inputs) const {
  std::error_code ignored;
  for (const std::string& input : inputs) {
    if (input.empty()) continue;
    if (std::filesystem::equivalent(input, directory_, ignored))
      throw IoError(printable(input),
                    "is an input of this run and the folder for its files: name another folder with --out");
    for (const std::string_view name : run_file_names)
      if (std::filesystem::equivalent(input, path(name), ignored))
        throw IoError(printable(input), "is an input of this run, which would write over it as " + path(name) +
                                            ": name another folder with --out");
  }
}

void RunFolder::write_unfinished(const std::function<void(JsonText&)>& facts) const {
  JsonText json;
  json.begin_object();
  json.member("toile_version", owner_.version);
  json.member("command", owner_.command);
  json.key("arguments");
  json.begin_array();
  for (const std::string& word : owner_.arguments) json.value(word);
  json.end_array();
  std::error_code ignored;
  json.member("working_directory", std::filesystem::current_path(ignored).string());
  json.member("process", static_cast<long>(::getpid()));
  json.member("host", host_name());
  json.member("since", now_utc());
  json.key("files");
  json.begin_object();
  for (const std::string_view name : run_file_names) {
    json.key(name);
    json.null();
  }
  json.end_object();
  if (facts) facts(json);
  json.end_object();
  AtomicFile file(path("unfinished.json"));
  file.write(json.str());
  file.write("\n");
  file.commit();
}

void RunFolder::begin() {
  begun_ = true;
  write_unfinished({});
  for (const std::string_view name : run_file_names) {  // the report is the first of them
    if (name == "unfinished.json") continue;
    remove_file(path(name));
    if (name == "report.json") synchronize_directory(directory_);
  }
}

void RunFolder::set_facts(const std::function<void(JsonText&)>& facts) { write_unfinished(facts); }

void RunFolder::finish(bool goes_on) {
  if (goes_on) return;
  remove_file(path("checkpoint.bin"));
  remove_file(path("unfinished.json"));
}

std::string sealed(std::string json_object) {
  while (!json_object.empty() && (json_object.back() == '\n' || json_object.back() == ' ')) json_object.pop_back();
  TOILE_ASSERT(json_object.size() > 2 && json_object.back() == '}');
  json_object.pop_back();
  while (json_object.back() == '\n' || json_object.back() == ' ') json_object.pop_back();
  json_object += ",\n  ";
  json_object += seal_key;
  json_object += hex_of(checksum(json_object.data(), json_object.size()));
  return json_object + "\"\n}";
}

bool is_intact(std::string_view text) {
  const std::size_t key = text.rfind(seal_key);
  if (key == std::string_view::npos) return false;
  const std::size_t value = key + seal_key.size();
  if (text.size() < value + hash_digits) return false;
  const std::string_view end = text.substr(value + hash_digits);
  return (end == "\"\n}\n" || end == "\"\n}") &&
         text.substr(value, hash_digits) == hex_of(checksum(text.data(), value));
}

}  // namespace toile::internal
