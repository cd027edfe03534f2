#include "contact/body_impacts.hpp"

#include "contact/ccd.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

using Mover = BodyImpactWorkspace::Mover;

constexpr std::size_t mover_grain = 512;

template <class Triangles>
void move_triangles(const Triangles& triangles, std::span<const Vec3> start, std::span<const Vec3> end,
                    std::vector<Mover>& movers) {
  movers.resize(triangles.size());
  parallel_for(triangles.size(), mover_grain, [&](std::size_t t) {
    Mover& mover = movers[t];
    mover.centre = mover.displacement = Vec3::Zero();
    for (const Index i : triangles[t]) {
      mover.centre += start[at(i)] / 3;
      mover.displacement += (end[at(i)] - start[at(i)]) / 3;
    }
    double radius2 = 0, differ2 = 0;
    for (const Index i : triangles[t]) {
      radius2 = std::max(radius2, (start[at(i)] - mover.centre).squaredNorm());
      differ2 = std::max(differ2, (end[at(i)] - start[at(i)] - mover.displacement).squaredNorm());
    }
    const Vec3& a = start[at(triangles[t][0])];
    const Vec3 n = (start[at(triangles[t][1])] - a).cross(start[at(triangles[t][2])] - a);
    const double length = n.norm();
    mover.normal = length > 0 ? Vec3(n / length) : Vec3::Zero();
    mover.radius = std::sqrt(radius2);
    mover.differ = std::sqrt(differ2);
  });
}

// The corners of a triangle, before and after the motion.
struct Corners {
  std::array<Vec3, 3> start, end;
};

Corners corners_of(const Triangle& t, std::span<const Vec3> start, std::span<const Vec3> end) {
  return {{start[at(t[0])], start[at(t[1])], start[at(t[2])]}, {end[at(t[0])], end[at(t[1])], end[at(t[2])]}};
}

// By how much all of a lies beyond all of b along n, before and after: the less of both.
double lead(const Vec3& n, const Corners& a, const Corners& b) {
  const auto at_one_time = [&](const std::array<Vec3, 3>& p, const std::array<Vec3, 3>& q) {
    const Vec3& o = q[0];
    return std::min({n.dot(p[0] - o), n.dot(p[1] - o), n.dot(p[2] - o)}) -
           std::max({0.0, n.dot(q[1] - o), n.dot(q[2] - o)});
  };
  const double start = at_one_time(a.start, b.start);
  return start > 0 ? std::min(start, at_one_time(a.end, b.end)) : start;
}

class BodyImpactQuery {
 public:
  BodyImpactQuery(const ClothTopology& cloth, const TriangleTree& tree, std::span<const Vec3> start,
                  std::span<const Vec3> end, const BodyGuard& guard, const BodyImpactWorkspace& workspace)
      : cloth_(cloth),
        tree_(tree),
        body_(*guard.body),
        guard_(guard),
        workspace_(workspace),
        start_(start),
        end_(end),
        separation_m_(separation_share * guard.contact_m),
        clear_m_(clear_share * separation_m_),
        most_(most_impacts(start.size())) {}

  void walk(TreeTask task, std::vector<Impact>& found) const {
    tree_.visit_cross(body_.tree(), task, [&](Index a, Index b) {
      if (found.size() > most_) return;
      const Mover &p = workspace_.cloth[at(a)], &q = workspace_.body[at(b)];
      const double moving = (p.displacement - q.displacement).norm() + p.differ + q.differ + separation_m_,
                   reach = p.radius + q.radius + moving;
      if ((p.centre - q.centre).squaredNorm() > reach * reach) return;
      const Triangle &of_cloth = cloth_.triangle(a), &of_body = body_.triangle(b);
      if (stay_apart(p, q, corners_of(of_cloth, start_, end_),
                     corners_of(of_body, body_.positions(), body_.next_positions())))
        return;
      const unsigned owned_a = cloth_.owned(a), owned_b = body_.owned(b);
      const Index n = static_cast<Index>(start_.size());
      for_lanes(owned_a & 7u, [&](std::size_t k) {
        decide(ContactKind::vertex_face, {of_cloth[k], n + of_body[0], n + of_body[1], n + of_body[2]}, 1, found);
      });
      for_lanes(owned_b & 7u, [&](std::size_t k) {
        decide(ContactKind::vertex_face, {n + of_body[k], of_cloth[0], of_cloth[1], of_cloth[2]}, 1, found);
      });
      for_lanes(owned_a >> 3, [&](std::size_t k) {
        const Edge& e = cloth_.edge(cloth_.triangle_edges(a)[k]);
        for_lanes(owned_b >> 3, [&](std::size_t l) {
          const Edge& f = body_.topology().edges[at(body_.topology().triangle_edges[at(b)][l])];
          decide(ContactKind::edge_edge, {e.a, e.b, n + f.a, n + f.b}, 2, found);
        });
      });
    });
  }

 private:
  // Along one of three directions, for all of the motion.
  bool stay_apart(const Mover& p, const Mover& q, const Corners& a, const Corners& b) const {
    const Vec3 between = p.centre - q.centre;
    for (const Vec3& n : {q.normal, p.normal, Vec3(between.stableNormalized())})
      if (lead(n.dot(between) < 0 ? Vec3(-n) : n, a, b) > clear_m_) return true;
    return false;
  }

