// step/layer_distance.hpp: r of two layers of cloth, the distance that their contact keeps.
//
//   r = the smaller thickness of the two fabrics, whatever the mesh;
//   but neighbours along the cloth, which are nearer than that at rest, do not repel each other.  They keep at most
//       0.45 of the shortest rest edge around either
//   and cloth gathered to a share of its area (ClothMesh::gathered_uv) keeps that share of its thickness.
//
// Neighbours are joined by edges and open seams with rest lengths that sum to less than 1.5 thickness and the longest
// edge.
#pragma once
#include "assembly/cloth_model.hpp"
#include "contact/features.hpp"
#include "contact/proximity.hpp"

#include <span>
#include <vector>

namespace toile::internal {

class LayerDistance {
 public:
  LayerDistance(const ClothModel& model, const ClothTopology& topology);

  // Call when rest lengths have changed (ClothModel::rest_version); cheap when they have not.
  void update(const ClothModel& model, const ClothTopology& topology);
  // [particle] factor on the thickness; empty: 1 everywhere.  0 switches the contact of layers off.
  void set_scale(std::span<const double> scale);

  struct Between {
    double full_m, scaled_m;
  };
  Between between(ContactKind kind, const std::array<Index, 4>& particle) const;
  // The largest r of any pair, scaled or not.
  double largest_m() const { return largest_m_; }
  // [particle] distance that neighbours keep, scaled.
  std::span<const double> of_neighbours_m() const { return of_neighbours_m_; }

 private:
  struct RestEdge {
    Index a, b;
    double length_m;
  };
  void measure(const ClothModel& model, const ClothTopology& topology);
  void find_neighbours(const std::vector<RestEdge>& edges, const ClothTopology& topology);
  bool are_neighbours(Index a, Index b) const;

  int rest_version_ = 0;                              // of the model, at the last measurement
  std::vector<double> thickness_m_, full_m_, scale_;  // [particle]; full_m_ as of_neighbours_m_, unscaled
  std::vector<double> of_neighbours_m_;               // [particle]
  IndexRows neighbours_;                              // [particle] ascending; none where full_m_ is the thickness
  double largest_m_ = 0;
};

}  // namespace toile::internal
