// core/error.hpp: what is thrown when the caller asked for something that cannot be meant.
//
// Three kinds of trouble and no fourth:
//   1. bad input, output or usage        an exception from this file; its code is the program's exit code
//   2. physics that goes badly           a status in a report, never an exception
//   3. a bug of ours                     TOILE_ASSERT, on unless NDEBUG
#pragma once
#include <cassert>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace toile::internal {

// The process exit codes of the command line; a contract with scripts.
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

class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

// One line: "<file>[:<line>[:<column>]]: <place>: expected <expected>, got <got>".
class InputError : public Error {
 public:
  // `where` is the file with its line, `place` the element in it ("/cloth/0/fabric", "face 12");
  // either may be empty.
  InputError(std::string_view where, std::string_view place, std::string_view expected, std::string_view got);
};

// A file that cannot be opened, read or written; names the path and the system's reason.
class IoError : public Error {
 public:
  IoError(std::string_view path, std::string_view what);
};

// `name` with control characters and bytes that are not UTF-8 replaced, and cut to a length fit for one line of a log.
std::string printable(std::string_view name);

// "a, b or c": what may stand somewhere.
std::string alternatives(std::span<const std::string> names);

// The candidate nearest to `name` by edit distance, for "did you mean"; empty when there is none.
std::string_view nearest_name(std::string_view name, const std::string_view* first, std::size_t count);

}  // namespace toile::internal

#define TOILE_ASSERT(expr) assert(expr)
