// garment/delaunay.cpp: flips, insertion, removal and point location; see delaunay.hpp.
//
// References: C. L. Lawson, Software for C1 surface interpolation (1977); O. Devillers, S. Pion, M. Teillaud, Walking
// in a triangulation (2002).
#include "garment/delaunay.hpp"

#include "core/error.hpp"

#include <algorithm>

namespace toile::internal {

namespace {

std::size_t next(std::size_t k) { return k == 2 ? 0 : k + 1; }
std::size_t previous(std::size_t k) { return k == 0 ? 2 : k - 1; }

std::size_t slot_of(const Triangle& triangle, Index value) {
  TOILE_ASSERT(triangle[0] == value || triangle[1] == value || triangle[2] == value);
  return triangle[0] == value ? 0 : triangle[1] == value ? 1 : 2;
}

bool inside(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& p) {
  return orient2d(a, b, p) >= 0 && orient2d(b, c, p) >= 0 && orient2d(c, a, p) >= 0;
}

struct HalfEdge {  // from < to; the two half-edges of an inner edge are neighbours when sorted
  Index from, to, face;
  int k;
};

}  // namespace

std::vector<Triangle> clip_ears(std::span<const GridPoint> points, std::span<const Index> ring) {
  const std::size_t n = ring.size();
  std::vector<std::size_t> before(n), after(n);
  for (std::size_t i = 0; i < n; ++i) {
    before[i] = i == 0 ? n - 1 : i - 1;
    after[i] = i + 1 == n ? 0 : i + 1;
  }
  const auto p = [&](std::size_t i) -> const GridPoint& { return points[at(ring[i])]; };
  const auto is_convex = [&](std::size_t i) { return orient2d(p(before[i]), p(i), p(after[i])) > 0; };
  std::vector<char> convex(n);
  for (std::size_t i = 0; i < n; ++i) convex[i] = is_convex(i);

  // An ear is a convex corner whose closed triangle holds no other corner.  Only corners that are not convex need the
  // test: of the corners inside, the one farthest from the diagonal sees the ear's tip and has both its edges turned
  // away from it.
  const auto is_ear = [&](std::size_t i) {
    if (!convex[i]) return false;
    const GridPoint &a = p(before[i]), &b = p(i), &c = p(after[i]);
    const auto [x0, x1] = std::minmax({a.x, b.x, c.x});
    const auto [y0, y1] = std::minmax({a.y, b.y, c.y});
    for (std::size_t j = after[after[i]]; j != before[i]; j = after[j]) {
      if (convex[j]) continue;
      const GridPoint& q = p(j);
      if (q.x < x0 || q.x > x1 || q.y < y0 || q.y > y1) continue;
      if (inside(a, b, c, q)) return false;
    }
    return true;
  };

  std::vector<Triangle> triangles;
  triangles.reserve(n - 2);
  std::size_t left = n, current = 0, misses = 0;
  while (left > 3) {
    if (!is_ear(current)) {
      // Every simple polygon with more than three corners has two ears, so a full turn without one means it was not
      // simple.
      if (++misses > left) throw Error(ErrorKind::internal, "clip_ears: the polygon is not simple");
      current = after[current];
      continue;
    }
    const std::size_t a = before[current], c = after[current];
    triangles.push_back({ring[a], ring[current], ring[c]});
    after[a] = c;
    before[c] = a;
    convex[a] = is_convex(a);
    convex[c] = is_convex(c);
    --left;
    misses = 0;
    current = after[c];  // skipping one corner makes wide ears rather than a fan
  }
  triangles.push_back({ring[before[current]], ring[current], ring[after[current]]});
  return triangles;
}

Delaunay::Delaunay(std::vector<GridPoint> outline) : points_(std::move(outline)) {
  outline_count_ = static_cast<Index>(points_.size());
  std::vector<Index> ring(points_.size());
  std::int64_t twice_area = 0;
  for (Index i = 0; i < outline_count_; ++i) {
    ring[at(i)] = i;
    twice_area += orient2d({}, point(i), point(i + 1 == outline_count_ ? 0 : i + 1));
  }
  if (twice_area < 0) std::reverse(ring.begin(), ring.end());
  for (const Triangle& triangle : clip_ears(points_, ring)) {
    faces_.push_back({triangle, {none, none, none}});
    face_stamp_.push_back(0);
  }
  link_all();
  legalize();
}

void Delaunay::link_all() {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * faces_.size());
  face_of_.assign(points_.size(), none);
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const Triangle& corner = faces_[f].corner;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [from, to] = std::minmax(corner[next(k)], corner[previous(k)]);
      edges.push_back({from, to, static_cast<Index>(f), static_cast<int>(k)});
      face_of_[at(corner[k])] = static_cast<Index>(f);
    }
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return a.from != b.from ? a.from < b.from : a.to != b.to ? a.to < b.to : a.face < b.face;
  });
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const HalfEdge &a = edges[i], &b = edges[i + 1];
    if (a.from != b.from || a.to != b.to) continue;
    faces_[at(a.face)].neighbour[static_cast<std::size_t>(a.k)] = b.face;
    faces_[at(b.face)].neighbour[static_cast<std::size_t>(b.k)] = a.face;
  }
}

