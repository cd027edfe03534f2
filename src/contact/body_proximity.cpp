// The body's vertices and ridges against the cloth's faces and edges.
#include "contact/proximity_memory.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

constexpr std::size_t triangle_grain = 1024, feature_grain = 1024;
constexpr double body_touching_m = 1e-9;  // nearer than this the body's own normal is the direction

using Memory = ProximityWorkspace::Memory;

// A straight edge of length l whose ends keep their distance dips by l/4 times the bend at a ridge under its middle.
// A ridge counts where that is more than the allowed share of the range; otherwise the cloth's vertices hold the gap.
bool ridge_counts(double bend, double length2, double range_m) {
  const double allowed = 4 * ridge_dip_share * range_m;
  return bend * bend * length2 > allowed * allowed;
}

class BodyQuery {
 public:
  BodyQuery(const ClothTopology& cloth, const TriangleTree& tree, std::span<const Vec3> x, const BodySurface& body,
            const ProximityOptions& options, const Memory& memory)
      : cloth_(cloth), tree_(tree), around_(cloth, x, options), body_(body), options_(options), memory_(memory) {}

  // Finds the pairs of the features that a triangle of the body owns.
  void meet_features(Index b, Memory::Found& found) const {
    const TriangleTree& bodies = body_.tree_now();
    const unsigned owned = memory_.body_features[static_cast<std::size_t>(b)];
    for_lanes(owned & 7u, [&](std::size_t k) {
      const Index v = body_.triangle(b)[k];
      tree_.visit_overlapping(bodies.particle_box(v), [&](Index t) { meet_vertex(v, t, found); });
    });
    for_lanes(owned >> 3, [&](std::size_t l) {
      const Index f = body_.topology().triangle_edges[static_cast<std::size_t>(b)][l];
      const Edge& ridge = body_.topology().edges[static_cast<std::size_t>(f)];
      const OuterBox box = bodies.edge_box(ridge.a, ridge.b);
      tree_.visit_overlapping(box, [&](Index t) {
        for_lanes(static_cast<unsigned>(cloth_.owned(t)) >> 3,
                  [&](std::size_t k) { meet_edges(cloth_.triangle_edges(t)[k], f, box, found); });
      });
    });
  }

 private:
  const Vec3& body_x(Index vertex) const { return body_.positions()[static_cast<std::size_t>(vertex)]; }

  // Sets normal and gap of a record; `between` leads from the body's point to the cloth's point.  False: too far, or on
  // neither side.
  bool set_gap(BodyContact& record, const Vec3& between, const Vec3& out) const {
    const double distance = between.norm();
    if (!(distance > body_touching_m)) {
      record.normal = out;
      record.gap_m = between.dot(out);
      return out.squaredNorm() > 0;
    }
    const double cosine = between.dot(out) / distance;
    if (std::fabs(cosine) < doubtful_cosine) return false;
    const double side = cosine > 0 ? 1 : -1;
    record.normal = side / distance * between;
    record.gap_m = side * distance;
    return distance < (cosine > 0 ? options_.range_m : options_.depth_m);
  }

  // Is the cloth's point inside the body, with its nearest way out on the side of this normal?
  bool confirmed(const BodyContact& record, const Vec3& cloth_point) const {
    if (!(record.gap_m < -body_touching_m)) return true;
    const BodyPoint nearest = body_.nearest(cloth_point, 2 * options_.depth_m);
    return nearest.triangle >= 0 && nearest.gap_m < 0 && nearest.normal.dot(record.normal) > 0;
  }

  void meet_vertex(Index vertex, Index t, Memory::Found& found) const {
    const Triangle& c = cloth_.triangle(t);
    const Vec3 &p = body_x(vertex), &origin = around_.x(c[0]);
    const double reach = std::max(options_.range_m, options_.depth_m);
    if (std::fabs(memory_.face_normals[static_cast<std::size_t>(t)].dot(p - origin)) >= reach) return;
    const VertexTriangle at = closest_vertex_triangle(p, origin, around_.x(c[1]), around_.x(c[2]));
    if (at.feature != Feature::face || !(at.distance2 < reach * reach)) return;
    const Vec3& b = at.barycentric;
    const Vec3 point = b[0] * around_.x(c[0]) + b[1] * around_.x(c[1]) + b[2] * around_.x(c[2]);
    BodyContact record{ContactKind::vertex_face, c, {b[0], b[1], b[2]}, {vertex, -1}, 0, {}, 0};
    if (!set_gap(record, point - p, body_.vertex_normal(vertex)) || !confirmed(record, point)) return;
    found.vertex_keys.emplace_back(vertex, t);
    found.body_vertices.push_back(record);
  }

