#include "job_file.hpp"

#include "core/error.hpp"
#include "io/file.hpp"
#include "io/json_line.hpp"
#include "preview/preview.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>

namespace toile::internal {
namespace {

constexpr std::size_t longest_id = 100;  // file systems take 255 bytes, and users append to them
constexpr std::array<std::string_view, 3> commands = {"dress", "run", "demo"};
// What the batch itself says to each of its processes.
constexpr std::array<std::string_view, 6> kept = {"out", "quiet", "json", "help", "list", "version"};

template <class List>
bool is_in(std::string_view word, const List& list) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

bool fits_id(std::string_view id) {
  const auto plain = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '_' ||
           c == '.' || c == '+';
  };
  return !id.empty() && id.size() <= longest_id && id.front() != '.' && id.front() != '-' && id.back() != '.' &&
         std::all_of(id.begin(), id.end(), plain);
}

std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

// As a person would type it; a whole number without an exponent, which options that count do not take.
std::string word_of(double x) {
  std::array<char, 32> text;
  constexpr double exact = 9007199254740992.0;  // 2^53
  const bool whole = x == std::trunc(x) && std::abs(x) < exact;
  const auto end = whole ? std::to_chars(text.data(), text.data() + text.size(), static_cast<long long>(x)).ptr
                         : std::to_chars(text.data(), text.data() + text.size(), x).ptr;
  return {text.data(), end};
}

// A file is never taken for an option.
std::string as_file(const std::string& name) { return name.starts_with('-') ? "./" + name : name; }

using Options = std::map<std::string, Json>;

void set_options(const Json& object, Options& options) {
  for (const auto& [name, value] : object.object()) {
    if (is_in(name, commands) || name == "id") continue;
    if (is_in(name, kept)) value.fail("an option that is a job's own", '"' + name + "\", which the batch sets");
    if (name.find_first_of("= ") != std::string::npos || name.starts_with('-'))
      value.fail("the name of an option, without dashes before it", '"' + printable(name) + '"');
    if (value.is_array() || value.is_object()) value.fail("a string, a number, true, false or null", value.describe());
    options.insert_or_assign(name, value);
  }
}

double take_limit(Options& options, const std::string& name, double otherwise) {
  const auto found = options.find(name);
  if (found == options.end()) return otherwise;
  const Json value = found->second;
  options.erase(found);
  if (value.is_null()) return otherwise;
  if (!(value.number() >= 0)) value.fail("0 (none) or more", value.describe());
  return value.number();
}

// The command and what it is of.
std::vector<std::string> first_words(const Json& object) {
  std::vector<std::string> words;
  for (const std::string_view command : commands) {
    const Json* what = object.find(command);
    if (what == nullptr) continue;
    if (!words.empty()) what->fail("one of \"dress\", \"run\" and \"demo\"", "two of them");
    words.emplace_back(command);
    if (!what->is_array()) {
      words.push_back(as_file(what->string()));
      continue;
    }
    if (command != "dress" || what->array().empty()) what->fail("the name of one file", what->describe());
    for (const Json& pattern : what->array()) words.push_back(as_file(pattern.string()));
  }
  if (words.empty()) object.fail("\"dress\", \"run\" or \"demo\"", "none of them");
  return words;
}

void add_options(const Options& options, std::vector<std::string>& words) {
  for (const auto& [name, value] : options) {
    if (value.is_null() || (value.is_boolean() && !value.boolean())) continue;
    std::string word = "--" + name;
    if (value.is_string()) word += '=' + value.string();
    if (value.is_number()) word += '=' + word_of(value.number());
    words.push_back(std::move(word));
  }
  // One core each, and a picture for the list of them.
  if (!options.contains("threads")) words.emplace_back("--threads=1");
  if (!options.contains("thumbnail") && can_draw()) words.emplace_back("--thumbnail");
}

CommandLine parsed(const std::vector<std::string>& words, const Json& object) {
  std::vector<const char*> arguments{"toile"};
  for (const std::string& word : words) arguments.push_back(word.c_str());
  try {
    return parse_command_line(static_cast<int>(arguments.size()), arguments.data());
  } catch (const Error& error) {
    object.fail("options that `toile " + words.front() + "` takes", error.what());
  }
}

Job job_of(const Json& object, int line, const Options& defaults, const JobLimits& limits) {
  Job job;
  job.line = line;
  const Json& id = object.at("id");
  job.id = id.string();
  if (!fits_id(job.id))
    id.fail("a name of up to " + std::to_string(longest_id) +
                " letters, digits and - _ . +, that begins with none of - and .",
            id.describe());
  Options options = defaults;
  set_options(object, options);
  job.limits.seconds = take_limit(options, "limit-seconds", limits.seconds);
  job.limits.memory_mb = take_limit(options, "limit-memory", limits.memory_mb);
  job.words = first_words(object);
  add_options(options, job.words);
  job.command = parsed(job.words, object);
  return job;
}

Options defaults_of(const Json& object) {
  object.allow_only({"defaults"});
  const Json& defaults = object.at("defaults");
  for (const auto& [name, value] : defaults.object())
    if (is_in(name, commands) || name == "id") value.fail("options of all jobs", '"' + name + '"');
  Options options;
  set_options(defaults, options);
  return options;
}

}  // namespace

JobFile read_job_file(const std::string& path, const JobLimits& limits) {
  const std::string text = read_file(path);
  JobFile file;
  Options defaults;
  std::map<std::string, int> lines;  // by the id, which file systems may not tell from another case of it
  std::string_view rest = text;
  if (rest.starts_with("\xef\xbb\xbf")) rest.remove_prefix(3);
  while (!rest.empty()) {
    const std::string_view one = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), one.size() + 1));
    ++file.lines;
    if (one.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    const Json object = parse_json_line(one, path, file.lines);
    if (object.find("defaults") != nullptr) {
      if (file.lines > 1) object.fail("\"defaults\" in the first line only", "them here");
      defaults = defaults_of(object);
      continue;
    }
    Job job = job_of(object, file.lines, defaults, limits);
    if (const auto [first, is_new] = lines.emplace(lower_case(job.id), file.lines); !is_new)
      object.at("id").fail("an id of its own",
                           '"' + job.id + "\", which line " + std::to_string(first->second) + " has");
    file.jobs.push_back(std::move(job));
  }
  if (file.jobs.empty()) throw InputError(printable(path), "", "at least one job", "none");
  return file;
}

}  // namespace toile::internal