std::array<GridPoint, 3> Delaunay::corners(const Face& f) const {
  return {point(f.corner[0]), point(f.corner[1]), point(f.corner[2])};
}

void Delaunay::star(Index vertex, std::vector<Index>& faces) const {
  TOILE_ASSERT(!on_outline(vertex) && alive(vertex));
  faces.clear();
  const Index first = face_of(vertex);
  Index f = first;
  do {
    faces.push_back(f);
    const Face& current = face(f);
    f = current
            .neighbour[next(slot_of(current.corner, vertex))];  // across the edge vertex -> its clockwise-last corner
  } while (f != first);
}

Index Delaunay::walk(const GridPoint& p, Index start) const {
  // The walk may be stopped by the outline, and among constrained edges it could in principle turn in a circle; the
  // limit costs nothing and locate() is always right.
  Index f = start, came_from = none;
  for (std::size_t steps = 0; steps <= faces_.size(); ++steps) {
    const Face& current = face(f);
    Index onward = none;
    bool outside = false;
    for (std::size_t k = 0; k < 3 && onward == none; ++k) {
      if (current.neighbour[k] == came_from && came_from != none) continue;
      if (orient2d(point(current.corner[next(k)]), point(current.corner[previous(k)]), p) < 0) {
        outside = true;
        onward = current.neighbour[k];
      }
    }
    if (!outside) return f;
    if (onward == none) return none;
    came_from = f;
    f = onward;
  }
  return none;
}

Index Delaunay::locate(const GridPoint& p, Index start) const {
  if (const Index f = walk(p, start); f != none) return f;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const Face& candidate = faces_[f];
    if (!candidate.alive()) continue;
    if (inside(point(candidate.corner[0]), point(candidate.corner[1]), point(candidate.corner[2]), p))
      return static_cast<Index>(f);
  }
  return none;
}

Index Delaunay::insert(const GridPoint& p, Index f) {
  const Face old = face(f);
  int on_edge = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    if (point(old.corner[k]) == p) return none;
    const std::int64_t side = orient2d(point(old.corner[next(k)]), point(old.corner[previous(k)]), p);
    TOILE_ASSERT(side >= 0);
    if (side == 0) on_edge = static_cast<int>(k);
  }
  if (on_edge < 0) {
    const Index v = add_vertex(p), f1 = add_face(), f2 = add_face();
    const auto [a, b, c] = old.corner;
    const auto [na, nb, nc] = old.neighbour;
    write(f, {v, b, c}, {na, f1, f2});
    write(f1, {v, c, a}, {nb, f2, f});
    write(f2, {v, a, b}, {nc, f, f1});
    relink(nb, f, f1);
    relink(nc, f, f2);
    pending_.insert(pending_.end(), {{f, 0}, {f1, 0}, {f2, 0}});
    flip_pending();
    return v;
  }
  const std::size_t k = static_cast<std::size_t>(on_edge);
  const Index g = old.neighbour[k];
  if (g == none) return none;
  // p is on the edge ab between c (in f) and d (in g): four faces.
  const Face other = face(g);
  const std::size_t j = slot_of(other.neighbour, f);
  const Index c = old.corner[k], a = old.corner[next(k)], b = old.corner[previous(k)], d = other.corner[j];
  const Index n_bc = old.neighbour[next(k)], n_ca = old.neighbour[previous(k)];
  const Index n_ad = other.neighbour[next(j)], n_db = other.neighbour[previous(j)];
  const Index v = add_vertex(p), f1 = add_face(), g1 = add_face();
  write(f, {v, b, c}, {n_bc, f1, g1});
  write(f1, {v, c, a}, {n_ca, g, f});
  write(g, {v, a, d}, {n_ad, g1, f1});
  write(g1, {v, d, b}, {n_db, f, g});
  relink(n_ca, f, f1);
  relink(n_db, g, g1);
  pending_.insert(pending_.end(), {{f, 0}, {f1, 0}, {g, 0}, {g1, 0}});
  flip_pending();
  return v;
}

