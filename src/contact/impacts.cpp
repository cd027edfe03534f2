#include "contact/impacts.hpp"

#include "contact/ccd.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace toile {
namespace {

constexpr double separation_share = 0.1;  // of r
constexpr double gap_share = 0.5;         // of d_0
constexpr double floor_m = 1e-6;          // files of float32 tell sides that far apart within 8 m of the origin
constexpr double floor_share = 0.999;     // of d_0, where that is not above it
constexpr double no_floor_m = 1e-7;       // nothing that begins so near is a gap of ours
constexpr double no_gap_m = 1e-12;        // pairs that coincide have no side to be kept on

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

std::array<Vec3, 4> gather(const std::array<Index, 4>& particle, std::span<const Vec3> x) {
  return {x[at(particle[0])], x[at(particle[1])], x[at(particle[2])], x[at(particle[3])]};
}

// Weights and normal of the closest points; returns their distance.
double set_closest(const std::array<Vec3, 4>& x, Impact& impact) {
  if (impact.kind == ContactKind::vertex_face) {
    const Vec3 b = closest_vertex_triangle(x[0], x[1], x[2], x[3]).barycentric;
    impact.weight = {1, -b[0], -b[1], -b[2]};
  } else {
    const EdgeEdge closest = closest_edge_edge(x[0], x[1], x[2], x[3]);
    impact.weight = {1 - closest.s, closest.s, -(1 - closest.t), -closest.t};
  }
  Vec3 between = Vec3::Zero();
  for (std::size_t k = 0; k < 4; ++k) between += impact.weight[k] * x[k];
  const double gap = between.norm();
  if (gap > 0) impact.normal = between / gap;
  return gap;
}

// Half of the gap may go in a step, down to the floor.
double least_gap_m(double gap_m) {
  const double half = gap_share * gap_m;
  return gap_m < no_floor_m ? half : std::max(half, std::min(floor_m, floor_share * gap_m));
}

class ImpactQuery {
 public:
  ImpactQuery(const ClothTopology& cloth, const TriangleTree& tree, std::span<const Vec3> start,
              std::span<const double> contact_m, std::span<const Vec3> displacement_m, std::span<const Pinched> pinched)
      : cloth_(cloth),
        tree_(tree),
        start_(start),
        contact_m_(contact_m),
        displacement_m_(displacement_m),
        pinched_(pinched) {}

  void walk(TreeTask task, std::vector<Impact>& found) const {
    const std::size_t most = most_impacts_of_a_task(start_.size());
    tree_.visit_self(task, [&](Index a, Index b) {
      if (found.size() > most) return;
      const unsigned owned_a = cloth_.owned(a), owned_b = cloth_.owned(b);
      if (owned_a & 7u) meet_vertices(a, owned_a, b, found);
      if (owned_b & 7u) meet_vertices(b, owned_b, a, found);
      if (owned_a >> 3 != 0 && owned_b >> 3 != 0) meet_edges(a, owned_a >> 3, b, owned_b >> 3, found);
    });
  }

 private:
  void meet_vertices(Index a, unsigned owned, Index b, std::vector<Impact>& found) const {
    const Triangle &corners = cloth_.triangle(b), &merged = cloth_.merged_triangle(b);
    const OuterBox& box = tree_.triangle_box(b);
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(owned >> k & 1u)) continue;
      const Index v = cloth_.triangle(a)[k], m = cloth_.merged_triangle(a)[k];
      if (m == merged[0] || m == merged[1] || m == merged[2]) continue;
      if (!tree_.particle_box(v).overlaps(box)) continue;
      decide(ContactKind::vertex_face, {v, corners[0], corners[1], corners[2]}, found);
    }
  }

  void meet_edges(Index a, unsigned edges_a, Index b, unsigned edges_b, std::vector<Impact>& found) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(edges_a >> k & 1u)) continue;
      const Index first = cloth_.triangle_edges(a)[k];
      const Edge& e = cloth_.edge(first);
      const OuterBox box = tree_.edge_box(e.a, e.b);
      const Index ea = cloth_.merged(e.a), eb = cloth_.merged(e.b);
      for (std::size_t l = 0; l < 3; ++l) {
        if (!(edges_b >> l & 1u)) continue;
        const Index second = cloth_.triangle_edges(b)[l];
        const Edge& f = cloth_.edge(second);
        const Index fa = cloth_.merged(f.a), fb = cloth_.merged(f.b);
        if (ea == fa || ea == fb || eb == fa || eb == fb) continue;
        if (!box.overlaps(tree_.edge_box(f.a, f.b))) continue;
        if (first < second) {
          decide(ContactKind::edge_edge, {e.a, e.b, f.a, f.b}, found);
        } else {
          decide(ContactKind::edge_edge, {f.a, f.b, e.a, e.b}, found);
        }
      }
    }
  }

  void decide(ContactKind kind, const std::array<Index, 4>& particle, std::vector<Impact>& found) const {
    Impact impact{kind, particle, {}, Vec3::Zero(), no_impact, 0, contact_m_[at(particle[0])], 0};
    for (const Index i : particle) impact.contact_m = std::min(impact.contact_m, contact_m_[at(i)]);
    if (impact.contact_m <= 0 || is_let_be(particle, pinched_)) return;
    if (decide_impact(gather(particle, start_), gather(particle, displacement_m_), impact)) found.push_back(impact);
  }

  const ClothTopology& cloth_;
  const TriangleTree& tree_;
  std::span<const Vec3> start_;
  std::span<const double> contact_m_;
  std::span<const Vec3> displacement_m_;
  std::span<const Pinched> pinched_;
};

}  // namespace

