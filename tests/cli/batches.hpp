// tests/cli/batches.hpp: scenes and job files of small batches, and their verdicts.
#pragma once
#include "cli/program.hpp"
#include "io/json.hpp"

#include <chrono>
#include <csignal>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace toile::internal::test {

// Falls freely: some 20 ms.
inline constexpr const char* falling =
    R"({"cloth": [{"grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": 0.05}}], "time": {"seconds": 0.2}})";
// Its pins go half a metre apart.
inline constexpr const char* torn = R"({"cloth": [{"grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": 0.05}, "pins": [
  {"near_m": [-0.15, 0.15, 0]}, {"near_m": [0.15, 0.15, 0], "hold": "path", "path_m": [[0, 0.15, 0.15, 0], [0.2, 0.65, 0.15, 0]]}]}],
  "time": {"seconds": 0.2}})";
// On a cylinder, for a second of wall time or so.
inline constexpr const char* draping = R"({"cloth": [
  {"grid": {"width_m": 0.5, "height_m": 0.5, "edge_m": 0.03}, "placement": {"translation_m": [0, 0.21, 0], "rotation_deg": [-90, 0, 0]}}],
  "body": {"cylinder": {"radius_m": 0.1, "height_m": 0.4, "top_m": [0, 0.2, 0]}}, "time": {"seconds": 2}})";
// Nobody waits for it.
inline constexpr const char* endless =
    R"({"cloth": [{"grid": {"edge_m": 0.03}, "pins": [{"near_m": [0, 0, 0]}]}], "time": {"seconds": 600}})";

// Those that differ from one start to the next.
inline const std::set<std::string> measured = {"seconds", "cpu_seconds", "memory_peak_mb", "seconds_per_frame"};

struct Verdicts {
  std::vector<std::string> ids;                // in the order of the file
  std::map<std::string, Json> of;              // by id
  std::map<std::string, std::string> lasting;  // everything that does not differ, by id
};

inline std::string text_of(const Json& json) {
  if (json.is_array()) {
    std::string text;
    for (const Json& one : json.array()) text += text_of(one) + ' ';
    return text;
  }
  if (!json.is_object()) return json.describe();
  std::string text;
  for (const auto& [name, value] : json.object())
    if (!measured.contains(name)) text += name + "=" + text_of(value) + '\n';
  return text;
}

inline Verdicts verdicts_of(const Scratch& scratch, const std::string& folder) {
  Verdicts verdicts;
  const std::string text = scratch.get(folder + "/verdicts.jsonl");
  for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) {
    Json json = Json::parse(text.substr(at, text.find('\n', at) - at), "verdicts.jsonl");
    const std::string id = json.at("id").string();
    verdicts.ids.push_back(id);
    verdicts.lasting[id] = text_of(json);
    verdicts.of.emplace(id, std::move(json));
  }
  return verdicts;
}

inline std::string first_reason(const Json& verdict) {
  return verdict.at("reasons").array().empty() ? "" : verdict.at("reasons").array().front().string();
}

inline bool wait_until(const std::function<bool()>& done) {
  for (int k = 0; k < 3000 && !done(); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return done();
}

// Of the process; by the system.
inline std::vector<pid_t> children_of(pid_t process) {
  const std::string number = std::to_string(process);
  std::ifstream file("/proc/" + number + "/task/" + number + "/children");
  return {std::istream_iterator<pid_t>(file), {}};
}
inline bool lives(pid_t process) { return kill(process, 0) == 0; }

// The process of a run that goes on; 0: none yet.
inline pid_t process_of(const Scratch& scratch, const std::string& run) {
  try {
    return static_cast<pid_t>(Json::parse(scratch.get(run + "/unfinished.json"), "unfinished").at("process").integer());
  } catch (const Error&) {
    return 0;
  }
}

}  // namespace toile::internal::test
