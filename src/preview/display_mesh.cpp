// preview/display_mesh.cpp: subdivision, thickness, and the lines of the drawing.
#include "preview/display_mesh.hpp"

#include "preview/cloth_look.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::internal {
namespace {

constexpr int most_halvings = 2;
constexpr double seam_reach_m = 0.003;   // farther away no pixel sees a seam
constexpr double hem_reach_m = 0.002;    // beyond the hem
constexpr double hem_step_m = 0.0015;    // over which the folded layers end
constexpr double same_place_m2 = 1e-14;  // of two corners in the drawing

struct Surface {
  std::vector<Triangle> triangles;
  std::vector<std::array<Vec2, 3>> uv;
  std::vector<Vec3> positions;
};

struct Edge {
  Index low = 0, high = 0;
  std::vector<std::array<Index, 2>> sides;  // triangle, and the corner at which the edge starts
};

// [edge], and `of` [triangle][corner] the edge from that corner to the next.
std::vector<Edge> edges_of(std::span<const Triangle> triangles, std::vector<std::array<Index, 3>>& of) {
  struct Side {
    Index low, high, triangle, corner;
  };
  std::vector<Side> sides;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(triangles[t][k], triangles[t][(k + 1) % 3]);
      sides.push_back({low, high, static_cast<Index>(t), static_cast<Index>(k)});
    }
  std::stable_sort(sides.begin(), sides.end(),
                   [](const Side& a, const Side& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
  std::vector<Edge> edges;
  of.assign(triangles.size(), {-1, -1, -1});
  for (const Side& side : sides) {
    if (edges.empty() || edges.back().low != side.low || edges.back().high != side.high)
      edges.push_back({side.low, side.high, {}});
    edges.back().sides.push_back({side.triangle, side.corner});
    of[at(side.triangle)][at(side.corner)] = static_cast<Index>(edges.size() - 1);
  }
  return edges;
}

// Pressed folds stay sharp: of an edge at which the surface turns by 60 degrees nothing, by 110 all.  In between both rules are mixed, so that a film
// does not jump where cloth folds.
constexpr double smooth_cosine = 0.5;

double sharpness(const Surface& surface, const Edge& edge) {
  if (edge.sides.size() != 2) return 0;
  std::array<Vec3, 2> n;
  for (std::size_t side = 0; side < 2; ++side) {
    const Triangle& c = surface.triangles[at(edge.sides[side][0])];
    n[side] = (surface.positions[at(c[1])] - surface.positions[at(c[0])])
                  .cross(surface.positions[at(c[2])] - surface.positions[at(c[0])]);
  }
  const double size = n[0].norm() * n[1].norm();
  if (!(size > 0)) return 0;
  const double x = std::clamp((smooth_cosine - n[0].dot(n[1]) / size) / (smooth_cosine - pressed_cosine), 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

// The sharp edges that meet in a vertex: a crease goes along the two sharpest; a third makes a corner.
struct Crease {
  std::array<double, 3> sharp{};
  std::array<Index, 3> along{};
  void add(double s, Index other) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (s <= sharp[k]) continue;
      std::swap(s, sharp[k]);
      std::swap(other, along[k]);
    }
  }
};

// Every triangle becomes four, which follow each other.
Surface halved(const Surface& from) {
  std::vector<std::array<Index, 3>> edge_of;
  const std::vector<Edge> edges = edges_of(from.triangles, edge_of);
  const std::size_t count = from.positions.size();
  std::vector<Vec3> inner(count, Vec3::Zero()), border(count, Vec3::Zero());
  std::vector<int> inner_count(count, 0), border_count(count, 0);
  std::vector<Crease> crease(count);
  Surface to;
  to.positions.resize(count + edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const Edge& edge = edges[e];
    const Vec3 &a = from.positions[at(edge.low)], &b = from.positions[at(edge.high)];
    const bool inside = edge.sides.size() == 2;
    Vec3& middle = to.positions[count + e];
    middle = 0.5 * (a + b);
    if (inside) {
      middle *= 0.75;
      for (const auto& [triangle, corner] : edge.sides)
        middle += 0.125 * from.positions[at(from.triangles[at(triangle)][at((corner + 2) % 3)])];
      const double sharp = sharpness(from, edge);
      middle += sharp * (0.5 * (a + b) - middle);
      crease[at(edge.low)].add(sharp, edge.high);
      crease[at(edge.high)].add(sharp, edge.low);
    }
    for (const auto& [own, other] : {std::array{edge.low, edge.high}, std::array{edge.high, edge.low}}) {
      (inside ? inner : border)[at(own)] += from.positions[at(other)];
      ++(inside ? inner_count : border_count)[at(own)];
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3& x = from.positions[i];
    const int n = inner_count[i];
    if (border_count[i] == 2) {
      to.positions[i] = 0.75 * x + 0.125 * border[i];
      to.positions[i] += crease[i].sharp[0] * (x - to.positions[i]);  // where a crease ends
    } else if (border_count[i] == 0 && n >= 3) {
      const double beta = n == 3 ? 3.0 / 16 : 3.0 / (8.0 * n);
      const auto& [sharp, along] = crease[i];
      const Vec3 smooth = (1 - n * beta) * x + beta * inner[i],
                 creased = 0.75 * x + 0.125 * (from.positions[at(along[0])] + from.positions[at(along[1])]);
      to.positions[i] = smooth + sharp[1] * (creased - smooth);
      to.positions[i] += sharp[2] * (x - to.positions[i]);
    } else {
      to.positions[i] = x;  // a corner where several edges end
    }
  }
  to.triangles.reserve(4 * from.triangles.size());
  to.uv.reserve(4 * from.triangles.size());
  for (std::size_t t = 0; t < from.triangles.size(); ++t) {
    const Triangle& c = from.triangles[t];
    const std::array<Vec2, 3>& p = from.uv[t];
    std::array<Index, 3> m{};
    for (std::size_t k = 0; k < 3; ++k) m[k] = static_cast<Index>(count) + edge_of[t][k];
    const std::array<Vec2, 3> q{0.5 * (p[0] + p[1]), 0.5 * (p[1] + p[2]), 0.5 * (p[2] + p[0])};
    to.triangles.insert(to.triangles.end(),
                        {{c[0], m[0], m[2]}, {m[0], c[1], m[1]}, {m[2], m[1], c[2]}, {m[0], m[1], m[2]}});
    to.uv.insert(to.uv.end(), {{p[0], q[0], q[2]}, {q[0], p[1], q[1]}, {q[2], q[1], p[2]}, {q[0], q[1], q[2]}});
  }
  return to;
}

double distance_m(const EdgeLine& line, const Vec2& p, double& share) {
  const Vec2 d = line.b - line.a;
  const double length2 = d.squaredNorm();
  share = length2 > 0 ? std::clamp((p - line.a).dot(d) / length2, 0.0, 1.0) : 0;
  return (p - line.a - share * d).norm();
}

// Open edges and seams, each listed at the triangles of its panel that lie within its reach.
class Lines {
 public:
  Lines(const PreviewCloth& cloth, std::span<const ClothLook* const> look, DisplayMesh& to)
      : cloth_(cloth), look_(look), to_(to), edges_(edges_of(cloth.triangles, edge_of_)) {
    to_.lines_near.resize(cloth.triangles.size());
    seen_.assign(cloth.triangles.size(), -1);
    measure_open_edges();
    for (std::size_t e = 0; e < edges_.size(); ++e)
      for (const auto& side : edges_[e].sides)
        if (edges_[e].sides.size() != 2 || parted(edges_[e])) add(e, side);
  }

 private:
  Vec2 corner(Index triangle, Index k) const { return cloth_.uv[at(triangle)][at(k % 3)]; }

  // Two panels meet there, or the edges of a dart.
  bool parted(const Edge& edge) const {
    const auto& [s, t] = std::pair{edge.sides[0], edge.sides[1]};
    const Vec2 a = corner(s[0], s[1]), b = corner(s[0], s[1] + 1), c = corner(t[0], t[1]), d = corner(t[0], t[1] + 1);
    const bool opposite = cloth_.triangles[at(s[0])][at(s[1])] != cloth_.triangles[at(t[0])][at(t[1])];
    return (a - (opposite ? d : c)).squaredNorm() > same_place_m2 ||
           (b - (opposite ? c : d)).squaredNorm() > same_place_m2;
  }

  // Their arc lengths, from where each loop is met first.
  void measure_open_edges() {
    from_m_.assign(edges_.size(), 0);
    std::vector<Index> next(cloth_.positions.size(), -1);  // [particle] the open edge that starts there
    std::vector<char> done(edges_.size(), 0);
    const auto start_of = [&](const Edge& edge) {
      return cloth_.triangles[at(edge.sides[0][0])][at(edge.sides[0][1])];
    };
    for (std::size_t e = 0; e < edges_.size(); ++e)
      if (edges_[e].sides.size() == 1) next[at(start_of(edges_[e]))] = static_cast<Index>(e);
    for (std::size_t first = 0; first < edges_.size(); ++first) {
      if (edges_[first].sides.size() != 1 || done[first]) continue;
      double along_m = 0;
      for (Index e = static_cast<Index>(first); e >= 0 && !done[at(e)];) {
        done[at(e)] = 1;
        from_m_[at(e)] = along_m;
        const auto& [triangle, k] = edges_[at(e)].sides[0];
        along_m += (corner(triangle, k + 1) - corner(triangle, k)).norm();
        e = next[at(cloth_.triangles[at(triangle)][at((k + 1) % 3)])];
      }
    }
  }

  void add(std::size_t e, const std::array<Index, 2>& side) {
    const bool sewn = edges_[e].sides.size() != 1;
    const Index line = static_cast<Index>(to_.lines.size());
    to_.lines.push_back({corner(side[0], side[1]), corner(side[0], side[1] + 1), from_m_[e], sewn});
    const double reach_m = sewn ? seam_reach_m : static_cast<double>(look_[at(side[0])]->hem_m) + hem_reach_m;
    std::vector<Index> open{side[0]};
    seen_[at(side[0])] = line;
    while (!open.empty()) {
      const Index t = open.back();
      open.pop_back();
      to_.lines_near[at(t)].push_back(line);
      for (std::size_t k = 0; k < 3; ++k) {
        const Edge& edge = edges_[at(edge_of_[at(t)][k])];
        if (edge.sides.size() != 2 || parted(edge)) continue;
        const Index other = edge.sides[edge.sides[0][0] == t ? 1 : 0][0];
        if (seen_[at(other)] == line || !within(other, to_.lines.back(), reach_m)) continue;
        seen_[at(other)] = line;
        open.push_back(other);
      }
    }
  }

  bool within(Index triangle, const EdgeLine& line, double reach_m) const {
    const std::array<Vec2, 3>& p = cloth_.uv[at(triangle)];
    const Vec2 middle = (p[0] + p[1] + p[2]) / 3;
    double radius = 0, share = 0;
    for (const Vec2& q : p) radius = std::max(radius, (q - middle).norm());
    return distance_m(line, middle, share) - radius < reach_m;
  }

  const PreviewCloth& cloth_;
  std::span<const ClothLook* const> look_;
  DisplayMesh& to_;
  std::vector<std::array<Index, 3>> edge_of_;
  std::vector<Edge> edges_;
  std::vector<double> from_m_;
  std::vector<Index> seen_;  // [triangle] the last line that was listed there
};

// Two sheets around the surface and a rim along its open edges.
void thicken(const Surface& surface, std::span<const ClothLook* const> look, DisplayMesh& to) {
  const std::size_t count = surface.positions.size();
  std::vector<Vec3> normal(count, Vec3::Zero());
  std::vector<double> thickness_m(count, 0), folded_m(count, 0);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Triangle& c = surface.triangles[t];
    const Vec3 n = (surface.positions[at(c[1])] - surface.positions[at(c[0])])
                       .cross(surface.positions[at(c[2])] - surface.positions[at(c[0])]);
    const ClothLook& own = *look[at(to.source[t])];
    const double layer_m = static_cast<double>(own.thickness_m), hem_m = static_cast<double>(own.hem_m);
    for (std::size_t k = 0; k < 3; ++k) {
      normal[at(c[k])] += n;
      thickness_m[at(c[k])] = std::max(thickness_m[at(c[k])], layer_m);
      const double open_m = edge_distance(to, to.source[t], surface.uv[t][k]).open_m;
      const double share = std::clamp((hem_m - open_m) / hem_step_m, 0.0, 1.0);
      folded_m[at(c[k])] = std::max(folded_m[at(c[k])], 2 * layer_m * share);
    }
  }
  to.positions.resize(2 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const double length = normal[i].norm();
    const Vec3 n = length > 0 ? Vec3(normal[i] / length) : Vec3(Vec3::Zero());
    to.positions[i] = surface.positions[i] + 0.5 * thickness_m[i] * n;
    to.positions[count + i] = surface.positions[i] - (0.5 * thickness_m[i] + folded_m[i]) * n;
  }
  const auto add = [&](const Triangle& corners, const std::array<Vec2, 3>& uv, Index source) {
    to.triangles.push_back(corners);
    to.uv.push_back(uv);
    to.source.push_back(source);
  };
  // Both sheets keep the orientation: a ray that meets the inner one from inside sees the wrong side.
  const Index below = static_cast<Index>(count);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Triangle c = surface.triangles[t];
    add({c[0] + below, c[1] + below, c[2] + below}, surface.uv[t], to.source[t]);
  }
  std::vector<std::array<Index, 3>> edge_of;
  for (const Edge& edge : edges_of(surface.triangles, edge_of)) {
    if (edge.sides.size() != 1) continue;
    const auto& [t, k] = edge.sides[0];
    const Index a = surface.triangles[at(t)][at(k)], b = surface.triangles[at(t)][at((k + 1) % 3)];
    const Vec2 ua = surface.uv[at(t)][at(k)], ub = surface.uv[at(t)][at((k + 1) % 3)];
    const Index first = static_cast<Index>(to.positions.size());
    for (const Index i : {a + below, b + below, b, a}) to.positions.push_back(Vec3(to.positions[at(i)]));
    add({first, first + 1, first + 2}, {ua, ub, ub}, to.source[at(t)]);
    add({first, first + 2, first + 3}, {ua, ub, ua}, to.source[at(t)]);
  }
}

}  // namespace

