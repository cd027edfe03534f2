#include "sim/cloth.hpp"

#include "core/error.hpp"
#include "garment/refine.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

double cell_m2(double edge_m) { return std::sqrt(3.0) / 2 * edge_m * edge_m; }  // area per particle

}  // namespace

GarmentMesh as_worn(const MeshedCloth& cloth) {
  return is_cut_finer(cloth) ? refine(cloth.garment, cloth.edge_m).garment : cloth.garment;
}

ClothCost::Part part_of_area(std::string what, double area_m2, double outline_points, double edge_m) {
  const double inner = std::max(0.0, area_m2 / cell_m2(edge_m) - outline_points / 2);
  return {std::move(what), inner + outline_points, 2 * inner + outline_points};
}

std::string cloth_in_words(std::string_view name) { return "cloth \"" + printable(name) + '"'; }

}  // namespace toile::internal
