// A source of its own: where g++ 12 sees the length of the root, it warns of a bound that none of its strings passes.
#include "support/paths.hpp"

namespace toile::internal::test {

std::string source_path(const std::string& name) { return std::string(TOILE_SOURCE_DIR).append("/").append(name); }

std::string shared_path(const std::string& name) { return std::string(TOILE_SHARED_DATA).append("/").append(name); }

}  // namespace toile::internal::test
