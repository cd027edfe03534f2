#include "dress/sewing.hpp"

#include "core/disjoint_sets.hpp"
#include "step/tangents.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

// kg/m^2, that of silk: lighter cloth, which a seam's pull and the drag of sewing drive as they do any other, flies past thumbs.
constexpr double least_sewn_density = 0.07;
constexpr int most_escalations = 3;  // thin layers, then two doublings of the pull
constexpr int lets_through = 2;      // from this escalation on folds caught in seams may pass through
constexpr double thinning_per_frame = 0.95;
constexpr double least_thickness = 0.1, thickness_growth = 1.1;  // per frame of the drape
constexpr double coincident_m = 1e-7;  // below it a pair has no reliable direction: its spring is isotropic

// [particle] mass-weighted mean over the class that `merged` names, at the class's own particle.
std::vector<Vec3> class_means(std::span<const Index> merged, std::span<const double> mass_kg, std::span<const Vec3> a) {
  std::vector<Vec3> sum(a.size(), Vec3::Zero());
  std::vector<double> mass(a.size(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum[at(merged[i])] += mass_kg[i] * a[i];
    mass[at(merged[i])] += mass_kg[i];
  }
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (mass[i] > 0) sum[i] /= mass[i];
  }
  return sum;
}

// Panels that are gathered have to fold while they are sewn.
void soften_gathered_panels(ClothModel& model, std::span<const Fabric> fabrics, std::span<const Fabric> stiff,
                            const ModelOptions& options, double share) {
  const ClothMesh& mesh = model.mesh;
  if (mesh.gathered_uv.empty()) return;
  std::vector<char> gathered(mesh.panel_names.size(), 0);
  for (std::size_t t = 0; t < mesh.uv.size(); ++t)
    if (mesh.gathered_uv[t] != mesh.uv[t]) gathered[at(mesh.panel[t])] = 1;
  std::vector<Fabric> softer(stiff.begin(), stiff.end());
  for (std::size_t k = 0; k < softer.size(); ++k) {
    softer[k].bend_u_N_m = std::max(fabrics[k].bend_u_N_m, share * stiff[k].bend_u_N_m);
    softer[k].bend_v_N_m = std::max(fabrics[k].bend_v_N_m, share * stiff[k].bend_v_N_m);
    softer[k].bend_uv_N_m = std::max(fabrics[k].bend_uv_N_m, share * stiff[k].bend_uv_N_m);
  }
  const ClothModel soft = build_model(mesh, softer, options);
  for (std::size_t h = 0; h < soft.bend.size(); ++h) {
    const std::array<Index, 2>& sides = model.topology.hinges[h].triangle;
    if (gathered[at(mesh.panel[at(sides[0])])] || gathered[at(mesh.panel[at(sides[1])])]) model.bend[h] = soft.bend[h];
  }
  for (std::size_t t = 0; t < soft.plate_compliance.size(); ++t)
    if (gathered[at(mesh.panel[t])]) model.plate_compliance[t] = soft.plate_compliance[t];
  if (!model.plate_compliance.empty()) set_plate_bounds(model);
}

}  // namespace

Sewing::Sewing(const GarmentMesh& garment, std::span<const Fabric> fabrics, BodySurface* body, const StepOptions& step,
               const SewingOptions& options)
    : garment_(&garment), options_(options), labels_(garment, options.label_heights) {
  if (options.keeps_bodice) kept_ = LabelSprings::of_bodice(garment);
  ModelOptions weightless;
  weightless.gravity_m_per_s2.setZero();
  weightless.drag_per_s = options.drag_per_s;
  weightless.bend_element = options.bend_element;
  weightless.paper_scaling = options.paper_scaling;
  weightless.damping_jacobian = options.damping_jacobian;
  std::vector<Fabric> stiff(fabrics.begin(), fabrics.end());
  for (Fabric& fabric : stiff) {
    fabric.bend_u_N_m = std::max(fabric.bend_u_N_m, options.bend_N_m);
    fabric.bend_v_N_m = std::max(fabric.bend_v_N_m, options.bend_N_m);
    if (fabric.bend_uv_N_m > 0)
      fabric.bend_uv_N_m = std::max(fabric.bend_uv_N_m, 0.5 * (1 - fabric.bend_poisson) * options.bend_N_m);
    // Closing seams pull harder than worn cloth may be pulled.
    fabric.strain_limit = fabric.doubling_strain_u = fabric.doubling_strain_v = 0;
    fabric.bend_friction_N = fabric.bend_set = 0;  // cloth is not to remember how it was sewn
    fabric.density_kg_per_m2 = std::max(fabric.density_kg_per_m2, least_sewn_density);
  }
  ClothMesh as_cut = garment.mesh;
  as_cut.finished.clear();  // an armhole has to pass a raised arm
  model_ = build_model(std::move(as_cut), stiff, weightless);
  soften_gathered_panels(model_, fabrics, stiff, weightless, options.gathered_bend_share);
  set_folds(model_, garment.pleated ? 1 : 0);
  set_gathers(model_, 0);
  state_ = {garment.x, Vec3s(garment.x.size(), Vec3::Zero())};
  for (const SeamPair& pair : garment.pairs) {
    start_distance_m_.push_back((garment.x[at(pair.b)] - garment.x[at(pair.a)]).norm());
    longest_m_ = std::max(longest_m_, start_distance_m_.back());
  }
  best_gap_m_ = longest_m_;
  mean_edge_m_ = mesh_quality(garment.mesh).mean_edge_m;
  world_.body = body;
  world_.merged_particle = garment.merged;
  for (Index i = 0; i < options.held_particles; ++i) {
    Pin held;
    held.particle = i;
    world_.pins.push_back(std::move(held));
  }
  world_.springs = [this](const ClothState& state, double end_s, double, std::vector<LinearSpring>& springs) {
    append_springs(state, end_s, springs);
  };
  step_ = step;
  step_.rows.look_ahead = 2;
  step_.body = step.body.slippery(options.offset_m);
  start_stepper();
  set_thickness_scale(std::vector<double>(garment.x.size(), options.thickness_scale));
  if (garment.pairs.empty()) status_ = SewingStatus::closed;
}

