// apps/bench/bench_command.cpp: `toile bench`: runs a benchmark, and prints the machine and the results.
#include "bench.hpp"
#include "commands.hpp"
#include "core/parallel.hpp"
#include "io/file.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

namespace toile::internal {
namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  std::string line;
  while (std::getline(file, line)) {
    if (!line.starts_with("model name")) continue;
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) return printable(line.substr(colon + 2));
  }
  return "unknown";
}

double load() {
  std::array<double, 1> minutes{};
  return getloadavg(minutes.data(), 1) == 1 ? minutes[0] : -1;
}

void write(const std::string& path, std::string_view text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

BenchResult run_bench(BenchRuns& runs) {
  const std::string& kind = runs.line().inputs.front();
  if (kind == "scaling") return bench_scaling(runs);
  if (kind == "micro") return bench_micro(runs);
  if (kind == "paper") return bench_paper(runs);
  if (kind == "stiffness") return bench_stiffness(runs);
  if (kind == "torture") return bench_torture(runs);
  throw Error(ErrorKind::internal, "bench: " + kind);
}

}  // namespace

ExitCode bench_command(const CommandLine& line) {
  const double load_before = load();
  BenchRuns runs(line);
  BenchResult result = run_bench(runs);
  result.facts.add("toile_version", "version", std::string(toile_version()));
  result.facts.add("processor", "processor", processor());
  result.facts.add("cores", "cores", static_cast<long>(std::thread::hardware_concurrency()));
  result.facts.add("threads", "threads", static_cast<long>(available_threads()));
  result.facts.add("repeats", "repeats", static_cast<long>(line.repeats));
  result.facts.add("load_before", "load of the machine before", load_before, 2);
  if (!line.out.empty()) {
    const std::filesystem::path folder(line.out);
    const std::string name(result.bench);
    write((folder / (name + ".json")).string(), as_json(result));
    write((folder / (name + ".csv")).string(), as_csv(result));
  }
  if (line.json) {
    print(as_json(result));
  } else if (line.csv) {
    print(as_csv(result));
  } else if (!line.quiet) {
    print(as_text(result));
  }
  if (interrupted()) {
    std::fprintf(stderr, "toile: bench %s: interrupted\n", std::string(result.bench).c_str());
    return ExitCode::interrupted;
  }
  if (result.complete) return ExitCode::ok;
  std::fprintf(stderr, "toile: bench %s: a run did not reach its end: see reasons\n",
               std::string(result.bench).c_str());
  return ExitCode::simulation_failed;
}

}  // namespace toile::internal
