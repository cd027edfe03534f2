// toile/version.hpp: which Toile this is.
#pragma once
#include "toile/export.hpp"

namespace toile {

// The version of the library that runs, "0.1.0": major, minor, patch.  Below 1.0 a new minor version may change what these headers declare.
TOILE_EXPORT const char* version() noexcept;

}  // namespace toile
