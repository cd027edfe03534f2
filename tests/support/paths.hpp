// Where tests find the project's own files and the inputs of others.
#pragma once

#include <string>

namespace toile::internal::test {

/// The path of `name`, relative to the root of the sources ("patterns/tshirt.json").
std::string source_path(const std::string& name);

/// The path of `name` among the inputs of others ("bodies/makehuman/base.obj"); tests skip where it is absent.
std::string shared_path(const std::string& name);

}  // namespace toile::internal::test
