// sim/budget.hpp: the resources of a scene, estimated before it is made: memory, frames and time.                  docs/limits.md
//
// From areas, edge lengths and counts:
//   particles   of an area A whose outline has B points, I = A / (sqrt(3)/2 e^2) - B/2 within it [Pick 1899, on a triangular lattice];
//               two triangles for each of them, and one for each point of the outline
//   memory      the program's own + cloth + bodies, each a constant per particle and per triangle
//   frames      sewing until the widest seam has closed, drape, motion: the most there can be
//   time        frames x steps x particles x (time of a particle's step), which grows with the number of particles
// The constants are in budget.cpp.  Memory is accurate to 25 %; time to a factor of three, as nobody knows beforehand how a cloth will fold.
//
// Easily missed: every item has a limit of its own where it is read (a grid of two million triangles); this is about all of them together.
#pragma once
#include "sim/scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace toile::internal {

struct BudgetItem {
  std::string what;  // `cloth "skirt", panel "front"`, "body woman", "solid 2 (sphere)"
  double triangles = 0;
  double memory_mb = 0;
};

struct Budget {
  std::string name;                     // of the scene
  std::vector<BudgetItem> items;        // in the order of the scene
  double particles = 0, triangles = 0;  // of the cloth
  double memory_mb = 0;                 // 2^20 bytes, at the peak
  double frames = 0;                    // written: drape and motion
  double unwritten_frames = 0;          // of sewing, and of the drape of inner garments
  double seconds = 0;                   // wall time
  std::vector<FarPanel> far_panels;
};

struct BudgetLimits {
  std::optional<double> memory_mb;  // absent: the machine's available memory
  double frames = 1e6;              // nine hours of film; a report lists every frame
  double hours = 24;                // a longer run has to be asked for
};

// Reads patterns by `read`, and only the sizes of other files.  Throws IoError and InputError for a pattern, as loading it would.
Budget estimate_budget(const Scene& scene, const TextSource& read);

// Throws Error(resource_limit) that names the limit, the estimate beyond it, and the largest items.
void check_budget(const Budget& budget, const BudgetLimits& limits);

inline void require_budget(const Scene& scene, const TextSource& read, const BudgetLimits& limits) {
  check_budget(estimate_budget(scene, read), limits);
}

}  // namespace toile::internal
