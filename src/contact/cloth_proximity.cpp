// The cloth against itself: vertex by vertex the triangles in its box and the choice of records, then edges with edges.
#include "contact/proximity_memory.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace toile::internal {
namespace {

constexpr std::size_t query_grain = 512, cloth_triangle_grain = 1024;
constexpr double cloth_touching_m = 1e-12;  // nearer than this the direction between two points is rounding

using Memory = ProximityWorkspace::Memory;

bool by_particles(const ClothContact& a, const ClothContact& b) { return a.particle < b.particle; }

// One query: its input, and the two kinds of features.
class ClothQuery {
 public:
  ClothQuery(const ClothTopology& cloth, const TriangleTree& tree, std::span<const Vec3> x,
             const ProximityOptions& options, const Memory& memory, const FeaturePairs* pairs)
      : cloth_(cloth),
        tree_(tree),
        around_(cloth, x, options),
        range_m_(options.range_m),
        memory_(memory),
        pairs_(pairs) {}

  // The places within range of a vertex that become records.
  void meet_vertex(Index vertex, Memory::Reported& out) const {
    if (cloth_.corners_around(vertex).empty()) return;
    out.places.clear();
    if (pairs_) {
      for (const Index t : pairs_->triangles_near(vertex)) add_place(vertex, t, out.places);
    } else {
      tree_.visit_overlapping(tree_.particle_box(vertex), [&](Index t) { add_place(vertex, t, out.places); });
    }
    if (out.places.empty()) return;
    std::sort(out.places.begin(), out.places.end());
    const std::size_t first_face = out.faces.size();
    out.edge_candidates.clear();
    out.vertex_candidates.clear();
    for (const Memory::Place place : out.places) {
      const Index t = place.triangle();
      if (place.feature() == Feature::face) {
        add_face(vertex, t, out.faces);
      } else if (place.feature() == Feature::edge) {
        out.edge_candidates.push_back(cloth_.triangle_edges(t)[place.index()]);
      } else {
        out.vertex_candidates.push_back(cloth_.triangle(t)[place.index()]);
      }
    }
    std::sort(out.faces.begin() + static_cast<std::ptrdiff_t>(first_face), out.faces.end(), by_particles);
    const auto faces = std::span(out.faces).subspan(first_face);

    const std::size_t first_edge = out.edges.size();
    sort_unique(out.edge_candidates);
    for (const Index e : out.edge_candidates) {
      if (!nearer(faces, cloth_.edge(e).a, cloth_.edge(e).b)) add_edge(vertex, e, out.edges);
    }
    const auto edges = std::span(out.edges).subspan(first_edge);

    sort_unique(out.vertex_candidates);
    for (const Index w : out.vertex_candidates) {
      if (!nearer(faces, w, w) && !nearer(edges, w, w)) add_vertex(vertex, w, out.vertices);
    }
  }

  // The edges that a triangle owns, against others; one of two has to be bent.
  void meet_edges(Index t, Memory::Found& found) const {
    const unsigned owned = static_cast<unsigned>(cloth_.owned(t)) >> 3, flat = flat_edges(t);
    if (pairs_) {
      for_lanes(owned, [&](std::size_t k) { look_up_edge(cloth_.triangle_edges(t)[k], flat >> k & 1u, found); });
    } else {
      for_lanes(owned & ~flat, [&](std::size_t k) { meet_edge(cloth_.triangle_edges(t)[k], found); });
    }
  }

 private:
  // An edge that is not flat with all others: one pair of two that are not flat counts for the lesser.
  void meet_edge(Index first, Memory::Found& found) const {
    const Edge& e = cloth_.edge(first);
    const Index ea = cloth_.merged(e.a), eb = cloth_.merged(e.b);
    const OuterBox box = tree_.edge_box(e.a, e.b);
    tree_.visit_overlapping(box, [&](Index t) {
      const unsigned flat = flat_edges(t);
      for_lanes(static_cast<unsigned>(cloth_.owned(t)) >> 3, [&](std::size_t k) {
        const Index second = cloth_.triangle_edges(t)[k];
        if (second <= first && !(flat >> k & 1u)) return;
        const Edge& f = cloth_.edge(second);
        const Index fa = cloth_.merged(f.a), fb = cloth_.merged(f.b);
        if (ea == fa || ea == fb || eb == fa || eb == fb || !box.overlaps(tree_.edge_box(f.a, f.b))) return;
        meet_edge_pair(std::min(first, second), std::max(first, second), found);
      });
    });
  }

