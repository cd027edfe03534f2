// toile/version.hpp: which Toile this is.
#pragma once
#include "toile/export.hpp"

namespace toile {

// "major.minor.patch" (semver.org).  Below 1.0 a new minor version may change the interface.
TOILE_EXPORT const char* version() noexcept;

}  // namespace toile
