// apps/cli/exit_code.hpp: the exit codes of the program.                                          docs/command-line.md
#pragma once
#include "core/error.hpp"
#include "sim/simulate.hpp"

namespace toile::internal {

// A contract with scripts: the numbers stay.
enum class ExitCode {
  ok = 0,
  usage = 2,
  bad_input = 3,
  bad_start = 4,
  simulation_failed = 5,
  io = 6,
  resource_limit = 7,
  interrupted = 8,
  internal = 9,
};

constexpr ExitCode exit_code(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::usage:
      return ExitCode::usage;
    case ErrorKind::bad_input:
      return ExitCode::bad_input;
    case ErrorKind::bad_start:
      return ExitCode::bad_start;
    case ErrorKind::simulation_failed:
      return ExitCode::simulation_failed;
    case ErrorKind::io:
      return ExitCode::io;
    case ErrorKind::resource_limit:
      return ExitCode::resource_limit;
    case ErrorKind::interrupted:
      return ExitCode::interrupted;
    case ErrorKind::internal:
      return ExitCode::internal;
  }
  return ExitCode::internal;
}

constexpr ExitCode exit_code(Outcome outcome) {
  switch (outcome) {
    case Outcome::passed:
      return ExitCode::ok;
    case Outcome::failed:
      return ExitCode::simulation_failed;
    case Outcome::interrupted:
      return ExitCode::interrupted;
  }
  return ExitCode::internal;
}

}  // namespace toile::internal
