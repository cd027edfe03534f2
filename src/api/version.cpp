#include "toile/version.hpp"

#include "sim/report.hpp"

namespace toile {

const char* version() noexcept { return internal::toile_version().data(); }  // a literal: it ends with a zero

}  // namespace toile
