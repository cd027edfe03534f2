// dress/untangle.cpp: see the header.  `Untangler` holds the data common to all trials; untangle() decides which states
// are kept.
#include "dress/untangle.hpp"

#include "contact/crossing_finder.hpp"
#include "core/parallel.hpp"
#include "dress/contour_push.hpp"
#include "dress/model_as_it_is.hpp"
#include "mesh/check.hpp"
#include "step/implicit_euler.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace toile::internal {
namespace {

constexpr double edge_m = 0.01;  // mean edge of the cloth as it is scaled here, about
constexpr double step_s = 1.0 / 30;
constexpr double push_m = 0.6 * edge_m;  // out of the body, per trial
constexpr double push_N_per_m = 150;     // a twentieth of a thread's stiffness: pulls along, tears nothing
constexpr double body_N_per_m = 1000;
constexpr double gap_m = 0.2 * edge_m;   // to the body
constexpr double reach_m = 60 * edge_m;  // how deep in the body a particle may be
constexpr int unguarded_rings = 2;
constexpr int ways = 3;         // to push a contour
constexpr int eased_rings = 4;  // around contours that no way removes, doubled every time
constexpr double eased_bend_N_m = 1e-3;
constexpr int most_undone = 8;      // rounds of undoing contours that a trial made
constexpr double progress = 0.995;  // a trial that leaves less than this share of the least so far
constexpr double most_work = 7e5;   // particles times trials: about 7 s on two cores
constexpr int most_settling = 30, most_halved = 3;
constexpr double thin = 0.1, thicker = 1.3;  // share of the thickness once nothing crosses, and its growth per step
constexpr double settled_m = 0.05 * edge_m;

Fabric fabric() {
  Fabric f;
  f.stretch_u_N_per_m = f.stretch_v_N_per_m = 3000;
  f.shear_N_per_m = 1000;
  f.compression_ratio = 0.5;
  f.bend_u_N_m = f.bend_v_N_m = 1e-4;
  f.bend_friction_N = 0;
  f.thickness_m = 0.15 * edge_m;
  f.friction = 0;
  return f;
}

// The crossings and contours of one state.
struct Look {
  std::vector<SurfaceCrossing> crossings;
  std::vector<IntersectionContour> contours;
  std::size_t cloth = 0;  // the first so many crossings are of cloth with cloth
  std::size_t count() const { return crossings.size(); }
};

class Untangler {
 public:
  Untangler(std::span<const Triangle> cloth, const Vec3s& x, std::span<const Triangle> body, const Vec3s& body_x,
            std::span<const Index> held)
      : cloth_(cloth),
        body_(body),
        body_x_(body_x),
        particles_(x.size()),
        all_(joined_triangles(cloth, x.size(), body)),
        all_x_(x.size() + body_x.size()),
        topology_(build_topology(static_cast<Index>(all_x_.size()), all_)),
        model_(model_as_it_is(cloth, x, fabric())),
        finder_(topology_, all_, cloth.size(), x.size()),
        push_(topology_, all_, start_of(x)),
        eased_(model_.bend.size(), 0) {
    if (!body.empty()) surface_.emplace(body_x, std::vector<Triangle>(body.begin(), body.end()));
    for (const Index i : held) world_.pins.emplace_back().particle = i;
    world_.springs = [this](const ClothState&, double, double, std::vector<LinearSpring>& springs) {
      springs.insert(springs.end(), springs_.begin(), springs_.end());
    };
    begin();
  }
  Untangler(const Untangler&) = delete;  // its members point at each other, and the world's springs at this object
  Untangler& operator=(const Untangler&) = delete;

  // Leaves all_x_ at x.
  Look look(const Vec3s& x) {
    set_positions(x);
    FoundCrossings found = finder_.find(all_x_);
    Look look;
    look.cloth = found.of_cloth;
    look.contours = trace_contours(topology_, all_, found.all);
    look.crossings = std::move(found.all);
    return look;
  }

  // One trial from x.  `way` 0: as the cheapest sweep says; 1: and shorter; 2: the other sweep.  Returns how much is left to
  // do, m^2, before the trial.
  double trial(const Vec3s& x, const Look& seen, int way, Vec3s& end) {
    set_positions(x);
    springs_.clear();
    unguarded_.assign(all_x_.size(), 0);
    double left = 0;
    for (const IntersectionContour& contour : seen.contours) left += push(contour, seen, way);
    left += push_out(x);
    push_.regions().grow(unguarded_, unguarded_rings);

    step(x, 1, end);
    undo_new(x, end);
    return left;
  }

