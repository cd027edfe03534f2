// tests/support/run_into.hpp: runs a scene into a folder.
#pragma once
#include "sim/simulate.hpp"

#include <string>

namespace toile::internal::test {

inline Report run_into(const std::string& directory, const Scene& scene) {
  RunOptions options;
  options.directory = directory;
  options.command = "test";
  return simulate(scene, options);
}

}  // namespace toile::internal::test
