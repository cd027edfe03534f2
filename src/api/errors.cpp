#include "api/parts.hpp"

namespace toile {

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
    throw Error(static_cast<ErrorCode>(error.code()), error.what());
  } catch (const std::bad_alloc&) {
    throw Error(ErrorCode::resource_limit, "there is not enough memory");
  }
}

}  // namespace toile