void Sewing::start_stepper() {
  AdaptiveOptions adaptive;
  adaptive.step_max_s = std::min(1 / options_.fps, options_.step_max_s);
  adaptive.stop = options_.stop;
  adaptive.stretch_floor = 3;  // the pull of a seam is not divergence
  stepper_.emplace(model_, world_, step_, adaptive);
}

void Sewing::append_springs(const ClothState& state, double end_s, std::vector<LinearSpring>& springs) const {
  const double open = std::max(0.0, 1 - options_.closing_speed_m_per_s * end_s / longest_m_);
  if (open == 0 || options_.labels_hold_panels) labels_.append(state, 1, springs);
  if (open > 0) kept_.append(state, 1, springs);
  for (std::size_t k = 0; k < garment_->pairs.size(); ++k) {
    const SeamPair& pair = garment_->pairs[k];
    const double wanted = open * start_distance_m_[k];
    const Vec3 d = state.x[at(pair.b)] - state.x[at(pair.a)];
    const double distance = d.norm(), excess = distance - wanted;
    const double limit = pull_factor_ * options_.pull_N_per_m * pair.share_m, k_pull = limit / options_.give_m;
    LinearSpring spring;
    spring.particle = {pair.a, pair.b, -1, -1};
    spring.weight = {-1, 1, 0, 0};
    if (distance < coincident_m) {
      spring.stiffness_N_per_m = k_pull;
      spring.damping_N_s_per_m = options_.damping_s * k_pull;
      for (int axis = 0; axis < 3; ++axis) {
        spring.direction = Vec3::Unit(axis);
        springs.push_back(spring);
      }
      continue;
    }
    if (excess <= 0) continue;
    const double force = std::min(k_pull * excess, limit), secant = force / excess;
    spring.direction = d / distance;
    spring.force_N = -force;
    spring.stiffness_N_per_m = secant;
    spring.damping_N_s_per_m = options_.damping_s * secant;
    springs.push_back(spring);
    spring.force_N = spring.damping_N_s_per_m = 0;
    spring.stiffness_N_per_m = force / distance;
    for (const Vec3& t : tangents(d / distance)) {
      spring.direction = t;
      springs.push_back(spring);
    }
  }
}

void Sewing::set_thickness_scale(std::vector<double> scale) {
  thickness_scale_ = std::move(scale);
  stepper_->integrator().contact_rows().set_thickness_scale(thickness_scale_);
}

void Sewing::go_on(Vec3s x, std::vector<double> scale) {
  for (double& s : scale) s *= options_.thickness_scale;
  state_ = {std::move(x), Vec3s(scale.size(), Vec3::Zero())};
  seconds_before_ = seconds();
  start_stepper();  // its memory of contacts belongs to the old positions
  set_thickness_scale(std::move(scale));
  escalations_ = 0;
  pull_factor_ = 1;
  best_gap_m_ = widest_gap_m();
  best_time_s_ = time_s_;
  weld_obstacle_.reset();
  status_ = best_gap_m_ < options_.weld_gap_m ? SewingStatus::closed : SewingStatus::sewing;
}

