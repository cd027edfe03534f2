#include "contact/impacts.hpp"

#include "contact/ccd.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

constexpr std::size_t list_grain = 512;
constexpr double gap_share = 0.5;      // of d_0
constexpr double floor_m = 1e-6;       // float32 files can tell the two sides of such a gap within 8 m of the origin
constexpr double floor_share = 0.999;  // of d_0, where that is not above it
constexpr double no_floor_m = 1e-7;    // a smaller gap at the start was not made by contact
constexpr double no_gap_m = 1e-12;     // pairs that coincide have no side to be kept on

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
              std::span<const double> contact_m, std::span<const Pinched> pinched, ImpactWorkspace& workspace)
      : cloth_(cloth), tree_(tree), start_(start), contact_m_(contact_m), pinched_(pinched), workspace_(workspace) {}

  // All impacts, by a traversal of the tree, whose boxes are those of the motion.  False: too many.
  bool walk(std::vector<Impact>& impacts) const {
    tree_.self_tasks(workspace_.tasks);
    const std::size_t most = most_impacts_of_a_task(start_.size());
    start_blocks(workspace_.tasks.size());
    parallel_for(workspace_.tasks.size(), 1, [&](std::size_t i) {
      std::vector<Impact>& found = workspace_.found[i];
      visit_feature_pairs(
          cloth_, tree_, workspace_.tasks[i],
          [&](Index v, Index t) {
            if (found.size() <= most) decide_vertex(v, t, found);
          },
          [&](Index e, Index f) {
            if (found.size() <= most) decide_edges(e, f, found);
          });
    });
    return gather_impacts(found(workspace_.tasks.size()), start_.size(), most, impacts);
  }

  // All impacts, by valid lists.  False: so many that the traversal might have stopped, and has to decide.
  bool look_up(const FeaturePairs& pairs, std::vector<Impact>& impacts) const {
    const std::size_t vertices = start_.size(), edges = cloth_.topology().edges.size();
    const std::size_t vertex_blocks = (vertices + list_grain - 1) / list_grain,
                      blocks = vertex_blocks + (edges + list_grain - 1) / list_grain;
    start_blocks(blocks);
    parallel_for(blocks, 1, [&](std::size_t i) {
      if (i < vertex_blocks) {
        const std::size_t begin = i * list_grain;
        look_up_vertices(pairs, begin, std::min(begin + list_grain, vertices), workspace_.found[i]);
      } else {
        const std::size_t begin = (i - vertex_blocks) * list_grain;
        look_up_edges(pairs, begin, std::min(begin + list_grain, edges), workspace_.found[i]);
      }
    });
    return gather_impacts(found(blocks), start_.size(), few_impacts, impacts) && impacts.size() <= few_impacts;
  }

 private:
  void start_blocks(std::size_t count) const {
    if (workspace_.found.size() < count) workspace_.found.resize(count);
    for (std::size_t i = 0; i < count; ++i) workspace_.found[i].clear();
  }
  std::span<const std::vector<Impact>> found(std::size_t count) const {
    return std::span(workspace_.found).first(count);
  }

  void look_up_vertices(const FeaturePairs& pairs, std::size_t begin, std::size_t end,
                        std::vector<Impact>& found) const {
    const ParticleBoxes& boxes = workspace_.boxes;
    for (auto v = static_cast<Index>(begin); v < static_cast<Index>(end); ++v) {
      for (const Index t : pairs.triangles_near(v)) {
        if (boxes[v].overlaps(boxes.triangle(cloth_.triangle(t)))) decide_vertex(v, t, found);
      }
    }
  }
  void look_up_edges(const FeaturePairs& pairs, std::size_t begin, std::size_t end, std::vector<Impact>& found) const {
    const ParticleBoxes& boxes = workspace_.boxes;
    for (auto first = static_cast<Index>(begin); first < static_cast<Index>(end); ++first) {
      const std::span<const Index> near = pairs.edges_near(first);
      if (near.empty()) continue;
      const Edge& e = cloth_.edge(first);
      const OuterBox box = boxes.edge(e.a, e.b);
      for (const Index second : near) {
        const Edge& f = cloth_.edge(second);
        if (box.overlaps(boxes.edge(f.a, f.b))) decide_edges(first, second, found);
      }
    }
  }

  void decide_vertex(Index v, Index t, std::vector<Impact>& found) const {
    const Triangle& corners = cloth_.triangle(t);
    decide(ContactKind::vertex_face, {v, corners[0], corners[1], corners[2]}, found);
  }
  void decide_edges(Index first, Index second, std::vector<Impact>& found) const {
    const Edge &e = cloth_.edge(first), &f = cloth_.edge(second);
    decide(ContactKind::edge_edge, {e.a, e.b, f.a, f.b}, found);
  }
  void decide(ContactKind kind, const std::array<Index, 4>& particle, std::vector<Impact>& found) const {
    Impact impact{kind, particle, {}, Vec3::Zero(), no_impact, 0, contact_m_[at(particle[0])], 0};
    for (const Index i : particle) impact.contact_m = std::min(impact.contact_m, contact_m_[at(i)]);
    if (impact.contact_m <= 0 || is_exempt(particle, pinched_)) return;
    if (decide_impact(gather(particle, start_), gather(particle, workspace_.displacement_m), impact))
      found.push_back(impact);
  }

  const ClothTopology& cloth_;
  const TriangleTree& tree_;
  std::span<const Vec3> start_;
  std::span<const double> contact_m_;
  std::span<const Pinched> pinched_;
  ImpactWorkspace& workspace_;
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
                  std::vector<Impact>& impacts, std::span<const Pinched> pinched, const FeaturePairs* pairs) {
  TOILE_ASSERT(start.size() == cloth.particle_count() && end.size() == start.size() &&
               contact_m.size() == start.size());
  impacts.clear();
  if (start.empty()) return true;
  const double widest_m = *std::max_element(contact_m.begin(), contact_m.end());
  workspace.boxes.set_seen_from_mean(start, end, separation_share * widest_m / 2);
  workspace.displacement_m.resize(start.size());
  for (std::size_t i = 0; i < start.size(); ++i) workspace.displacement_m[i] = end[i] - start[i];
  const ImpactQuery query(cloth, tree, start, contact_m, pinched, workspace);
  bool all = pairs && pairs->hold(workspace.boxes) && query.look_up(*pairs, impacts);
  if (!all) {
    impacts.clear();
    tree.refit(workspace.boxes);
    all = query.walk(impacts);
  }
  return all;
}

bool gather_impacts(std::span<const std::vector<Impact>> found, std::size_t particles, std::size_t of_a_task,
                    std::vector<Impact>& impacts) {
  const std::size_t most = most_impacts(particles);
  bool all = true;
  for (const std::vector<Impact>& of_task : found) {
    impacts.insert(impacts.end(), of_task.begin(), of_task.end());
    all = of_task.size() <= of_a_task && impacts.size() <= most;
    if (!all) break;
  }
  std::sort(impacts.begin(), impacts.end(), [](const Impact& a, const Impact& b) {
    return a.kind != b.kind ? a.kind < b.kind : a.particle < b.particle;
  });
  return all;
}

double impact_time(const Impact& pair, std::span<const Vec3> start, std::span<const Vec3> end) {
  const std::array<Vec3, 4> x = gather(pair.particle, start);
  std::array<Vec3, 4> u = gather(pair.particle, end);
  for (std::size_t k = 0; k < 4; ++k) u[k] -= x[k];
  return pair.kind == ContactKind::vertex_face ? vertex_face_impact(x, u, pair.separation_m)
                                               : edge_edge_impact(x, u, pair.separation_m);
}

}  // namespace toile::internal
