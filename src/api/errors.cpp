#include "api/parts.hpp"

#include <cmath>
#include <string>

namespace toile {
namespace {

// The code of errors other than InputError and IoError.
ErrorCode code_of(internal::ErrorKind kind) {
  switch (kind) {
    case internal::ErrorKind::usage:
      return ErrorCode::usage;
    case internal::ErrorKind::bad_input:
      return ErrorCode::bad_input;
    case internal::ErrorKind::bad_start:
      return ErrorCode::bad_start;
    case internal::ErrorKind::io:
      return ErrorCode::input_output;
    case internal::ErrorKind::resource_limit:
      return ErrorCode::resource_limit;
    case internal::ErrorKind::simulation_failed:  // in the library both are in a report
    case internal::ErrorKind::interrupted:
    case internal::ErrorKind::internal:
      return ErrorCode::internal;
  }
  return ErrorCode::internal;
}

}  // namespace

void require_finite(const char* what, const Point& p) {
  for (const double x : p)
    if (!std::isfinite(x)) throw internal::InputError("", what, "finite numbers", std::to_string(x));
}

void require_above_zero(const char* what, double value) {
  if (!std::isfinite(value) || !(value > 0))
    throw internal::InputError("", what, "a finite number above zero", std::to_string(value));
}

void require_at_least_zero(const char* what, double value) {
  if (!std::isfinite(value) || value < 0)
    throw internal::InputError("", what, "a finite number that is not below zero", std::to_string(value));
}

void require_pressure(const char* what, double Pa) {
  if (!(std::abs(Pa) <= internal::most_pressure_Pa))
    throw internal::InputError("", what, "a number of at most 1e5 on either side of zero", std::to_string(Pa));
}

void throw_translated() {
  try {
    throw;
  } catch (const Error&) {
    throw;
  } catch (const internal::InputError& error) {
    throw InputError(error.what());
  } catch (const internal::IoError& error) {
    throw IoError(error.what());
  } catch (const internal::Error& error) {
    // Adding the name of its file turns an InputError into an Error.
    if (error.kind() == internal::ErrorKind::bad_input) throw InputError(error.what());
    throw Error(code_of(error.kind()), error.what());
  } catch (const std::bad_alloc&) {
    throw Error(ErrorCode::resource_limit, "there is not enough memory");
  }
}

}  // namespace toile