  // `first`: the number of particles of the first feature.
  void decide(ContactKind kind, const std::array<Index, 4>& particle, std::size_t first,
              std::vector<Impact>& found) const {
    const Index n = static_cast<Index>(start_.size());
    std::array<Vec3, 4> x, u;
    for (std::size_t k = 0; k < 4; ++k) {
      const Index i = particle[k];
      if (i < n) {
        if (guard_.exempt[at(i)]) return;
        x[k] = start_[at(i)];
        u[k] = end_[at(i)] - x[k];
      } else {
        x[k] = body_.positions()[at(i - n)];
        u[k] = body_.vertex_travel(i - n);
      }
    }
    // Between the two centres, as for the triangles.
    Vec3 between = Vec3::Zero(), relative = Vec3::Zero();
    const std::array<double, 2> share{1.0 / static_cast<double>(first), -1.0 / static_cast<double>(4 - first)};
    for (std::size_t k = 0; k < 4; ++k) {
      between += share[k < first ? 0 : 1] * x[k];
      relative += share[k < first ? 0 : 1] * u[k];
    }
    double reach = separation_m_ + relative.norm();
    for (const auto& [begin, stop] : {std::pair<std::size_t, std::size_t>{0, first}, {first, 4}}) {
      Vec3 centre = Vec3::Zero(), mean = Vec3::Zero();
      for (std::size_t k = begin; k < stop; ++k) {
        centre += x[k] / static_cast<double>(stop - begin);
        mean += u[k] / static_cast<double>(stop - begin);
      }
      double radius2 = 0, differ2 = 0;
      for (std::size_t k = begin; k < stop; ++k) {
        radius2 = std::max(radius2, (x[k] - centre).squaredNorm());
        differ2 = std::max(differ2, (u[k] - mean).squaredNorm());
      }
      reach += std::sqrt(radius2) + std::sqrt(differ2);
    }
    if (between.squaredNorm() > reach * reach) return;
    Impact impact{kind, particle, {}, Vec3::Zero(), no_impact, 0, guard_.contact_m, 0};
    if (decide_impact(x, u, impact)) found.push_back(impact);
  }

  const ClothTopology& cloth_;
  const TriangleTree& tree_;
  const BodySurface& body_;
  const BodyGuard& guard_;
  const BodyImpactWorkspace& workspace_;
  std::span<const Vec3> start_, end_;
  double separation_m_, clear_m_;
  std::size_t most_;  // per task the same as in all: distant solids change the body's division into tasks
};

// Does the segment pq pass through the triangle?
bool passes_through(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto volume = [](const Vec3& u, const Vec3& v, const Vec3& w) { return u.cross(v).dot(w); };
  const Vec3 n = (b - a).cross(c - a);
  if ((n.dot(p - a) > 0) == (n.dot(q - a) > 0)) return false;
  const Vec3 d = q - p;
  const bool ab = volume(d, a - p, b - p) > 0, bc = volume(d, b - p, c - p) > 0, ca = volume(d, c - p, a - p) > 0;
  return ab == bc && bc == ca;
}

}  // namespace

bool find_body_impacts(const ClothTopology& cloth, TriangleTree& tree, std::span<const Vec3> start,
                       std::span<const Vec3> end, const BodyGuard& guard, BodyImpactWorkspace& workspace,
                       std::vector<Impact>& impacts) {
  TOILE_ASSERT(start.size() == cloth.particle_count() && end.size() == start.size() &&
               guard.exempt.size() == start.size());
  impacts.clear();
  if (start.empty() || guard.body->triangles().empty()) return true;
  tree.refit(start, end, separation_share * guard.contact_m);
  move_triangles(cloth.triangles(), start, end, workspace.cloth);
  move_triangles(guard.body->triangles(), guard.body->positions(), guard.body->next_positions(), workspace.body);
  tree.cross_tasks(guard.body->tree(), workspace.tasks);
  if (workspace.found.size() < workspace.tasks.size()) workspace.found.resize(workspace.tasks.size());
  const BodyImpactQuery query(cloth, tree, start, end, guard, workspace);
  parallel_for(workspace.tasks.size(), 1, [&](std::size_t i) {
    workspace.found[i].clear();
    query.walk(workspace.tasks[i], workspace.found[i]);
  });
  return gather_impacts(std::span(workspace.found).first(workspace.tasks.size()), start.size(),
                        most_impacts(start.size()), impacts);
}

bool mark_through_body(const ClothTopology& cloth, TriangleTree& tree, std::span<const Vec3> x, const BodySurface& body,
                       BodyImpactWorkspace& workspace, std::vector<char>& through) {
  through.assign(x.size(), 0);
  if (x.empty() || body.triangles().empty()) return false;
  tree.refit(x, x, 0);
  tree.cross_tasks(body.tree_now(), workspace.tasks);
  if (workspace.through.size() < workspace.tasks.size()) workspace.through.resize(workspace.tasks.size());
  parallel_for(workspace.tasks.size(), 1, [&](std::size_t i) {
    std::vector<Index>& found = workspace.through[i];
    found.clear();
    tree.visit_cross(body.tree_now(), workspace.tasks[i], [&](Index a, Index b) {
      const auto corners = [](const Triangle& t, std::span<const Vec3> of) {
        return std::array<Vec3, 3>{of[at(t[0])], of[at(t[1])], of[at(t[2])]};
      };
      const std::array<Vec3, 3> p = corners(cloth.triangle(a), x), q = corners(body.triangle(b), body.positions());
      for (std::size_t k = 0; k < 3; ++k) {
        if (!passes_through(p[k], p[(k + 1) % 3], q[0], q[1], q[2]) &&
            !passes_through(q[k], q[(k + 1) % 3], p[0], p[1], p[2]))
          continue;
        found.push_back(a);
        return;
      }
    });
  });
  bool any = false;
  for (std::size_t i = 0; i < workspace.tasks.size(); ++i) {
    for (const Index t : workspace.through[i]) {
      any = true;
      for (const Index corner : cloth.triangle(t)) through[at(corner)] = 1;
    }
  }
  return any;
}

}  // namespace toile::internal
