// toile/error.hpp: the exceptions of the library.
//
// Invalid input throws; a failed simulation does not: it comes back in a report, in words (simulation.hpp).  A call that throws has changed
// nothing.
#pragma once
#include "toile/export.hpp"

#include <stdexcept>
#include <string>

namespace toile {

// Also the exit codes of the program.
enum class ErrorCode {
  usage = 2,           // a call in the wrong order, or an option that is out of its range
  bad_input = 3,       // a file or an array with invalid contents
  bad_start = 4,       // cloth that intersects itself or the body at the start, where that is to be an error
  input_output = 6,    // a file that cannot be read or written
  resource_limit = 7,  // more than the machine has
  internal = 9,        // a bug of Toile
};

class TOILE_EXPORT Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ErrorCode code() const noexcept { return code_; }

 private:
  ErrorCode code_;
};

// "<file>[:<line>]: <place>: expected <expected>, got <got>"
class TOILE_EXPORT InputError : public Error {
 public:
  explicit InputError(const std::string& message) : Error(ErrorCode::bad_input, message) {}
};

// Names the path and the system's reason.
class TOILE_EXPORT IoError : public Error {
 public:
  explicit IoError(const std::string& message) : Error(ErrorCode::input_output, message) {}
};

}  // namespace toile