DisplayMesh display_mesh(const PreviewCloth& cloth, std::span<const ClothLook* const> look, double edge_m) {
  DisplayMesh to;
  Lines(cloth, look, to);
  Surface surface{{cloth.triangles.begin(), cloth.triangles.end()},
                  {cloth.uv.begin(), cloth.uv.end()},
                  {cloth.positions.begin(), cloth.positions.end()}};
  double sum_m = 0;
  for (const Triangle& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      sum_m += (surface.positions[at(t[k])] - surface.positions[at(t[(k + 1) % 3])]).norm();
  double mean_m = surface.triangles.empty() ? 0 : sum_m / (3.0 * static_cast<double>(surface.triangles.size()));
  int halvings = 0;
  for (; halvings < most_halvings && std::isfinite(mean_m) && mean_m > 1.4 * edge_m; ++halvings, mean_m /= 2)
    surface = halved(surface);
  const std::size_t share = std::size_t{1} << (2 * halvings);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) to.source.push_back(static_cast<Index>(t / share));
  to.triangles = surface.triangles;
  to.uv = surface.uv;
  thicken(surface, look, to);
  return to;
}

EdgeDistance edge_distance(const DisplayMesh& mesh, Index source, const Vec2& uv) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  EdgeDistance nearest{inf, 0, inf};
  for (const Index l : mesh.lines_near[at(source)]) {
    const EdgeLine& line = mesh.lines[at(l)];
    double share = 0;
    const double d = distance_m(line, uv, share);
    if (line.sewn) {
      nearest.sewn_m = std::min(nearest.sewn_m, d);
    } else if (d < nearest.open_m) {
      nearest.open_m = d;
      nearest.along_m = line.from_m + share * (line.b - line.a).norm();
    }
  }
  return nearest;
}

}  // namespace toile::internal