  // Likewise, of the list.
  void look_up_edge(Index first, bool first_is_flat, Memory::Found& found) const {
    const std::span<const Index> near = pairs_->edges_near(first);
    if (near.empty()) return;
    const Edge& e = cloth_.edge(first);
    const OuterBox box = memory_.boxes.edge(e.a, e.b);
    for (const Index second : near) {
      const Edge& f = cloth_.edge(second);
      if (box.overlaps(memory_.boxes.edge(f.a, f.b)) && !(first_is_flat && is_flat(second)))
        meet_edge_pair(first, second, found);
    }
  }

  // Bit k: edge k of the triangle is flat.
  unsigned flat_edges(Index t) const { return static_cast<unsigned>(memory_.flat[static_cast<std::size_t>(t)]) >> 3; }
  bool is_flat(Index edge) const {
    const Index t = cloth_.edge(edge).triangle[0];
    const std::array<Index, 3>& edges = cloth_.triangle_edges(t);
    const unsigned k = edges[0] == edge ? 0 : edges[1] == edge ? 1 : 2;
    return flat_edges(t) >> k & 1u;
  }

  static void sort_unique(std::vector<Index>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }

  // Does one of these records of a vertex lie on a face or edge with both (merged) particles a and b?
  bool nearer(std::span<const ClothContact> records, Index a, Index b) const {
    const Index ma = cloth_.merged(a), mb = cloth_.merged(b);
    return std::any_of(records.begin(), records.end(), [&](const ClothContact& record) {
      bool has_a = false, has_b = false;
      for (std::size_t k = 1; k < 4; ++k) {
        if (record.particle[k] < 0) continue;
        const Index m = cloth_.merged(record.particle[k]);
        has_a = has_a || m == ma;
        has_b = has_b || m == mb;
      }
      return has_a && has_b;
    });
  }

  void add_place(Index v, Index t, std::vector<Memory::Place>& places) const {
    const Triangle& merged = cloth_.merged_triangle(t);
    const Index m = cloth_.merged(v);
    if (m == merged[0] || m == merged[1] || m == merged[2]) return;
    const Triangle& corners = cloth_.triangle(t);
    const Vec3 &p = around_.x(v), &origin = around_.x(corners[0]);
    // The distance to the plane is a lower bound, and one product.
    if (std::fabs(face_normal(t).dot(p - origin)) >= range_m_) return;
    const VertexTriangle at = closest_vertex_triangle(p, origin, around_.x(corners[1]), around_.x(corners[2]));
    if (at.distance2 < range_m_ * range_m_) places.emplace_back(t, at);
  }

  void meet_edge_pair(Index first, Index second, Memory::Found& found) const {
    const Edge &e = cloth_.edge(first), &f = cloth_.edge(second);
    EdgeEdge at;
    const Vec3 &p0 = around_.x(e.a), &p1 = around_.x(e.b), &q0 = around_.x(f.a), &q1 = around_.x(f.b);
    if (!interior_edge_edge(p0, p1, q0, q1, at) || !(at.distance2 < range_m_ * range_m_)) return;
    ClothContact record{ContactKind::edge_edge, {e.a, e.b, f.a, f.b}, {1 - at.s, at.s, -(1 - at.t), -at.t}, {}, 0};
    const Vec3 between = p0 + at.s * (p1 - p0) - q0 - at.t * (q1 - q0);
    if (!set_direction(record, between, [&] { return Vec3((p1 - p0).cross(q1 - q0)); })) return;
    if (!around_.leaves_edge(second, record.normal) || !around_.leaves_edge(first, -record.normal)) return;
    found.edge_keys.emplace_back(first, second);
    found.edges.push_back(record);
  }

  // Gap and normal from the vector between the closest points, or from `instead` where they coincide; false when
  // neither has a direction.
  template <class Instead>
  static bool set_direction(ClothContact& record, const Vec3& between, Instead&& instead) {
    record.gap_m = between.norm();
    if (record.gap_m > cloth_touching_m) {
      record.normal = between / record.gap_m;
      return true;
    }
    const Vec3 direction = instead();
    const double length = direction.norm();
    if (!(length > 0)) return false;
    record.normal = direction / length;
    return true;
  }

  const Vec3& face_normal(Index t) const { return memory_.face_normals[static_cast<std::size_t>(t)]; }

