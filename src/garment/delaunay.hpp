// garment/delaunay.hpp: the constrained Delaunay triangulation of a simple polygon, which can be edited point by point.
//
// Only the inside of the polygon is stored: an edge of the outline is an edge without a neighbour, so it can never be
// flipped and no constraint has to be recovered.  The outline alone is triangulated by clipping ears (Meisters 1975);
// Lawson's flips (1977) with the exact in-circle test then make every inner edge Delaunay.
//
// Every triangle is counter-clockwise with positive area on the grid at all times, also between the calls.
// Easily got wrong: edge k of a triangle is the edge opposite its corner k.
#pragma once
#include "core/types.hpp"
#include "garment/exact_predicates.hpp"

#include <array>
#include <span>
#include <vector>

namespace toile::internal {

// The triangles of a simple polygon given counter-clockwise, by clipping ears; corners on a straight run are kept,
// and no triangle is flat.  O(n r) for r corners that are not convex.  `ring` holds indices into `points`.
std::vector<Triangle> clip_ears(std::span<const GridPoint> points, std::span<const Index> ring);

class Delaunay {
 public:
  static constexpr Index none = -1;

  struct Face {
    Triangle corner{none, none, none};     // counter-clockwise; corner[0] == none when the face has been removed
    Triangle neighbour{none, none, none};  // across the edge opposite corner k; none on the outline

    bool alive() const { return corner[0] != none; }
  };

  // `outline` is simple, either orientation; its points are the vertices 0 .. n-1 and stay for ever.
  explicit Delaunay(std::vector<GridPoint> outline);

  const std::vector<GridPoint>& points() const { return points_; }
  const std::vector<Face>& faces() const { return faces_; }
  Index outline_count() const { return outline_count_; }
  bool on_outline(Index vertex) const { return vertex < outline_count_; }
  bool alive(Index vertex) const { return face_of_[static_cast<std::size_t>(vertex)] != none; }
  Index face_of(Index vertex) const { return face_of_[static_cast<std::size_t>(vertex)]; }
  std::array<GridPoint, 3> corners(const Face& face) const;

  // The faces around an inner vertex, counter-clockwise.
  void star(Index vertex, std::vector<Index>& faces) const;

  // The face that holds `p` (in its inside or on its edge), walking from `start`; none when the outline stops the walk.
  Index walk(const GridPoint& p, Index start) const;
  // The same, searching every face when the walk is stopped; none only when `p` lies outside.
  Index locate(const GridPoint& p, Index start) const;

  // Adds a vertex inside `face` (from walk or locate) and restores the Delaunay property.  Returns none, and changes
  // nothing, when `p` is a vertex or lies on the outline.
  Index insert(const GridPoint& p, Index face);
  // Takes an inner vertex away and restores the Delaunay property.
  void remove(Index vertex);
  // Moves an inner vertex unless a face would lose its positive area.  The Delaunay property is not restored.
  bool move(Index vertex, const GridPoint& p);
  // Flips until the faces around `vertex` are Delaunay, or all are.
  void legalize_around(Index vertex);
  void legalize();

  // A trial: everything between begin and commit or roll_back can be undone, and the faces it changed are listed with
  // the corners they had before.
  struct Changed {
    Index face;
    Face before;
    std::array<GridPoint, 3> corners_before;  // only when before.alive()
  };
  void begin();
  void commit();
  void roll_back();
  const std::vector<Changed>& changed() const { return changed_; }  // each face once, in the order it was first touched
  Index face_count_at_begin() const { return first_new_face_; }     // faces from here on are new

 private:
  struct ChangedVertex {
    Index vertex;
    GridPoint point;
    Index face;
  };

  const GridPoint& point(Index vertex) const { return points_[static_cast<std::size_t>(vertex)]; }
  const Face& face(Index f) const { return faces_[static_cast<std::size_t>(f)]; }
  Face& edit(Index f);  // every write to a face goes through here, for the sake of trials
  void set_face_of(Index vertex, Index f);
  void set_point(Index vertex, const GridPoint& p);
  void remember_vertex(Index vertex);
  Index add_face();
  Index add_vertex(const GridPoint& p);
  void write(Index f, const Triangle& corner, const Triangle& neighbour);
  void relink(Index f, Index from, Index to);  // f's neighbour `from` becomes `to`; f may be none
  void flip(Index f, int k);
  void flip_pending();  // Lawson's loop over pending_
  void link_all();

  std::vector<GridPoint> points_;
  std::vector<Index> face_of_;  // one face at the vertex
  std::vector<Face> faces_;
  Index outline_count_ = 0;

  struct Edge {
    Index face;
    int k;
  };
  std::vector<Edge> pending_;
  mutable std::vector<Index> ring_;  // scratch: the faces around a vertex

  bool trial_ = false;
  std::uint32_t stamp_ = 0;
  std::vector<std::uint32_t> face_stamp_;
  std::vector<Changed> changed_;
  std::vector<ChangedVertex> changed_vertices_;
  Index first_new_face_ = 0, first_new_vertex_ = 0;
};

}  // namespace toile::internal