  void meet_edges(Index cloth_edge, Index body_edge, const OuterBox& body_box, Memory::Found& found) const {
    const Edge &e = cloth_.edge(cloth_edge), &f = body_.topology().edges[static_cast<std::size_t>(body_edge)];
    if (!tree_.edge_box(e.a, e.b).overlaps(body_box)) return;
    const Vec3 &p0 = around_.x(e.a), &p1 = around_.x(e.b), &q0 = body_x(f.a), &q1 = body_x(f.b);
    if (!ridge_counts(body_.ridge_bend(body_edge), (p1 - p0).squaredNorm(), options_.range_m)) return;
    EdgeEdge at;
    if (!interior_edge_edge(p0, p1, q0, q1, at)) return;
    const Vec3 point = p0 + at.s * (p1 - p0);
    BodyContact record{ContactKind::edge_edge, {e.a, e.b, -1}, {1 - at.s, at.s, 0}, {f.a, f.b}, at.t, {}, 0};
    if (!set_gap(record, point - q0 - at.t * (q1 - q0), body_.edge_normal(body_edge))) return;
    // The region test with the direction in which the record pushes, for a penetrating pair as for a separate one.
    for (const Index t : f.triangle) {
      if (t < 0) continue;
      const Triangle& c = body_.triangle(t);
      const Vec3& opposite = body_x(c[0] + c[1] + c[2] - f.a - f.b);
      if (around_.leans(record.normal, Surroundings::inward(q0, q1, opposite))) return;
    }
    if (!around_.leaves_edge(cloth_edge, -record.normal) || !confirmed(record, point)) return;
    found.edge_keys.emplace_back(body_edge, cloth_edge);
    found.body_edges.push_back(record);
  }

  const ClothTopology& cloth_;
  const TriangleTree& tree_;
  Surroundings around_;
  const BodySurface& body_;
  ProximityOptions options_;
  const Memory& memory_;
};

// The features that each triangle of the body queries: the vertices that it owns, and the ridges that count for the longest
// edge of the cloth.  Most of a smooth body's edges are dropped here.
void mark_features(const ClothTopology& cloth, std::span<const Vec3> x, const BodySurface& body,
                   const ProximityOptions& options, Memory& memory) {
  double longest2 = 0;
  for (const Edge& e : cloth.topology().edges) {
    longest2 = std::max(longest2, (x[static_cast<std::size_t>(e.b)] - x[static_cast<std::size_t>(e.a)]).squaredNorm());
  }
  memory.body_features.resize(body.triangles().size());
  parallel_for(body.triangles().size(), triangle_grain, [&](std::size_t t) {
    unsigned bits = body.owned_ridges(static_cast<Index>(t));
    for (std::size_t k = 0; k < 3; ++k) {
      const double bend = body.ridge_bend(body.topology().triangle_edges[t][k]);
      if (!ridge_counts(bend, longest2, options.range_m)) bits &= ~(8u << k);
    }
    memory.body_features[t] = static_cast<std::uint8_t>(bits);
  });
}

// Appends one kind of record of all blocks, ascending by the keys.
void append_sorted(Memory& memory, std::size_t blocks, std::vector<std::pair<Index, Index>> Memory::Found::*keys,
                   std::vector<BodyContact> Memory::Found::*records, std::size_t first_count,
                   std::vector<BodyContact>& contacts) {
  memory.join(blocks, keys, records, memory.body_records);
  memory.sorted.sort(memory.keys, first_count);
  for (const Index i : memory.sorted.order()) contacts.push_back(memory.body_records[static_cast<std::size_t>(i)]);
}

}  // namespace

void find_body_contacts(const ClothTopology& cloth, TriangleTree& cloth_tree, std::span<const Vec3> x,
                        const BodySurface& body, const ProximityOptions& options, ProximityWorkspace& workspace,
                        std::vector<BodyContact>& contacts) {
  contacts.clear();
  Memory& memory = workspace.memory();
  memory.check(cloth, cloth_tree, x);
  cloth_tree.refit(x, x, std::max(options.range_m, options.depth_m));  // the body's boxes add nothing
  memory.set_face_normals(cloth, x);
  mark_features(cloth, x, body, options, memory);
  const BodyQuery query(cloth, cloth_tree, x, body, options, memory);
  const std::size_t triangles = body.triangles().size(), blocks = (triangles + feature_grain - 1) / feature_grain;
  memory.start_blocks(blocks);
  parallel_blocks(triangles, feature_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      query.meet_features(static_cast<Index>(t), memory.found[begin / feature_grain]);
  });
  append_sorted(memory, blocks, &Memory::Found::vertex_keys, &Memory::Found::body_vertices, body.positions().size(),
                contacts);
  append_sorted(memory, blocks, &Memory::Found::edge_keys, &Memory::Found::body_edges, body.topology().edges.size(),
                contacts);
}

}  // namespace toile::internal