  // The closest point once more: few of the places from stage 1 are on faces.
  void add_face(Index v, Index t, std::vector<ClothContact>& out) const {
    const Triangle& c = cloth_.triangle(t);
    const Vec3 b = closest_vertex_triangle(around_.x(v), around_.x(c[0]), around_.x(c[1]), around_.x(c[2])).barycentric;
    ClothContact record{ContactKind::vertex_face, {v, c[0], c[1], c[2]}, {1, -b[0], -b[1], -b[2]}, {}, 0};
    const Vec3 between = around_.x(v) - b[0] * around_.x(c[0]) - b[1] * around_.x(c[1]) - b[2] * around_.x(c[2]);
    if (set_direction(record, between, [&] { return face_normal(t); })) out.push_back(record);
  }

  // The closest point is computed from the edge alone, so that it does not depend on which triangle reported it.
  void add_edge(Index v, Index e, std::vector<ClothContact>& out) const {
    const Edge& edge = cloth_.edge(e);
    const Vec3 &a = around_.x(edge.a), along = around_.x(edge.b) - a, from = around_.x(v) - a;
    const double t = std::clamp(from.dot(along) / along.squaredNorm(), 0.0, 1.0);
    ClothContact record{ContactKind::vertex_edge, {v, edge.a, edge.b, -1}, {1, -(1 - t), -t, 0}, {}, 0};
    const auto instead = [&] {
      Vec3 sum = face_normal(edge.triangle[0]);
      if (edge.triangle[1] >= 0) sum += face_normal(edge.triangle[1]);
      return sum;
    };
    if (set_direction(record, from - t * along, instead) && around_.leaves_edge(e, record.normal)) {
      out.push_back(record);
    }
  }

  // With the same bits from both sides.
  void add_vertex(Index v, Index w, std::vector<ClothContact>& out) const {
    const Index i = std::min(v, w), j = std::max(v, w);
    ClothContact record{ContactKind::vertex_vertex, {i, j, -1, -1}, {1, -1, 0, 0}, {}, 0};
    const auto instead = [&] {
      Vec3 sum = Vec3::Zero();
      for (const Index corner : cloth_.corners_around(j)) sum += face_normal(corner / 3);
      return sum;
    };
    if (!set_direction(record, around_.x(i) - around_.x(j), instead)) return;
    const Vec3 u = v == i ? record.normal : Vec3(-record.normal);
    if (around_.leaves_vertex(w, u)) out.push_back(record);
  }

  const ClothTopology& cloth_;
  const TriangleTree& tree_;
  Surroundings around_;
  double range_m_;
  const Memory& memory_;
  const FeaturePairs* pairs_;  // valid lists, or null
};

void mark_flat_edges(const ClothTopology& cloth, std::span<const std::array<Index, 2>> bent, Memory& memory) {
  const double flat_cosine = std::sqrt(1 - flat_edge_sine * flat_edge_sine);
  memory.flat.resize(cloth.triangles().size());
  parallel_for(cloth.triangles().size(), cloth_triangle_grain, [&](std::size_t t) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Edge& edge = cloth.edge(cloth.triangle_edges(static_cast<Index>(t))[k]);
      if (edge.triangle[1] < 0) continue;
      const double cosine = memory.face_normals[static_cast<std::size_t>(edge.triangle[0])].dot(
          memory.face_normals[static_cast<std::size_t>(edge.triangle[1])]);
      if (cosine >= flat_cosine) bits |= 8u << k;
    }
    memory.flat[t] = static_cast<std::uint8_t>(bits);
  });
  for (const std::array<Index, 2>& edge : bent) {
    for (const Index corner : cloth.corners_around(edge[0])) {
      const auto t = static_cast<std::size_t>(corner / 3);
      for (std::size_t k = 0; k < 3; ++k) {
        const Edge& at = cloth.edge(cloth.triangle_edges(corner / 3)[k]);
        if (at.a == edge[0] && at.b == edge[1]) memory.flat[t] &= static_cast<std::uint8_t>(~(8u << k));
      }
    }
  }
}

// Of the vertex-vertex records from `first` on, sorts them and keeps one of each that both vertices have chosen.
void keep_mutual(std::vector<ClothContact>& contacts, std::size_t first) {
  std::sort(contacts.begin() + static_cast<std::ptrdiff_t>(first), contacts.end(), by_particles);
  std::size_t kept = first;
  for (std::size_t i = first; i + 1 < contacts.size(); ++i) {
    if (contacts[i].particle == contacts[i + 1].particle) contacts[kept++] = contacts[i];
  }
  contacts.erase(contacts.begin() + static_cast<std::ptrdiff_t>(kept), contacts.end());
}

}  // namespace