  // One step from a state without crossings: threads and layers find back to their distances.
  void settle(const Vec3s& x, double thickness, Vec3s& end) {
    set_positions(x);
    springs_.clear();
    unguarded_.assign(all_x_.size(), 0);
    push_out(x);
    step(x, thickness, end);
  }

 private:
  // The integrator takes the stiffness of the bends with it.
  void begin() {
    StepOptions options;
    options.pcg.tolerance = 1e-2;
    options.relinearisations = 0;  // stretch does not matter in a trial
    options.flypaper = false;
    options.max_passes = 3;
    step_.emplace(model_, world_, options);
  }

  void step(const Vec3s& x, double thickness, Vec3s& end) {
    std::vector<double> scale(particles_, thickness);
    for (std::size_t i = 0; i < particles_; ++i)
      if (unguarded_[i]) scale[i] = 0;
    step_->contact_rows().set_thickness_scale(scale);
    const ClothState state{x, Vec3s(particles_, Vec3::Zero())};
    step_->prepare(state, 0, step_s, step_s);
    StepLimits limits;
    limits.stretch = std::numeric_limits<double>::infinity();
    limits.truncate = true;
    const StepReport report = step_->attempt(state, 0, step_s, limits, candidate_);
    end = report ? candidate_.x : x;
    if (report) step_->accept(candidate_, step_s);
  }

 public:
  // Rest angles around contours become flat.  Cloth that was modelled folded into itself would otherwise fold
  // back.
  void ease(const Look& seen, int rings) {
    std::vector<char> flat(all_x_.size(), 0);
    for (const SurfaceCrossing& crossing : seen.crossings) mark_particles(crossing, all_, flat);
    push_.regions().grow(flat, rings);
    const double stiffer = eased_bend_N_m / fabric().bend_u_N_m;
    for (std::size_t h = 0; h < model_.bend.size(); ++h) {
      const auto& particle = model_.topology.hinges[h].particle;
      if (eased_[h] || !flat[at(particle[0])] || !flat[at(particle[1])]) continue;
      eased_[h] = 1;
      BendRest& rest = model_.bend[h];
      rest.theta_0 = 0;
      rest.kappa_N_m += (stiffer - 1) * (rest.kappa_N_m + rest.plate_N_m);
    }
    begin();
  }

  int inside(const Vec3s& x) const {
    int count = 0;
    if (surface_)
      for (const Vec3& p : x) {
        const BodyPoint near = surface_->nearest(p, reach_m);
        count += near.triangle >= 0 && near.gap_m < 0 ? 1 : 0;
      }
    return count;
  }

  std::vector<Tangle> tangles(const Look& seen) {
    std::vector<Tangle> tangles;
    for (const IntersectionContour& contour : seen.contours) {
      Tangle tangle;
      tangle.closed = contour.closed;
      tangle.length = contour_length(contour, seen.crossings, all_x_);
      for (const ContourPoint& point : contour.points) {
        const SurfaceCrossing& crossing = seen.crossings[at(point.crossing)];
        tangle.position += crossing.position / static_cast<double>(contour.points.size());
        for (const Index t : topology_.edges[at(find_edge(topology_, crossing.edge))].triangle) {
          if (t < 0) continue;
          std::array<Index, 2> pair{std::min(t, crossing.triangle), std::max(t, crossing.triangle)};
          if (of_body_triangle(pair[1])) {
            tangle.with_body = true;
            pair[1] -= static_cast<Index>(cloth_.size());
          }
          tangle.triangles.push_back(pair);
        }
      }
      std::sort(tangle.triangles.begin(), tangle.triangles.end());
      tangle.triangles.erase(std::unique(tangle.triangles.begin(), tangle.triangles.end()), tangle.triangles.end());
      tangles.push_back(std::move(tangle));
    }
    return tangles;
  }

  void set_positions(const Vec3s& x) { std::copy(x.begin(), x.end(), all_x_.begin()); }

 private:
  bool of_body(Index particle) const { return at(particle) >= particles_; }
  bool of_body_triangle(Index triangle) const { return at(triangle) >= cloth_.size(); }

  // Fills all_x_.
  std::span<const Vec3> start_of(const Vec3s& x) {
    std::copy(body_x_.begin(), body_x_.end(), all_x_.begin() + static_cast<std::ptrdiff_t>(particles_));
    set_positions(x);
    return all_x_;
  }

  bool with_body(const IntersectionContour& contour, const Look& seen) const {
    const SurfaceCrossing& first = seen.crossings[at(contour.points.front().crossing)];
    return of_body(first.edge[0]) || of_body_triangle(first.triangle);
  }