FrameReport Sewing::frame() {
  FrameReport report;
  if (status_ != SewingStatus::sewing) return report;
  const double frame_s = 1 / options_.fps;
  pull_gathers();
  report = stepper_->advance(state_, time_s_, frame_s);
  if (report.interrupted) return report;
  time_s_ += frame_s;
  if (!report.ok) {  // cloth too small for the body under it collapses somewhere: the seam gives the reason
    const std::vector<SeamGap> open = gaps();
    const bool taut =
        !open.empty() && open.front().gap_m >= options_.weld_gap_m && open.front().stretch > options_.taut;
    status_ = taut ? SewingStatus::blocked : SewingStatus::failed;
    return report;
  }
  judge_progress();
  return report;
}

// The gathering thread closes with its seam.
void Sewing::pull_gathers() {
  const double share = longest_m_ > 0 ? std::min(1.0, options_.closing_speed_m_per_s * time_s_ / longest_m_) : 1;
  if (share != model_.gathered) set_gathers(model_, share);
}

void Sewing::judge_progress() {
  const double gap = widest_gap_m();
  if (gap < 0.95 * best_gap_m_) {  // still closing
    best_gap_m_ = gap;
    best_time_s_ = time_s_;
  }
  const bool reached = options_.closing_speed_m_per_s * time_s_ >= longest_m_;
  const bool stopped = reached && time_s_ - best_time_s_ >= options_.patience_s;
  const bool near = gap < options_.weld_gap_m || (stopped && gap < options_.weld_share * mean_edge_m_);
  weld_obstacle_.reset();
  if (near || escalations_ >= lets_through) {
    Vec3s closed = state_.x;
    const std::vector<Impact> caught = close_seams(closed);
    if (near && caught.empty()) {
      state_.x = std::move(closed);
      status_ = SewingStatus::closed;
      return;
    }
    if (near) weld_obstacle_ = state_.x[at(caught.front().particle[0])];
    if (escalations_ >= lets_through) let_through(caught);
  }
  if (escalations_ > 0) thin_layers();
  if (!stopped) return;
  if (escalations_ == most_escalations || gaps().front().stretch > options_.too_small) {
    status_ = SewingStatus::blocked;
    return;
  }
  if (escalations_ > 0) pull_factor_ *= 2;
  ++escalations_;
  best_gap_m_ = gap;
  best_time_s_ = time_s_;
}

// Moves every class to its place of welding, and the cloth around it aside.  Returns the impacts where cloth would pass through cloth.
std::vector<Impact> Sewing::close_seams(Vec3s& end) {
  const std::vector<Vec3> joined = class_means(garment_->merged, model_.mass_kg, state_.x);
  std::vector<double> inverse_mass(state_.x.size(), 0);
  for (std::size_t i = at(options_.held_particles); i < inverse_mass.size(); ++i)
    inverse_mass[i] = 1 / model_.mass_kg[i];
  for (const SeamPair& pair : garment_->pairs) {
    for (const Index i : {pair.a, pair.b}) {
      end[at(i)] = joined[at(garment_->merged[at(i)])];
      inverse_mass[at(i)] = 0;
    }
  }
  ContactRows& rows = stepper_->integrator().contact_rows();
  SafeFilter filter;
  filter(rows.topology(), rows.tree(), state_.x, inverse_mass, rows.contact_m(), false, end);
  return {filter.left().begin(), filter.left().end()};
}

// A fold between the two sides of a seam that has closed around it never comes out.  Its contact is switched off, and its crossings are
// untangled after the weld (dress/untangle.hpp); parts larger than a fold stay in the way.
void Sewing::let_through(std::span<const Impact> caught) {
  std::vector<char> sewn(state_.x.size(), 0), off(state_.x.size(), 0);
  for (const SeamPair& pair : garment_->pairs) sewn[at(pair.a)] = sewn[at(pair.b)] = 1;
  for (const Impact& impact : caught) {
    const bool seams_alone =
        std::all_of(impact.particle.begin(), impact.particle.end(), [&](Index i) { return sewn[at(i)] != 0; });
    for (const Index i : impact.particle) {
      if ((seams_alone || !sewn[at(i)]) && i >= options_.held_particles) off[at(i)] = 1;
    }
  }
  for (std::size_t i = 0; i < off.size(); ++i) off[i] = static_cast<char>(off[i] != 0 || thickness_scale_[i] == 0);
  DisjointSets pieces(off.size());
  for (const Triangle& t : garment_->mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k)
      if (off[at(t[k])] && off[at(t[(k + 1) % 3])]) pieces.join(t[k], t[(k + 1) % 3]);
  }
  const std::vector<Index> piece = pieces.representatives();
  std::vector<Eigen::AlignedBox3d> box(off.size());
  for (std::size_t i = 0; i < off.size(); ++i)
    if (off[i]) box[at(piece[i])].extend(state_.x[i]);
  for (std::size_t i = 0; i < off.size(); ++i)
    if (off[i] && box[at(piece[i])].diagonal().norm() < options_.largest_fold_m) thickness_scale_[i] = 0;
  stepper_->integrator().contact_rows().set_thickness_scale(thickness_scale_);
}

