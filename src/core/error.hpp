// core/error.hpp: the exceptions, for invalid input and usage.
//
// There are three kinds of failure:
//   1. bad input, output or usage        an exception from this file
//   2. a simulation that fails           a status in a report, never an exception
//   3. a bug of ours                     TOILE_ASSERT, on unless NDEBUG
#pragma once
#include <cassert>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace toile::internal {

enum class ErrorKind {
  usage,              // a call in the wrong order, or an option that is out of range
  bad_input,          // a file or an array with invalid contents
  bad_start,          // cloth that intersects itself or the body at the start, where that is to be an error
  simulation_failed,  // a simulation did not reach the state that was needed
  io,                 // a file that cannot be read or written
  resource_limit,     // more than the machine has, or than was allowed
  interrupted,        // the caller asked for an end, and there is no result
  internal,           // a bug of ours
};

class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  ErrorKind kind() const { return kind_; }

 private:
  ErrorKind kind_;
};

// One line: "<file>[:<line>[:<column>]]: <place>: expected <expected>, got <got>".
class InputError : public Error {
 public:
  // `where` is the file with its line, `place` the element in it ("/cloth/0/fabric", "face 12");
  // either may be empty.
  InputError(std::string_view where, std::string_view place, std::string_view expected, std::string_view got);

  // The same, about the element at `path` of a model ("/cloth/0/pins/2"): the caller that read the model from a file adds file and line
  // (io/json_places.hpp).
  InputError of(std::string_view path) const;
  // The same with `where` before its message, unless that begins with it.
  InputError within(std::string_view where) const;

  const std::string& path() const { return path_; }
  const std::string& where() const { return where_; }
  const std::string& place() const { return place_; }
  const std::string& expected() const { return expected_; }
  const std::string& got() const { return got_; }

 private:
  InputError(const std::string& message, const InputError& like);

  std::string path_, where_, place_, expected_, got_;
};

// A file that cannot be opened, read or written; names the path and the system's reason.
class IoError : public Error {
 public:
  IoError(std::string_view path, std::string_view what);
};

// `name` with control characters and bytes that are not UTF-8 replaced, and cut to a length fit for one line of a log.
std::string printable(std::string_view name);

// "a, b or c": the allowed words.
std::string alternatives(std::span<const std::string> names);

// The candidate nearest to `name` by edit distance, for "did you mean"; empty when there is none.
std::string_view nearest_name(std::string_view name, const std::string_view* first, std::size_t count);

}  // namespace toile::internal

#define TOILE_ASSERT(expr) assert(expr)
