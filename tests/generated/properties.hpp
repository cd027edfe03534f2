// tests/generated/properties.hpp: what must hold of every valid scene.
//
//   what `check` accepts ends with exit code 0, 5 or 8, or 4 where the scene asks for it, and not with a signal or never
//   a run gives the same bits again: with one thread and three, in the program and in the library, whatever memory held before
//   a solid far away, still or moving, changes nothing
//   a default that is written out, or an option that nothing uses, changes nothing
#pragma once
#include "generated/scene_generator.hpp"

#include <string>
#include <vector>

namespace toile::internal::generated {

struct CheckOptions {
  std::string program;                 // toile
  std::string directory;               // an empty folder
  int limit_s = 120;                   // for one run: it takes less than one
  std::string valgrind, suppressions;  // valgrind not empty: one run under it, instead of all that
};

struct Checked {
  std::vector<std::string> violations;
  int exit_code = -1;    // of the run; -1: none
  bool skipped = false;  // the run that it starts from did not come to its end
};

Checked check_properties(const GeneratedScene& scene, const CheckOptions& options);

}  // namespace toile::internal::generated