void Delaunay::remove(Index vertex) {
  TOILE_ASSERT(!on_outline(vertex) && alive(vertex));
  std::vector<Index> around;
  star(vertex, around);
  std::vector<Index> ring, outer;  // corner i of the hole, and the face across the edge from corner i to i + 1
  for (const Index f : around) {
    const Face& current = face(f);
    const std::size_t k = slot_of(current.corner, vertex);
    ring.push_back(current.corner[next(k)]);
    outer.push_back(current.neighbour[k]);
  }
  const std::vector<Triangle> filling = clip_ears(points_, ring);
  std::vector<Face> faces;
  for (const Triangle& triangle : filling) {
    Face filled{triangle, {none, none, none}};
    for (std::size_t k = 0; k < 3; ++k) {
      const Index from = triangle[next(k)], to = triangle[previous(k)];
      for (std::size_t i = 0; i < ring.size(); ++i)
        if (ring[i] == from && ring[i + 1 == ring.size() ? 0 : i + 1] == to) filled.neighbour[k] = outer[i];
      for (std::size_t other = 0; other < filling.size(); ++other)
        for (std::size_t m = 0; m < 3; ++m)
          if (filling[other][next(m)] == to && filling[other][previous(m)] == from) filled.neighbour[k] = around[other];
    }
    faces.push_back(filled);
  }
  for (std::size_t i = 0; i < around.size(); ++i) {
    if (i < faces.size())
      write(around[i], faces[i].corner, faces[i].neighbour);
    else
      edit(around[i]) = Face{};
  }
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index g = faces[i].neighbour[k];
      if (g == none) continue;
      const Triangle& corner = faces[i].corner;
      // The neighbour outside the hole still names the face that was there before; find its slot by the shared edge.
      const Face& beyond = face(g);
      for (std::size_t m = 0; m < 3; ++m)
        if (beyond.corner[next(m)] == corner[previous(k)] && beyond.corner[previous(m)] == corner[next(k)] &&
            beyond.neighbour[m] != around[i])
          edit(g).neighbour[m] = around[i];
      pending_.push_back({around[i], static_cast<int>(k)});
    }
  set_face_of(vertex, none);
  flip_pending();
}

bool Delaunay::move(Index vertex, const GridPoint& p) {
  if (p == point(vertex)) return true;
  star(vertex, ring_);
  for (const Index f : ring_) {
    const Triangle& corner = face(f).corner;
    const std::size_t k = slot_of(corner, vertex);
    if (orient2d(p, point(corner[next(k)]), point(corner[previous(k)])) <= 0) return false;
  }
  if (trial_)
    for (const Index f : ring_) edit(f);
  set_point(vertex, p);
  return true;
}

void Delaunay::legalize_around(Index vertex) {
  star(vertex, ring_);
  for (const Index f : ring_)
    for (int k = 0; k < 3; ++k) pending_.push_back({f, k});
  flip_pending();
}

void Delaunay::legalize() {
  for (std::size_t f = faces_.size(); f-- > 0;)
    if (faces_[f].alive())
      for (int k = 0; k < 3; ++k)
        if (faces_[f].neighbour[static_cast<std::size_t>(k)] > static_cast<Index>(f))
          pending_.push_back({static_cast<Index>(f), k});
  flip_pending();
}