void Sewing::thin_layers() {
  std::vector<Vec3> open;
  for (const SeamPair& pair : garment_->pairs) {
    const Vec3 &a = state_.x[at(pair.a)], &b = state_.x[at(pair.b)];
    if ((a - b).norm() > options_.weld_gap_m) open.push_back(0.5 * (a + b));
  }
  for (std::size_t i = 0; i < thickness_scale_.size(); ++i) {
    const bool beside = std::any_of(open.begin(), open.end(),
                                    [&](const Vec3& p) { return (state_.x[i] - p).norm() < options_.thin_radius_m; });
    if (beside && thickness_scale_[i] > 0)
      thickness_scale_[i] = std::max(options_.thinnest, thinning_per_frame * thickness_scale_[i]);
  }
  stepper_->integrator().contact_rows().set_thickness_scale(thickness_scale_);
}

double Sewing::widest_gap_m() const {
  double widest = 0;
  for (const SeamPair& pair : garment_->pairs)
    widest = std::max(widest, (state_.x[at(pair.b)] - state_.x[at(pair.a)]).norm());
  return widest;
}

std::vector<Index> Sewing::open_pairs(double welded_m) const {
  std::vector<Index> open;
  for (std::size_t k = 0; k < garment_->pairs.size(); ++k) {
    const SeamPair& pair = garment_->pairs[k];
    if (!((state_.x[at(pair.b)] - state_.x[at(pair.a)]).norm() < welded_m)) open.push_back(static_cast<Index>(k));
  }
  return open;
}

double Sewing::closed_share() const {
  return longest_m_ > 0 ? std::clamp(1 - widest_gap_m() / longest_m_, 0.0, 1.0) : 1;
}

std::vector<SeamGap> Sewing::gaps() const {
  std::vector<SeamGap> gaps(garment_->seams.size());
  for (std::size_t s = 0; s < gaps.size(); ++s) gaps[s].seam = static_cast<Index>(s);
  std::vector<double> stretch(state_.x.size(), 0);
  std::vector<Vec2> w(model_.mesh.triangles.size());
  stepper_->integrator().elements().stretch(state_.x, w);
  for (std::size_t t = 0; t < w.size(); ++t) {
    for (const Index corner : model_.mesh.triangles[t])
      stretch[at(corner)] = std::max(stretch[at(corner)], w[t].maxCoeff() - 1);
  }
  for (const SeamPair& pair : garment_->pairs) {
    SeamGap& gap = gaps[at(pair.seam)];
    const double distance = (state_.x[at(pair.b)] - state_.x[at(pair.a)]).norm();
    gap.stretch = std::max({gap.stretch, stretch[at(pair.a)], stretch[at(pair.b)]});
    if (distance <= gap.gap_m) continue;
    gap.gap_m = distance;
    gap.where = 0.5 * (state_.x[at(pair.a)] + state_.x[at(pair.b)]);
  }
  std::stable_sort(gaps.begin(), gaps.end(), [](const SeamGap& a, const SeamGap& b) { return a.gap_m > b.gap_m; });
  return gaps;
}

std::vector<double> weld_thickness(const WeldedMesh& welded, const std::vector<double>& scale) {
  std::vector<double> joined(at(welded.mesh.particle_count), 1);
  for (std::size_t i = 0; i < scale.size(); ++i) {
    double& s = joined[at(welded.particle_of[i])];
    s = std::min(s, scale[i]);
  }
  return joined;
}

void grow_thickness(std::vector<double>& scale) {
  for (double& s : scale) s = std::min(1.0, thickness_growth * std::max(s, least_thickness));
}

ClothState weld_state(const GarmentMesh& garment, const WeldedMesh& welded, const ClothModel& model,
                      const ClothState& state) {
  const std::vector<Vec3> x = class_means(garment.merged, model.mass_kg, state.x);
  const std::vector<Vec3> v = class_means(garment.merged, model.mass_kg, state.v);
  const std::size_t count = at(welded.mesh.particle_count);
  ClothState joined{Vec3s(count), Vec3s(count)};
  for (std::size_t i = 0; i < garment.merged.size(); ++i) {
    const std::size_t p = at(welded.particle_of[i]), root = at(garment.merged[i]);
    joined.x[p] = x[root];
    joined.v[p] = v[root];
  }
  return joined;
}

}  // namespace toile::internal
