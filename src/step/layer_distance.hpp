// step/layer_distance.hpp: how near two layers of cloth come to each other: r of their contact.
//
//   r = the thinner of the two fabrics' thickness, whatever the mesh;
//   but what is that near to each other along the cloth, at rest, does not repel: neighbours keep at most
//       0.45 of the shortest rest edge around either
//   and cloth that is gathered to a share of its area (ClothMesh::gathered_uv) keeps that share of its thickness.
//   Neighbours are joined by edges of less than 1.5 thickness and the longest edge, rest lengths summed; open seams join too.
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

  // To be called when rest lengths have changed (ClothModel::rest_version); cheap when they have not.
  void update(const ClothModel& model, const ClothTopology& topology);
  // [particle] of the thickness; empty: 1 everywhere.  0 switches the contact of layers off.
  void set_scale(std::span<const double> scale);

  struct Between {
    double full_m, scaled_m;
  };
  Between between(ContactKind kind, const std::array<Index, 4>& particle) const;
  // The largest there can be, scaled or not.
  double largest_m() const { return largest_m_; }
  // [particle] what neighbours keep, scaled.
  std::span<const double> of_neighbours_m() const { return of_neighbours_m_; }

 private:
  struct RestEdge {
    Index a, b;
    double length_m;
  };
  void measure(const ClothModel& model, const ClothTopology& topology);
  void find_neighbours(const std::vector<RestEdge>& edges, const ClothTopology& topology);
  bool are_neighbours(Index a, Index b) const;

  int rest_version_ = 0;                              // of the model, when it was measured
  std::vector<double> thickness_m_, full_m_, scale_;  // [particle]; full_m_ as of_neighbours_m_, unscaled
  std::vector<double> of_neighbours_m_;               // [particle]
  IndexRows neighbours_;                              // [particle] ascending; none where full_m_ is the thickness
  double largest_m_ = 0;
};

}  // namespace toile::internal
