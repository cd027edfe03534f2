// tests/generated/generated_scenes.cpp: runs generated scenes and says which of them break a property, and how to repeat it.
#include "generated/properties.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal::generated {
namespace {

constexpr const char* usage =
    "toile_generated --program TOILE [--first N] [--count N] [--every N] [--jobs N] [--limit SECONDS]\n"
    "                [--memcheck VALGRIND [--suppressions FILE]] [--keep DIR]\n"
    "toile_generated --program TOILE --scene N --keep DIR     one scene; its files stay\n"
    "toile_generated --list                                   features, and the pairs of them\n";

struct Options {
  CheckOptions check;
  long first = 0, count = 150, every = 1, jobs = 1;
  std::string keep;
  bool list = false;
};

std::string own_path() { return std::filesystem::read_symlink("/proc/self/exe").string(); }

// Runs those of one job; returns how many broke a property.
int run_job(const Options& options, long job) {
  const std::string base =
      options.keep.empty()
          ? (std::filesystem::temp_directory_path() / ("toile-generated-" + std::to_string(getpid()))).string()
          : options.keep;
  std::map<std::string, int> ends;
  int broken = 0;
  for (long k = job; k < options.count; k += options.jobs) {
    const long number = options.first + k * options.every;
    const GeneratedScene scene = generate_scene(static_cast<std::uint64_t>(number));
    CheckOptions check = options.check;
    check.directory = base + "/scene-" + std::to_string(number);
    std::filesystem::remove_all(check.directory);
    std::filesystem::create_directories(check.directory);
    const auto before = std::chrono::steady_clock::now();
    const Checked checked = check_properties(scene, check);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
    ++ends[checked.skipped ? "without its start" : std::string("exit code ").append(std::to_string(checked.exit_code))];
    if (options.count == 1 || std::getenv("TOILE_GENERATED_VERBOSE") != nullptr)
      std::printf("scene %ld: exit code %d, %.2f s: %s\n", number, checked.exit_code, seconds,
                  describe(scene.choice).c_str());
    for (const std::string& violation : checked.violations) std::printf("scene %ld: %s\n", number, violation.c_str());
    if (!checked.violations.empty()) {
      ++broken;
      std::printf("  %s\n  again: %s --program %s --scene %ld --keep DIR\n", describe(scene.choice).c_str(),
                  own_path().c_str(), options.check.program.c_str(), number);
    }
    std::fflush(stdout);
    if (options.keep.empty()) std::filesystem::remove_all(check.directory);
  }
  std::printf("job %ld:", job);
  for (const auto& [end, count] : ends) std::printf(" %d %s,", count, end.c_str());
  std::printf(" %d with a broken property\n", broken);
  if (options.keep.empty()) std::filesystem::remove_all(base);
  std::fflush(stdout);
  return broken;
}

int list() {
  const Space& space = scene_space();
  const std::vector<ValuePair> possible = possible_pairs(space);
  const std::vector<Choice> rows = covering_rows(space);
  for (const Axis& axis : space.axes()) {
    std::printf("%s:", std::string(axis.name).c_str());
    for (const std::string_view value : axis.values) std::printf(" %s,", std::string(value).c_str());
    std::printf("\n");
  }
  std::printf("%zu features with %zu values; %zu pairs of values that can meet, all in %zu scenes but %zu\n",
              space.axes().size(), space.value_count(), possible.size(), rows.size(),
              missing_pairs(space, possible, rows).size());
  return 0;
}

bool read_words(int argc, char** argv, Options& options) {
  for (int k = 1; k < argc; ++k) {
    const std::string_view word = argv[k];
    if (word == "--list") {
      options.list = true;
      continue;
    }
    if (k + 1 == argc) return false;
    const std::string value = argv[++k];
    const long count = std::strtol(value.c_str(), nullptr, 10);
    if (word == "--program") {
      options.check.program = std::filesystem::absolute(value).string();
    } else if (word == "--first") {
      options.first = count;
    } else if (word == "--count") {
      options.count = count;
    } else if (word == "--every") {
      options.every = count;
    } else if (word == "--jobs") {
      options.jobs = count > 0 ? count : sysconf(_SC_NPROCESSORS_ONLN);
    } else if (word == "--limit") {
      options.check.limit_s = static_cast<int>(count);
    } else if (word == "--scene") {
      options.first = count;
      options.count = 1;
    } else if (word == "--memcheck") {
      options.check.valgrind = value;
    } else if (word == "--suppressions") {
      options.check.suppressions = value;
    } else if (word == "--keep") {
      options.keep = std::filesystem::absolute(value).string();
    } else {
      return false;
    }
  }
  return options.list || !options.check.program.empty();
}

int main(int argc, char** argv) {
  Options options;
  if (!read_words(argc, argv, options)) {
    std::fputs(usage, stderr);
    return 2;
  }
  if (options.list) return list();
  if (options.jobs == 1) return run_job(options, 0) == 0 ? 0 : 1;
  std::fflush(stdout);
  std::vector<pid_t> jobs;
  for (long job = 0; job < options.jobs; ++job) {
    const pid_t child = fork();
    if (child == 0) _exit(run_job(options, job) == 0 ? 0 : 1);
    jobs.push_back(child);
  }
  bool good = true;
  for (const pid_t job : jobs) {
    int status = 0;
    waitpid(job, &status, 0);
    good &= WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }
  return good ? 0 : 1;
}

}  // namespace
}  // namespace toile::internal::generated

int main(int argc, char** argv) { return toile::internal::generated::main(argc, argv); }
