// toile/version.hpp: which Toile this is.
#pragma once

namespace toile {

// "major.minor.patch" (semver.org).  Below 1.0 a new minor version may change the interface.
const char* version() noexcept;

}  // namespace toile
