// apps/cli/main.cpp: the program `toile`.  It always ends with one of the codes of exit_code.hpp and, if
// that is not 0 or the verdict of a run, with one line on stderr.
#include "commands.hpp"
#include "core/parallel.hpp"
#include "io/json_text.hpp"
#include "terminal.hpp"

#include <algorithm>
#include <cstdio>
#include <new>

namespace toile::internal {
namespace {

ExitCode run_command(const CommandLine& line) {
  switch (line.command) {
    case CommandLine::Command::help:
      print(line.help);
      return ExitCode::ok;
    case CommandLine::Command::demo:
    case CommandLine::Command::dress:
    case CommandLine::Command::run:
      return simulate_command(line);
    case CommandLine::Command::resume:
      return resume_command(line);
    case CommandLine::Command::check:
      return check_command(line);
    case CommandLine::Command::verify:
      return verify_command(line);
    case CommandLine::Command::preview:
      return preview_command(line);
    case CommandLine::Command::untangle:
      return untangle_command(line);
    case CommandLine::Command::export_run:
      return export_command(line);
    case CommandLine::Command::fit_fabric:
      return fit_fabric_command(line);
    case CommandLine::Command::bench:
      return bench_command(line);
    case CommandLine::Command::batch:
      return batch_command(line);
  }
  return ExitCode::internal;
}

ExitCode fail(ExitCode code, const char* message, bool json) noexcept {
  std::fprintf(stderr, "toile: %s\n", message);
  if (json) {
    try {
      JsonText text(0);
      text.begin_object();
      text.member("exit_code", static_cast<int>(code));
      text.member("error", message);
      text.end_object();
      std::printf("%s\n", text.str().c_str());
    } catch (...) {
      return code;
    }
  }
  return code;
}

// The least of the threads asked for, the usable cores, and the threads that the system gives.
int threads_for(const CommandLine& line) {
  const int cores = usable_cores(), wanted = line.threads == 0 ? cores : std::min(line.threads, cores);
  if (line.threads > cores && !line.quiet)
    std::fprintf(stderr,
                 "toile: warning: --threads %d: there are %d cores to use, and more threads would only be slower\n",
                 line.threads, cores);
  const int given = start_threads(wanted);
  if (given < wanted && !line.quiet)
    std::fprintf(stderr, "toile: warning: the system gives %d threads instead of %d\n", given, wanted);
  return given;
}

ExitCode guarded_main(int argc, char** argv) noexcept {
  const bool json = wants_json(argc, argv);
  try {
    prepare_for_the_end(json);
    const CommandLine line = parse_command_line(argc, argv);
    ExitCode code = ExitCode::internal;
    using Command = CommandLine::Command;
    // A batch only waits for processes, and starts them from the thread that lives as long as the program (apps/batch/worker.cpp).
    if (line.command == Command::help || line.command == Command::batch) return run_command(line);
    with_threads(threads_for(line), [&] { code = run_command(line); });
    return code;
  } catch (const Error& error) {
    return fail(exit_code(error.kind()), error.what(), json);
  } catch (const std::bad_alloc&) {
    return fail(ExitCode::resource_limit, "out of memory", json);
  } catch (const std::exception& error) {
    return fail(ExitCode::internal, (std::string("internal error: ") + error.what()).c_str(), json);
  } catch (...) {
    return fail(ExitCode::internal, "internal error", json);
  }
}

}  // namespace
}  // namespace toile::internal

int main(int argc, char** argv) { return static_cast<int>(toile::internal::guarded_main(argc, argv)); }