void Delaunay::flip_pending() {
  while (!pending_.empty()) {
    const auto [f, slot] = pending_.back();
    pending_.pop_back();
    const std::size_t k = static_cast<std::size_t>(slot);
    const Face& current = face(f);
    const Index g = current.neighbour[k];
    if (g == none) continue;
    const Face& beyond = face(g);
    const Index opposite = beyond.corner[slot_of(beyond.neighbour, f)];
    // Strictly inside: four points on one circle keep the diagonal they have, so the loop ends.
    if (incircle(point(current.corner[0]), point(current.corner[1]), point(current.corner[2]), point(opposite)) <= 0)
      continue;
    flip(f, slot);
    for (const int side : {0, 2}) pending_.push_back({f, side});
    for (const int side : {0, 1}) pending_.push_back({g, side});
  }
}

// Faces f = (p, a, b) and g = (q, b, a) become f = (p, a, q) and g = (p, q, b).
void Delaunay::flip(Index f, int slot) {
  const std::size_t k = static_cast<std::size_t>(slot);
  const Face first = face(f);
  const Index g = first.neighbour[k];
  const Face second = face(g);
  const std::size_t j = slot_of(second.neighbour, f);
  const Index p = first.corner[k], a = first.corner[next(k)], b = first.corner[previous(k)], q = second.corner[j];
  const Index n_bp = first.neighbour[next(k)], n_pa = first.neighbour[previous(k)];
  const Index n_aq = second.neighbour[next(j)], n_qb = second.neighbour[previous(j)];
  write(f, {p, a, q}, {n_aq, g, n_pa});
  write(g, {p, q, b}, {n_qb, n_bp, f});
  relink(n_aq, g, f);
  relink(n_bp, f, g);
}

void Delaunay::write(Index f, const Triangle& corner, const Triangle& neighbour) {
  edit(f) = {corner, neighbour};
  for (const Index v : corner) set_face_of(v, f);
}

void Delaunay::relink(Index f, Index from, Index to) {
  if (f == none) return;
  Face& target = edit(f);
  target.neighbour[slot_of(target.neighbour, from)] = to;
}

Index Delaunay::add_face() {
  faces_.emplace_back();
  face_stamp_.push_back(stamp_);  // a new face has no state before the trial
  return static_cast<Index>(faces_.size() - 1);
}

Index Delaunay::add_vertex(const GridPoint& p) {
  points_.push_back(p);
  face_of_.push_back(none);
  return static_cast<Index>(points_.size() - 1);
}

Delaunay::Face& Delaunay::edit(Index f) {
  Face& target = faces_[at(f)];
  if (trial_ && face_stamp_[at(f)] != stamp_) {
    face_stamp_[at(f)] = stamp_;
    changed_.push_back({f, target, target.alive() ? corners(target) : std::array<GridPoint, 3>{}});
  }
  return target;
}

void Delaunay::remember_vertex(Index vertex) {
  if (trial_ && vertex < first_new_vertex_) changed_vertices_.push_back({vertex, point(vertex), face_of(vertex)});
}

void Delaunay::set_face_of(Index vertex, Index f) {
  if (face_of_[at(vertex)] == f) return;
  remember_vertex(vertex);
  face_of_[at(vertex)] = f;
}

void Delaunay::set_point(Index vertex, const GridPoint& p) {
  remember_vertex(vertex);
  points_[at(vertex)] = p;
}

void Delaunay::begin() {
  TOILE_ASSERT(!trial_);
  trial_ = true;
  ++stamp_;
  changed_.clear();
  changed_vertices_.clear();
  first_new_face_ = static_cast<Index>(faces_.size());
  first_new_vertex_ = static_cast<Index>(points_.size());
}

void Delaunay::commit() { trial_ = false; }

void Delaunay::roll_back() {
  TOILE_ASSERT(trial_);
  trial_ = false;
  faces_.resize(at(first_new_face_));
  face_stamp_.resize(at(first_new_face_));
  points_.resize(at(first_new_vertex_));
  face_of_.resize(at(first_new_vertex_));
  for (const Changed& changed : changed_) faces_[at(changed.face)] = changed.before;
  for (std::size_t i = changed_vertices_.size(); i-- > 0;) {
    points_[at(changed_vertices_[i].vertex)] = changed_vertices_[i].point;
    face_of_[at(changed_vertices_[i].vertex)] = changed_vertices_[i].face;
  }
}

}  // namespace toile::internal
