// errors.cpp: toile::Error becomes toile.Error, one to one; the classes are in toile/_errors.py.
#include "module.hpp"

#include <toile/error.hpp>

namespace toile::python {

namespace nb = nanobind;

namespace {

const char* name_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::usage:
      return "usage";
    case ErrorCode::bad_input:
      return "bad_input";
    case ErrorCode::bad_start:
      return "bad_start";
    case ErrorCode::input_output:
      return "input_output";
    case ErrorCode::resource_limit:
      return "resource_limit";
    case ErrorCode::internal:
      return "internal";
  }
  return "internal";
}

void raise(const char* type, const Error& error) {
  const nb::object made = nb::module_::import_("toile._errors").attr(type)(error.what());
  made.attr("code") = name_of(error.code());
  PyErr_SetObject(made.type().ptr(), made.ptr());
}

void translate(const std::exception_ptr& thrown, void*) {
  try {
    std::rethrow_exception(thrown);
  } catch (const InputError& error) {
    raise("InputError", error);
  } catch (const IoError& error) {
    raise("IoError", error);
  } catch (const Error& error) {
    raise("Error", error);
  }
}

}  // namespace

void bind_errors(nb::module_&) { nb::register_exception_translator(translate); }

}  // namespace toile::python
