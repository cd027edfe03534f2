// assembly/topstitched_bands.hpp: bending across seam allowances that are stitched down.                   finished_edges.hpp
#pragma once
#include "assembly/cloth_model.hpp"

#include <map>

namespace toile::internal {

class TopstitchedBands {
 public:
  explicit TopstitchedBands(const ClothModel& model);

  // The band of `width_m` beside a triangle's side.
  void add(const Fabric& fabric, std::size_t triangle, std::size_t side, double width_m);
  // Into the model's plate_compliance.
  void apply(std::span<const Fabric> fabric_of_panel, ClothModel& model) const;

 private:
  struct Covered {
    double share = 0;                // of the triangle's area
    Mat3 compliance = Mat3::Zero();  // sum of share C^-1
  };
  const ClothModel* model_;
  std::vector<std::array<Index, 3>> hinges_;  // [triangle][side]
  std::map<std::size_t, Covered> covered_;    // [triangle]
};

}  // namespace toile::internal
