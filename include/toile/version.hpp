// toile/version.hpp: the version of the library.
#pragma once
#include "toile/export.hpp"

namespace toile {

// The version of the running library, "0.1.0": major, minor, patch.  Below 1.0 a new minor version may change these headers.
TOILE_EXPORT const char* version() noexcept;

}  // namespace toile
