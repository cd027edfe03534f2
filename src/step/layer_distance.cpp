#include "step/layer_distance.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

namespace toile::internal {
namespace {

constexpr double rest_share = 0.45;      // of the shortest rest edge: pairs that are neighbours at rest do not repel
constexpr double neighbour_share = 1.5;  // of the thickness: paths along edges are up to 15 % longer than straight ones

// The number of particles of a pair's first feature.
std::size_t first_feature(ContactKind kind) { return kind == ContactKind::edge_edge ? 2 : 1; }

}  // namespace

LayerDistance::LayerDistance(const ClothModel& model, const ClothTopology& topology)
    : thickness_m_(model.thickness_m), full_m_(model.thickness_m), scale_(model.thickness_m.size(), 1) {
  measure(model, topology);
}

void LayerDistance::update(const ClothModel& model, const ClothTopology& topology) {
  if (rest_version_ != model.rest_version) measure(model, topology);
}

void LayerDistance::measure(const ClothModel& model, const ClothTopology& topology) {
  rest_version_ = model.rest_version;
  std::vector<double> shortest(full_m_.size(), std::numeric_limits<double>::infinity());
  std::vector<RestEdge> edges;
  const ClothMesh& mesh = model.mesh;
  thickness_m_ = model.thickness_m;
  // The layers of cloth gathered to a share of its area are pressed to that share of their thickness.
  for (std::size_t t = 0; t < mesh.gathered_uv.size(); ++t) {
    if (mesh.gathered_uv[t] == mesh.uv[t]) continue;
    const double share = material_frame(model.rest_uv(t)).area_m2 / material_frame(mesh.uv[t]).area_m2;
    for (const Index i : mesh.triangles[t])
      thickness_m_[at(i)] = std::min(thickness_m_[at(i)], share * model.thickness_m[at(i)]);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec2 b(model.membrane[t].b_u, model.membrane[t].b_v);
    const std::array<Vec2, 3> uv = model.rest_uv(t);
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = b.cwiseProduct(uv[(k + 1) % 3] - uv[k]).norm();
      for (const Index corner : mesh.triangles[t]) shortest[at(corner)] = std::min(shortest[at(corner)], length);
      edges.push_back({mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3], length});
    }
  }
  for (std::size_t i = 0; i < full_m_.size(); ++i) full_m_[i] = std::min(thickness_m_[i], rest_share * shortest[i]);
  find_neighbours(edges, topology);
  set_scale(std::vector<double>(scale_));
}

void LayerDistance::find_neighbours(const std::vector<RestEdge>& edges, const ClothTopology& topology) {
  const std::size_t n = full_m_.size();
  neighbours_.offsets.assign(n + 1, 0);
  neighbours_.values.clear();
  const auto thinned = [&](std::size_t i) { return full_m_[i] < thickness_m_[i]; };
  std::vector<char> any(n, 0);
  for (std::size_t i = 0; i < n; ++i) any[i] = thinned(i) ? 1 : 0;
  if (std::none_of(any.begin(), any.end(), [](char c) { return c != 0; })) return;

  std::vector<std::vector<std::pair<Index, double>>> around(n);
  double longest = 0;
  for (const RestEdge& edge : edges) {
    around[at(edge.a)].emplace_back(edge.b, edge.length_m);
    around[at(edge.b)].emplace_back(edge.a, edge.length_m);
    longest = std::max(longest, edge.length_m);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Index to = topology.merged(static_cast<Index>(i));
    if (at(to) == i) continue;
    around[i].emplace_back(to, 0);
    around[at(to)].emplace_back(static_cast<Index>(i), 0);
  }
  std::vector<std::vector<Index>> neighbours(n);
  // The shortest paths from one particle up to the limit (Dijkstra; a handful of particles each).
  parallel_for(n, 16, [&](std::size_t i) {
    if (!thinned(i)) return;
    const double reach = neighbour_share * thickness_m_[i] + longest;
    std::vector<std::pair<double, Index>> open{{0, static_cast<Index>(i)}};
    std::vector<Index>& found = neighbours[i];
    while (!open.empty()) {
      std::pop_heap(open.begin(), open.end(), std::greater<>());
      const auto [way, particle] = open.back();
      open.pop_back();
      const auto place = std::lower_bound(found.begin(), found.end(), particle);
      if (place != found.end() && *place == particle) continue;
      found.insert(place, particle);
      for (const auto& [next, length] : around[at(particle)]) {
        if (way + length > reach) continue;
        open.emplace_back(way + length, next);
        std::push_heap(open.begin(), open.end(), std::greater<>());
      }
    }
  });
  for (std::size_t i = 0; i < n; ++i)
    neighbours_.offsets[i + 1] = neighbours_.offsets[i] + static_cast<Index>(neighbours[i].size());
  neighbours_.values.reserve(static_cast<std::size_t>(neighbours_.offsets.back()));
  for (const std::vector<Index>& found : neighbours)
    neighbours_.values.insert(neighbours_.values.end(), found.begin(), found.end());
}

void LayerDistance::set_scale(std::span<const double> scale) {
  of_neighbours_m_.resize(full_m_.size());
  largest_m_ = 0;
  for (std::size_t i = 0; i < full_m_.size(); ++i) {
    scale_[i] = scale.empty() ? 1 : scale[i];
    of_neighbours_m_[i] = scale_[i] * full_m_[i];
    largest_m_ = std::max({largest_m_, thickness_m_[i], scale_[i] * thickness_m_[i]});
  }
}

bool LayerDistance::are_neighbours(Index a, Index b) const {
  const auto of_a = neighbours_.row(a), of_b = neighbours_.row(b);
  return std::binary_search(of_a.begin(), of_a.end(), b) || std::binary_search(of_b.begin(), of_b.end(), a);
}

LayerDistance::Between LayerDistance::between(ContactKind kind, const std::array<Index, 4>& particle) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Between near{infinity, infinity}, far{infinity, infinity};
  for (const Index p : particle) {
    if (p < 0) continue;
    const std::size_t i = at(p);
    near = {std::min(near.full_m, full_m_[i]), std::min(near.scaled_m, of_neighbours_m_[i])};
    far = {std::min(far.full_m, thickness_m_[i]), std::min(far.scaled_m, scale_[i] * thickness_m_[i])};
  }
  if (near.full_m == far.full_m && near.scaled_m == far.scaled_m) return near;
  const std::size_t middle = first_feature(kind);
  for (std::size_t k = 0; k < middle; ++k) {
    for (std::size_t l = middle; l < 4; ++l)
      if (particle[l] >= 0 && are_neighbours(particle[k], particle[l])) return near;
  }
  return far;
}

}  // namespace toile::internal
