#include "generated/properties.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "exit_code.hpp"
#include "generated/child.hpp"
#include "sim/simulate.hpp"

#include <malloc.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <new>

namespace toile::internal::generated {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, const std::string& bytes) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// What a run left, but for its times.
struct Left {
  Ended ended;
  std::string state_hash;
  std::map<std::string, std::string> files;  // meshes and caches
};

Left what_is_left(const Ended& ended, const fs::path& directory) {
  Left left{ended, {}, {}};
  constexpr std::string_view key = "\"state_hash\": \"";
  const std::string report = read(directory / "report.json");
  if (const std::size_t at = report.find(key); at != std::string::npos)
    left.state_hash = report.substr(at + key.size(), report.find('"', at + key.size()) - at - key.size());
  if (!fs::exists(directory)) return left;
  for (const auto& entry : fs::directory_iterator(directory)) {
    const std::string ending = entry.path().extension().string();
    if (ending == ".pc2" || ending == ".obj") left.files[entry.path().filename().string()] = read(entry.path());
  }
  return left;
}

class Checker {
 public:
  Checker(const GeneratedScene& scene, const CheckOptions& options)
      : scene_(scene), options_(options), at_(options.directory) {}

  Checked operator()() {
    for (const TextFile& file : scene_.files) write(at_ / file.name, file.bytes);
    write(at_ / "scene.json", scene_.scene);
    if (!scene_.earlier.empty()) {
      write(at_ / "earlier.json", scene_.earlier);
      const Ended earlier =
          program({"run", "earlier.json", "--threads", "1", "--no-preview", "--quiet", "--out", "earlier"}, {});
      check_end("the run that it starts from", earlier);
      if (!fs::exists(at_ / "earlier/report.json") || !fs::exists(at_ / "earlier/cloth.pc2")) {
        checked_.skipped = true;
        return checked_;
      }
    }
    const Ended read = program({"check", "scene.json", "--quiet"}, {});
    if (read.exit_code != 0) {
      violate("check: " + read.text());
      return checked_;
    }
    if (options_.valgrind.empty()) {
      check_runs();
    } else {
      check_memory();
    }
    return checked_;
  }

 private:
  void violate(const std::string& what) { checked_.violations.push_back(what); }

  Ended program(std::vector<std::string> words, std::vector<std::string> environment) const {
    words.insert(words.begin(), options_.program);
    return run_program(at_, at_ / "log.txt", options_.limit_s, std::move(words), std::move(environment));
  }

  bool is_good(const Ended& ended) const {
    return ended.signal == 0 && !ended.hung &&
           (ended.exit_code == 0 || ended.exit_code == 5 || ended.exit_code == 8 ||
            (ended.exit_code == 4 && scene_.may_refuse_start));
  }

  bool check_end(const std::string& which, const Ended& ended) {
    const bool good = is_good(ended);
    if (!good) violate(which + ": " + ended.text());
    return good;
  }

  // As the program does, in a child of this one.
  Left in_process(const std::string& name, const std::string& text, int threads, int perturb) const {
    write(at_ / (name + ".json"), text);
    const Ended ended = run_child(at_ / "log.txt", options_.limit_s, [&] {
      mallopt(M_PERTURB, perturb);
      fs::current_path(at_);
      try {
        RunOptions run;
        run.directory = name;
        run.command = "generated";
        ExitCode code = ExitCode::internal;
        const SceneFile scene = read_scene(text, name + ".json");
        scene.places.complete_errors_of(
            [&] { with_threads(threads, [&] { code = exit_code(outcome(simulate(scene.scene, run))); }); });
        return static_cast<int>(code);
      } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return static_cast<int>(exit_code(error.kind()));
      } catch (const std::exception& error) {
        std::fprintf(stderr, "internal error: %s\n", error.what());
        return static_cast<int>(ExitCode::internal);
      }
    });
    return what_is_left(ended, at_ / name);
  }

  void check_runs() {
    const Left first =
        what_is_left(program({"run", "scene.json", "--threads", "1", "--no-preview", "--quiet", "--out", "first"},
                             {"MALLOC_PERTURB_=90"}),
                     at_ / "first");
    checked_.exit_code = first.ended.exit_code;
    if (!check_end("run", first.ended)) return;
    // All at once; what it was is asked for only when something differs.
    if (!scene_.begins_to_move && differences(first, in_process("all", scene_.with_both, 3, 165), false).empty())
      return;
    compare("three threads and other memory", first, in_process("again", scene_.scene, 3, 165), true);
    if (!scene_.with_far_solid.empty())
      compare("a solid far away", first, in_process("solid", scene_.with_far_solid, 1, 90), false);
    compare("defaults written out", first, in_process("defaults", scene_.with_defaults, 1, 90), true);
  }

  void compare(const std::string& what, const Left& first, const Left& other, bool same_body) {
    const std::string differs = differences(first, other, same_body);
    if (!differs.empty()) violate(what + ": " + differs);
  }

  // What differs; empty: nothing.  Without `same_body` another solid is there.
  std::string differences(const Left& first, const Left& other, bool same_body) const {
    const bool longer = !same_body && scene_.begins_to_move;
    if (other.ended.exit_code != first.ended.exit_code && !longer)
      return "first " + first.ended.text() + "; then " + other.ended.text();
    if (!is_good(other.ended)) return other.ended.text();
    for (const auto& [name, bytes] : first.files) {
      if (!same_body && (name == "body.obj" || name == "body.pc2" || name == "offenders.obj")) continue;
      const auto place = other.files.find(name);
      if (place == other.files.end()) return "no " + name;
      if (longer && name == "cloth.pc2") {
        if (!same_frames(bytes, place->second)) return name + " differs in a frame that both have";
      } else if (place->second != bytes) {
        return name + " differs";
      }
    }
    if (longer) return {};
    if (same_body && other.files.size() != first.files.size()) return "other files";
    if (other.state_hash != first.state_hash) return "state_hash " + first.state_hash + ", then " + other.state_hash;
    return {};
  }

  // Behind the headers, which hold how many there are.
  static bool same_frames(const std::string& a, const std::string& b) {
    constexpr std::size_t header = 32;
    const std::size_t common = std::min(a.size(), b.size());
    return common > header && a.compare(header, common - header, b, header, common - header) == 0;
  }

  void check_memory() {
    constexpr int error = 99;
    std::vector<std::string> words = {options_.valgrind, "--quiet", "--error-exitcode=" + std::to_string(error),
                                      "--num-callers=20"};
    if (!options_.suppressions.empty()) words.push_back("--suppressions=" + options_.suppressions);
    for (const char* word : {"run", "scene.json", "--threads", "1", "--no-preview", "--quiet", "--out", "first"})
      words.emplace_back(word);
    words.insert(words.end() - 8, options_.program);
    const Ended ended = run_program(at_, at_ / "log.txt", 60 * options_.limit_s, std::move(words));
    checked_.exit_code = ended.exit_code;
    if (check_end("run under memcheck", ended) && ended.message.find("==") != std::string::npos)
      violate("memcheck: " + ended.message);
  }

  const GeneratedScene& scene_;
  const CheckOptions& options_;
  const fs::path at_;
  Checked checked_;
};

}  // namespace

Checked check_properties(const GeneratedScene& scene, const CheckOptions& options) { return Checker(scene, options)(); }

}  // namespace toile::internal::generated