bool decide_impact(const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& u, Impact& impact) {
  impact.start_gap_m = set_closest(x, impact);
  if (impact.start_gap_m <= no_gap_m) return false;
  impact.separation_m = std::min(separation_share * impact.contact_m, least_gap_m(impact.start_gap_m));
  impact.time = impact.kind == ContactKind::vertex_face ? vertex_face_impact(x, u, impact.separation_m)
                                                        : edge_edge_impact(x, u, impact.separation_m);
  if (impact.time > 1) return false;
  std::array<Vec3, 4> moved;
  for (std::size_t k = 0; k < 4; ++k) moved[k] = x[k] + impact.time * u[k];
  set_closest(moved, impact);
  return true;
}

bool find_impacts(const ClothTopology& cloth, TriangleTree& tree, std::span<const Vec3> start,
                  std::span<const Vec3> end, std::span<const double> contact_m, ImpactWorkspace& workspace,
                  std::vector<Impact>& impacts, std::span<const Pinched> pinched) {
  TOILE_ASSERT(start.size() == cloth.particle_count() && end.size() == start.size() &&
               contact_m.size() == start.size());
  impacts.clear();
  if (start.empty()) return true;
  const double widest_m = *std::max_element(contact_m.begin(), contact_m.end());
  tree.refit(start, end, separation_share * widest_m / 2);
  workspace.displacement_m.resize(start.size());
  for (std::size_t i = 0; i < start.size(); ++i) workspace.displacement_m[i] = end[i] - start[i];
  tree.self_tasks(workspace.tasks);
  if (workspace.found.size() < workspace.tasks.size()) workspace.found.resize(workspace.tasks.size());
  const ImpactQuery query(cloth, tree, start, contact_m, workspace.displacement_m, pinched);
  parallel_for(workspace.tasks.size(), 1, [&](std::size_t i) {
    workspace.found[i].clear();
    query.walk(workspace.tasks[i], workspace.found[i]);
  });
  return gather_impacts(std::span(workspace.found).first(workspace.tasks.size()), start.size(), impacts);
}

bool gather_impacts(std::span<const std::vector<Impact>> found, std::size_t particles, std::vector<Impact>& impacts) {
  const std::size_t most = most_impacts(particles), of_a_task = most_impacts_of_a_task(particles);
  for (const std::vector<Impact>& of_task : found) {
    impacts.insert(impacts.end(), of_task.begin(), of_task.end());
    if (of_task.size() > of_a_task || impacts.size() > most) return false;
  }
  return true;
}

double impact_time(const Impact& pair, std::span<const Vec3> start, std::span<const Vec3> end) {
  const std::array<Vec3, 4> x = gather(pair.particle, start);
  std::array<Vec3, 4> u = gather(pair.particle, end);
  for (std::size_t k = 0; k < 4; ++k) u[k] -= x[k];
  return pair.kind == ContactKind::vertex_face ? vertex_face_impact(x, u, pair.separation_m)
                                               : edge_edge_impact(x, u, pair.separation_m);
}

}  // namespace toile