  // Moves the point by `move`, by springs along it; points of the body get none.
  void pull(const ContourPull& pull, const Vec3& move_m, double stiffness_N_per_m = push_N_per_m) {
    const double length = move_m.norm();
    if (length <= 0 || of_body(pull.particle[0])) return;
    LinearSpring spring = spring_along(pull, move_m);
    spring.stiffness_N_per_m = stiffness_N_per_m;
    spring.force_N = stiffness_N_per_m * length;
    springs_.push_back(spring);
  }

  double push(const IntersectionContour& contour, const Look& seen, int way) {
    for (const ContourPoint& point : contour.points)
      mark_particles(seen.crossings[at(point.crossing)], all_, unguarded_);
    if (with_body(contour, seen)) {
      leave_body(contour, seen);
      return contour_length(contour, seen.crossings, all_x_) * edge_m;
    }
    return push_(contour, seen.crossings, all_x_, static_cast<ContourPush::Way>(way), edge_m, 1, unguarded_,
                 [&](const ContourPull& point, const Vec3& move_m) { pull(point, move_m); });
  }

  // Outwards: the cloth along the body's normal.
  void leave_body(const IntersectionContour& contour, const Look& seen) {
    for (const ContourPoint& point : contour.points) {
      const SurfaceCrossing& crossing = seen.crossings[at(point.crossing)];
      const bool edge_of_body = of_body(crossing.edge[0]);
      Vec3 normal = Vec3::Zero();
      ContourPull cloth;
      if (edge_of_body) {
        const auto n = static_cast<Index>(particles_);
        const Index e = find_edge(surface_->topology(), {crossing.edge[0] - n, crossing.edge[1] - n});
        normal = surface_->edge_normal(e);
        cloth.particle = all_[at(crossing.triangle)];
        cloth.weight = {1.0 / 3, 1.0 / 3, 1.0 / 3};
      } else {
        normal = surface_->face_normal(crossing.triangle - static_cast<Index>(cloth_.size()));
        cloth.particle = {crossing.edge[0], crossing.edge[1], -1};
        cloth.weight = {0.5, 0.5, 0};
      }
      pull(cloth, push_m * normal);
    }
  }

  // Moves cloth inside the body to its surface, and cloth too near a little away.  Returns area times depth / edge.
  double push_out(const Vec3s& x) {
    if (!surface_) return 0;
    near_.resize(x.size());
    parallel_for(x.size(), 64, [&](std::size_t i) { near_[i] = surface_->nearest(x[i], reach_m); });
    double left = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (near_[i].triangle < 0 || near_[i].gap_m > gap_m) continue;
      const double depth = gap_m - near_[i].gap_m;
      pull({{static_cast<Index>(i), -1, -1}, {1, 0, 0}, Vec3::Zero(), 0}, std::min(depth, 2 * push_m) * near_[i].normal,
           near_[i].gap_m < 0 ? push_N_per_m : body_N_per_m);
      if (near_[i].gap_m < 0) left -= near_[i].gap_m * edge_m;
    }
    return left;
  }

  // New contours of cloth with cloth, unrelated to those at x (the body pushes by itself): their particles go back half of the way, until there is none.
  void undo_new(const Vec3s& x, Vec3s& end) {
    for (int round = 0; round <= most_undone; ++round) {
      const Look made = look(end);
      std::vector<char> back(all_x_.size(), 0);
      bool any = false;
      for (const IntersectionContour& contour : made.contours) {
        const auto known = [&](const ContourPoint& point) {
          const SurfaceCrossing& c = made.crossings[at(point.crossing)];
          const auto is = [&](Index i) { return !of_body(i) && unguarded_[at(i)]; };
          const Triangle& t = all_[at(c.triangle)];
          return std::any_of(c.edge.begin(), c.edge.end(), is) && std::any_of(t.begin(), t.end(), is);
        };
        if (with_body(contour, made) || std::any_of(contour.points.begin(), contour.points.end(), known)) continue;
        any = true;
        for (const ContourPoint& point : contour.points) mark_particles(made.crossings[at(point.crossing)], all_, back);
      }
      if (!any) return;
      if (round == most_undone) {
        end = x;
        return;
      }
      if (round > 0) push_.regions().grow(back, round - 1);
      const double share = round + 1 == most_undone ? 0 : 0.5;
      for (std::size_t i = 0; i < particles_; ++i)
        if (back[i]) end[i] = x[i] + share * (end[i] - x[i]);
    }
  }

  std::span<const Triangle> cloth_, body_;
  const Vec3s& body_x_;
  std::size_t particles_;
  std::vector<Triangle> all_;
  Vec3s all_x_;
  Topology topology_;
  ClothModel model_;
  CrossingFinder finder_;
  ContourPush push_;
  std::vector<char> eased_;  // [hinge]
  std::optional<BodySurface> surface_;
  StepWorld world_;
  std::optional<ImplicitEuler> step_;
  std::vector<LinearSpring> springs_;
  std::vector<char> unguarded_;
  std::vector<BodyPoint> near_;
  ClothState candidate_;
};