ProximityWorkspace::ProximityWorkspace() : memory_(std::make_unique<Memory>()) {}
ProximityWorkspace::~ProximityWorkspace() = default;
ProximityWorkspace::ProximityWorkspace(ProximityWorkspace&&) noexcept = default;
ProximityWorkspace& ProximityWorkspace::operator=(ProximityWorkspace&&) noexcept = default;

void ProximityWorkspace::Memory::check(const ClothTopology& cloth, [[maybe_unused]] const TriangleTree& tree,
                                       std::span<const Vec3> x) const {
  if (x.size() != cloth.particle_count()) {
    throw InputError("", "cloth positions", std::to_string(cloth.particle_count()) + " particles",
                     std::to_string(x.size()));
  }
  TOILE_ASSERT(static_cast<std::size_t>(tree.triangle_count()) == cloth.triangles().size());
  TOILE_ASSERT(cloth.triangles().size() <= Place::most_triangles);
}

void ProximityWorkspace::Memory::set_face_normals(const ClothTopology& cloth, std::span<const Vec3> x) {
  face_normals.resize(cloth.triangles().size());
  parallel_for(face_normals.size(), cloth_triangle_grain, [&](std::size_t t) {
    const Triangle& c = cloth.triangles()[t];
    const Vec3& a = x[static_cast<std::size_t>(c[0])];
    const Vec3 n = (x[static_cast<std::size_t>(c[1])] - a).cross(x[static_cast<std::size_t>(c[2])] - a);
    const double length = n.norm();
    face_normals[t] = length > 0 ? Vec3(n / length) : Vec3::Zero();
  });
}

void ProximityWorkspace::Memory::start_blocks(std::size_t blocks) {
  if (found.size() < blocks) found.resize(blocks);
  for (std::size_t i = 0; i < blocks; ++i) {
    found[i].vertex_keys.clear();
    found[i].edge_keys.clear();
    found[i].edges.clear();
    found[i].body_vertices.clear();
    found[i].body_edges.clear();
  }
}

void find_cloth_contacts(const ClothTopology& cloth, TriangleTree& tree, std::span<const Vec3> x,
                         const ProximityOptions& options, ProximityWorkspace& workspace,
                         std::vector<ClothContact>& contacts, FeaturePairs* pairs) {
  contacts.clear();
  Memory& memory = workspace.memory();
  memory.check(cloth, tree, x);
  memory.boxes.set_seen_from_mean(x, x, options.range_m / 2);
  if (!pairs || !pairs->seek(cloth, tree, memory.boxes)) {
    pairs = nullptr;
    tree.refit(memory.boxes);
  }
  memory.set_face_normals(cloth, x);
  mark_flat_edges(cloth, options.bent, memory);
  const ClothQuery query(cloth, tree, x, options, memory, pairs);

  const std::size_t blocks = (x.size() + query_grain - 1) / query_grain;
  if (memory.reported.size() < blocks) memory.reported.resize(blocks);
  parallel_blocks(x.size(), query_grain, [&](std::size_t begin, std::size_t end) {
    Memory::Reported& out = memory.reported[begin / query_grain];
    out.faces.clear();
    out.edges.clear();
    out.vertices.clear();
    for (auto v = static_cast<Index>(begin); v < static_cast<Index>(end); ++v) query.meet_vertex(v, out);
  });

  const auto append = [&](std::vector<ClothContact> Memory::Reported::*list) {
    for (std::size_t b = 0; b < blocks; ++b) {
      contacts.insert(contacts.end(), (memory.reported[b].*list).begin(), (memory.reported[b].*list).end());
    }
  };
  append(&Memory::Reported::faces);
  append(&Memory::Reported::edges);
  const std::size_t first_pair = contacts.size();
  append(&Memory::Reported::vertices);
  keep_mutual(contacts, first_pair);

  const std::size_t triangles = cloth.triangles().size(), triangle_blocks = (triangles + query_grain - 1) / query_grain;
  memory.start_blocks(triangle_blocks);
  parallel_blocks(triangles, query_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      query.meet_edges(static_cast<Index>(t), memory.found[begin / query_grain]);
  });
  memory.join(triangle_blocks, &Memory::Found::edge_keys, &Memory::Found::edges, memory.cloth_edges);
  memory.sorted.sort(memory.keys, cloth.topology().edges.size());
  for (const Index i : memory.sorted.order()) contacts.push_back(memory.cloth_edges[static_cast<std::size_t>(i)]);
}

}  // namespace toile::internal
