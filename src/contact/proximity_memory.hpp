// contact/proximity_memory.hpp: the memory of the proximity queries, and the region test that both use.  Internal.
#pragma once
#include "contact/proximity.hpp"

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace toile::internal {

struct ProximityWorkspace::Memory {
  using Keys = std::vector<std::pair<Index, Index>>;

  // The place on a triangle nearest to a vertex.  Packed into one number, ascending with the triangle: on a fine mesh
  // every vertex has dozens of these, and few become contacts.
  class Place {
   public:
    Place() = default;
    Place(Index triangle, const VertexTriangle& at)
        : packed_(static_cast<std::uint32_t>(triangle) << 4 | static_cast<std::uint32_t>(at.feature) << 2 |
                  static_cast<std::uint32_t>(at.index)) {}
    Index triangle() const { return static_cast<Index>(packed_ >> 4); }
    Feature feature() const { return static_cast<Feature>(packed_ >> 2 & 3u); }
    std::size_t index() const { return packed_ & 3u; }
    bool operator<(Place other) const { return packed_ < other.packed_; }
    static constexpr std::size_t most_triangles = std::size_t{1} << 28;

   private:
    std::uint32_t packed_ = 0;
  };

  // The pairs found by one block of features, in the order of its traversals.
  struct Found {
    Keys vertex_keys, edge_keys;      // features of the two sides; vertex_keys: the body's vertices
    std::vector<ClothContact> edges;  // cloth: by edge_keys
    std::vector<BodyContact> body_vertices, body_edges;
  };
  // The contacts reported by one block of vertices.
  struct Reported {
    std::vector<ClothContact> faces, edges, vertices;
    std::vector<Place> places;  // near the current vertex
    std::vector<Index> edge_candidates, vertex_candidates;
  };

  ParticleBoxes boxes;  // of the cloth against itself, relative to its mean
  std::vector<Vec3> face_normals;
  std::vector<std::uint8_t> flat;           // [triangle] bit 3 + k: edge k is flat
  std::vector<std::uint8_t> body_features;  // [triangle of the body] as BodySurface::owned_ridges
  std::vector<Found> found;                 // by block of features
  std::vector<Reported> reported;           // by block of vertices
  Keys keys;
  std::vector<ClothContact> cloth_edges;
  std::vector<BodyContact> body_records;
  BucketOrder sorted;

  // Throws InputError when `x` is not of this cloth.
  void check(const ClothTopology& cloth, const TriangleTree& tree, std::span<const Vec3> x) const;
  void set_face_normals(const ClothTopology& cloth, std::span<const Vec3> x);
  void start_blocks(std::size_t blocks);
  // `keys` and `all` become the results of the blocks, one after the other.
  template <class Record>
  void join(std::size_t blocks, Keys Found::*keys_of, std::vector<Record> Found::*records, std::vector<Record>& all) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < blocks; ++i) count += (found[i].*keys_of).size();
    keys.clear();
    all.clear();
    if (count > keys.capacity()) keys.reserve(2 * count);  // else they would grow by one record, time and again
    if (count > all.capacity()) all.reserve(2 * count);
    for (std::size_t i = 0; i < blocks; ++i) {
      keys.insert(keys.end(), (found[i].*keys_of).begin(), (found[i].*keys_of).end());
      all.insert(all.end(), (found[i].*records).begin(), (found[i].*records).end());
    }
  }
};

// The surroundings of the cloth's features, for the region test.  A seam's partner counts once it is within `range_m`:
// an open seam is two rims, a closed one is cloth.
class Surroundings {
 public:
  Surroundings(const ClothTopology& cloth, std::span<const Vec3> x, const ProximityOptions& options)
      : cloth_(cloth),
        x_(x),
        range2_(options.range_m * options.range_m),
        tolerance2_(options.region_tolerance * options.region_tolerance) {}

  const Vec3& x(Index particle) const { return x_[static_cast<std::size_t>(particle)]; }

  // True where u, from a point of the edge, does not lean into one of the edge's triangles.
  bool leaves_edge(Index edge, const Vec3& u) const {
    for (const Index e : cloth_.merged_edges(edge)) {
      if (e != edge && !near(edge, e)) continue;
      const Edge& at = cloth_.edge(e);
      for (const Index t : at.triangle) {
        if (t < 0) continue;
        const Triangle& c = cloth_.triangle(t);
        if (leans(u, inward(x(at.a), x(at.b), x(c[0] + c[1] + c[2] - at.a - at.b)))) return false;
      }
    }
    return true;
  }

  // True where u does not lean along one of the edges that leave the vertex.
  bool leaves_vertex(Index vertex, const Vec3& u) const {
    for (const Index corner : cloth_.corners_around(vertex)) {
      const Triangle& c = cloth_.triangle(corner / 3);
      const auto k = static_cast<std::size_t>(corner % 3);
      if (c[k] != vertex && !near_particles(c[k], vertex)) continue;
      const Vec3& from = x(c[k]);
      if (leans(u, x(c[(k + 1) % 3]) - from) || leans(u, x(c[(k + 2) % 3]) - from)) return false;
    }
    return true;
  }

  // The part of a -> opposite across the edge a -> b: points into the triangle, within its plane; not a unit vector.
  static Vec3 inward(const Vec3& a, const Vec3& b, const Vec3& opposite) {
    const Vec3 along = b - a, to = opposite - a;
    const double length2 = along.squaredNorm();
    return length2 > 0 ? Vec3(to - to.dot(along) / length2 * along) : to;
  }
  bool leans(const Vec3& u, const Vec3& t) const {
    const double product = u.dot(t);
    return product > 0 && product * product > tolerance2_ * t.squaredNorm();
  }

 private:
  bool near_particles(Index i, Index j) const { return (x(i) - x(j)).squaredNorm() < range2_; }
  bool near(Index edge, Index other) const {
    const Edge &e = cloth_.edge(edge), &f = cloth_.edge(other);
    return cloth_.merged(e.a) == cloth_.merged(f.a) ? near_particles(e.a, f.a) && near_particles(e.b, f.b)
                                                    : near_particles(e.a, f.b) && near_particles(e.b, f.a);
  }

  const ClothTopology& cloth_;
  std::span<const Vec3> x_;
  double range2_, tolerance2_;
};

}  // namespace toile::internal