double unit_of(std::span<const Triangle> triangles, std::span<const Vec3> x) {
  double sum = 0;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) sum += (x[at(t[(k + 1) % 3])] - x[at(t[k])]).norm();
  const double mean = sum / (3 * static_cast<double>(triangles.size()));
  return std::ldexp(1.0, -std::ilogb(1.4142135623730951 * mean / edge_m));
}

}  // namespace

UntangleReport untangle(std::span<const Triangle> cloth, Vec3s& x, std::span<const Triangle> body,
                        std::span<const Vec3> body_x, const UntangleOptions& options,
                        const std::function<bool(int, int)>& keep_going) {
  check_triangles("", x, cloth);
  const double scale = unit_of(cloth, x);
  Vec3s at_x = x, scaled_body(body_x.begin(), body_x.end());
  for (Vec3& p : at_x) p *= scale;
  for (Vec3& p : scaled_body) p *= scale;
  const Vec3s start = at_x;
  Untangler untangler(cloth, at_x, body, scaled_body, options.held);

  UntangleReport report;
  Look seen = untangler.look(at_x);
  report.before = untangler.tangles(seen);
  report.cloth_crossings_before = static_cast<int>(seen.cloth);
  report.body_crossings_before = static_cast<int>(seen.count() - seen.cloth);
  Vec3s best = at_x, end;
  std::size_t best_count = seen.count();
  double least = std::numeric_limits<double>::infinity();
  int way = 0, waited = 0, eased = 0, in_vain = 0;
  const int most = options.most_iterations > 0
                       ? options.most_iterations
                       : static_cast<int>(std::clamp(most_work / static_cast<double>(x.size()), 100.0, 600.0));
  while (best_count > 0 && report.iterations < most) {
    if (options.most_in_vain > 0 && in_vain >= options.most_in_vain) break;
    if (keep_going && !keep_going(report.iterations, static_cast<int>(best_count))) break;
    ++report.iterations;
    const double left = untangler.trial(at_x, seen, way, end);
    at_x.swap(end);
    seen = untangler.look(at_x);
    ++in_vain;
    if (seen.count() < best_count) {
      best = at_x;
      best_count = seen.count();
      in_vain = 0;
    }
    ++waited;
    if (left < progress * least) {
      least = left;
      waited = 0;
    }
    if (waited >= options.patience) {
      way = (way + 1) % ways;
      if (way == 0) untangler.ease(untangler.look(best), eased_rings << std::min(eased++, 8));
      waited = 0;
      least = std::numeric_limits<double>::infinity();
      at_x = best;
      seen = untangler.look(at_x);
    }
  }

  double thickness = thin;
  for (int k = 0;
       best_count == 0 && report.cloth_crossings_before + report.body_crossings_before > 0 && k < most_settling; ++k) {
    untangler.settle(best, thickness, end);
    for (int halved = 0; halved < most_halved && untangler.look(end).count() > 0; ++halved)
      for (std::size_t i = 0; i < end.size(); ++i) end[i] = (end[i] + best[i]) / 2;
    if (untangler.look(end).count() > 0) break;
    double moved = 0;
    for (std::size_t i = 0; i < end.size(); ++i) moved = std::max(moved, (end[i] - best[i]).norm());
    best.swap(end);
    if (thickness == 1 && moved < settled_m) break;
    thickness = std::min(1.0, thicker * thickness);
  }

  seen = untangler.look(best);
  report.left = untangler.tangles(seen);
  report.cloth_crossings = static_cast<int>(seen.cloth);
  report.body_crossings = static_cast<int>(seen.count() - seen.cloth);
  report.resolved = seen.count() == 0;
  report.inside = untangler.inside(best);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double move = (best[i] - start[i]).norm() / scale;
    report.largest_move = std::max(report.largest_move, move);
    report.mean_move += move / static_cast<double>(x.size());
    x[i] = best[i] / scale;
  }
  std::vector<double> changes;
  for (const Triangle& t : cloth)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = at(t[k]), b = at(t[(k + 1) % 3]);
      changes.push_back(std::abs((best[b] - best[a]).norm() / (start[b] - start[a]).norm() - 1));
    }
  std::sort(changes.begin(), changes.end());
  report.edge_change_p99 = changes[(changes.size() - 1) * 99 / 100];
  report.edge_change_max = changes.back();
  for (std::vector<Tangle>* tangles : {&report.before, &report.left})
    for (Tangle& tangle : *tangles) {
      tangle.length /= scale;
      tangle.position /= scale;
    }
  return report;
}

}  // namespace toile::internal
