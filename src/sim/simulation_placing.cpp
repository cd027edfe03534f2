// sim/simulation_placing.cpp: places the flat panels of a garment around a body, and compares the body with the pattern's.
#include "core/error.hpp"
#include "garment/layering.hpp"
#include "garment/placement.hpp"
#include "garment/sleeves.hpp"
#include "sim/body_figures.hpp"
#include "sim/simulation.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace toile::internal {
namespace {

constexpr std::array<double, 4> arm_lifts{0, 0.25, 0.5, 1};  // 1: level

}  // namespace

// Finds the person around whom the first garment is sewn, if there is one.
void Simulation::find_person() {
  const Timed timed(startup(&StartupReport::placement));
  Arms arms =
      find_arms(std::span(standing_x_).first(person_vertices_), std::span(body_triangles_).first(person_triangles_));
  figures();
  add_arms(*figures_, arms);
  if (measurements_ && !resumes()) {
    const std::string odd = odd_pose(*measurements_, *figures_);
    if (!odd.empty()) report_.warnings.push_back(odd);
  }
  if (!arms) return;
  dressing_body_.emplace(standing_x_, body_triangles_, person_vertices_, person_triangles_, std::move(*arms));
  make_thin();
}

const BodyFigures& Simulation::figures() {
  if (!figures_)
    figures_ = body_figures(std::span(standing_x_).first(person_vertices_),
                            std::span(body_triangles_).first(person_triangles_), measurements_);
  return *figures_;
}

void Simulation::make_thin() {
  dressing_body_->set_pose(pose_);
  dressing_body_->at(0, body_x_);
  stand();
}

// Sets the body to body_x_: twice, so that its motion is zero.
void Simulation::stand() {
  for (int k = 0; k < 2; ++k) body_->set_motion(body_x_, body_x_);
}

// Lifts the arms by the least that leaves the fewest seams behind the thin body.  A wide bodice is drawn flat across the arms, which
// must not be in the way of its sides.
Placement Simulation::place_around_arms(std::size_t k) {
  GarmentMesh& garment = cloth_[k].garment;
  const GarmentMesh drawn = garment;
  on_shoulders_ = false;  // of what another run has found, too
  std::vector<std::string> told_later;
  const std::vector<LabelHeight> heights = heights_of(k, told_later);
  const auto held = std::find_if(heights.begin(), heights.end(),
                                 [](const LabelHeight& height) { return height.label == edge_label::waist; });
  Placement best;
  for (const double lift : arm_lifts) {
    dressing_body_->set_pose({{lift, lift}, {1, 1}});
    GarmentMesh placed = drawn;
    const std::array<DressingBody::ArmAxis, 2> axes = dressing_body_->arm_axes();
    const std::array<ArmLine, 2> arms{ArmLine{axes[0].root, axes[0].direction},
                                      ArmLine{axes[1].root, axes[1].direction}};
    hang_sleeves(placed, arms, dressing_body_->height_m());
    const std::array<bool, 2> drawn_over = covers_shoulders(placed, arms);
    std::optional<double> waist_m;  // of what hangs from it
    if (held != heights.end() && !drawn_over[0] && !drawn_over[1]) waist_m = held->height_m;
    separate_layers(placed, 0.5 * (arms[0].root + arms[1].root));
    dressing_body_->lifted(body_x_);
    stand();
    Placement placement = place_garment(placed, *body_, person_vertices_, waist_m);
    hang_sleeves(placed, arms, dressing_body_->height_m());  // the shift moved the whole garment
    const std::array<bool, 2> covered = covers_shoulders(placed, arms);
    const DressingBody::Pose pose = dressing_body_->pose_within(lift, covered);
    dressing_body_->set_pose(pose);
    dressing_body_->at(0, body_x_);
    stand();
    find_blocked(placed, *body_, placement);

    if (lift != arm_lifts.front() && placement.blocked >= best.blocked) continue;
    best = placement;
    pose_ = pose;
    on_shoulders_ = covered[0] || covered[1];
    garment = std::move(placed);
    if (best.blocked == 0) break;
  }
  make_thin();
  return best;
}

// `tell`: report problems of the placement.
void Simulation::place(std::size_t k, bool tell) {
  if (!body_) return;
  GarmentMesh& garment = cloth_[k].garment;
  const Timed timed(startup(&StartupReport::placement));
  say("placing", 0);
  const Placement placement = dressing_body_ ? place_around_arms(k) : place_garment(garment, *body_, person_vertices_);
  if (!tell) return;
  report_.shift_m = placement.shift_m;
  if (placement.raised_m != 0)
    report_.warnings.push_back(
        fmt::sprintf("%s is in the frame of the templates of 2021, with y = 0 near the pelvis: raised by %.1f cm, %g "
                     "of the body's height",
                     printable(garment.name), 100 * placement.raised_m, legacy_origin));
  if (placement.panel_crossings > 0)
    bad_start(garment.name,
              std::to_string(placement.panel_crossings) + " edges of the placed panels pass through the body");
  for (const Index seam : placement.blocked_seams)
    report_.warnings.push_back("the straight way between the two sides of seam " +
                               garment.seams[static_cast<std::size_t>(seam)].name + " leads through the body");
}

std::vector<LabelHeight> Simulation::heights_of(std::size_t cloth, std::vector<std::string>& warnings) {
  return label_heights_of(scene_.cloth[cloth], cloth_[cloth].garment, cloth == 0 && on_shoulders_, figures(), warnings);
}

// Warns where the body differs from the one that the pattern was cut for.
void Simulation::tell_misfits(std::size_t cloth) {
  if (!cloth_[cloth].pattern || person_vertices_ == 0) return;
  const std::string which = cloth_.size() > 1 ? printable(cloth_[cloth].garment.name) + ": " : "";
  for (const Misfit& misfit : misfits(*cloth_[cloth].pattern, figures()))
    report_.warnings.push_back(which + std::string(misfit.code) + ": the pattern is cut for " + misfit.expected +
                               "; this body has " + misfit.got);
}

}  // namespace toile::internal
