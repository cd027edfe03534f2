#include "sim/simulation.hpp"

#include "core/error.hpp"
#include "sim/offenders.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace toile::internal {
namespace {

// Without duplicate codes.
void add_reason(std::vector<Reason>& reasons, std::string_view code, const std::string& detail) {
  for (Reason& known : reasons) {
    if (known.code != code) continue;
    known.detail += "; " + detail;
    return;
  }
  reasons.push_back({std::string(code), detail});
}

}  // namespace

Simulation::Simulation(Scene scene, LoadedScene loaded, SimulationOptions options, SimulationObserver& observer)
    : scene_(std::move(scene)),
      options_(std::move(options)),
      observer_(&observer),
      cloth_(std::move(loaded.cloth)),
      start_(std::move(loaded.start)),
      person_vertices_(loaded.colliders.worn_vertices),
      person_triangles_(loaded.colliders.worn_triangles),
      measurements_(std::move(loaded.colliders.measurements)),
      motion_(std::move(loaded.colliders.joined.movement)) {
  report_.name = scene_.name;
  report_.fps = scene_.fps;
  report_.startup.scene = options_.seconds_before;
  report_.startup.cloth = loaded.cloth_s;
  report_.startup.body = loaded.body_s;
  report_.warnings = std::move(loaded.colliders.warnings);
  for (const LoadedCloth& cloth : cloth_) {
    report_.warnings.insert(report_.warnings.end(), cloth.warnings.begin(), cloth.warnings.end());
    report_.vertices += cloth.garment.mesh.particle_count;
    report_.triangles += cloth.garment.mesh.triangle_count();
    report_.panels += static_cast<int>(cloth.garment.mesh.panel_names.size());
    report_.seams += static_cast<int>(cloth.garment.seams.size());
  }
  const Timed timed(report_.startup.body);
  JoinedColliders& joined = loaded.colliders.joined;
  body_x_ = standing_x_ = joined.surface.positions;
  body_triangles_ = joined.surface.triangles;
  colliders_ = std::move(joined.parts);
  report_.body_vertices = static_cast<int>(body_x_.size());
  report_.body_triangles = static_cast<int>(body_triangles_.size());
  if (!body_triangles_.empty())
    body_.emplace(std::move(joined.surface.positions), std::move(joined.surface.triangles),
                  std::move(joined.vertex_collider));
  double edge_m = 0;
  for (const LoadedCloth& cloth : cloth_) edge_m = std::max(edge_m, cloth.edge_m);
  step_ = step_options(scene_, edge_m);
}

void Simulation::run() {
  if (!put_on()) return;
  const std::string put_on_ended = failure_.empty() ? "" : failure_.front().code;
  begin();
  if (!stopped_short_ && (place_.phase == RunPhase::motion || drape()) && motion_) animate();
  judge_worn();
  if (!put_on_ended.empty() && report_.ended != reason::interrupted) report_.ended = put_on_ended;
  close();
}

void Simulation::limit_dressing(double longest_s, double time_limit_s) {
  scene_.until_still = true;
  scene_.seconds = scene_.drape_seconds = longest_s;
  options_.time_limit_s = time_limit_s;
  options_.watch = {};
}

void Simulation::judge_worn() {
  if (report_.ended == "time" && failure_.empty()) judge_end();
  if (failure_.empty()) slid_down(1);
}

// Resumes from the saved state.
void Simulation::take_up(StateReader& archive) {
  remember(archive);
  earlier_s_ = report_.seconds_total;
  if (place_.cloth >= cloth_.size())
    throw InputError(archive.file(), "garment", "one of " + std::to_string(cloth_.size()),
                     std::to_string(place_.cloth));
  taken_up_ = &archive;
  wear_again();
  archive(outfit_);
}

std::string Simulation::state() {
  StateWriter archive;
  remember(archive);
  archive(outfit_);
  run_->remember(archive);
  return archive.take();
}

// A phase ends early.  False: the user stopped it, and it can be resumed.  True: its time limit is over, and the present state is shown.
bool Simulation::cut_off(const std::string& when) {
  stopped_short_ = !user_stopped_;
  if (stopped_short_)
    end(reason::time_limit, fmt::sprintf("%.3g s were over ", options_.time_limit_s) + when);
  else
    end(reason::interrupted, when);
  return stopped_short_;
}

int Simulation::frames_in(double seconds) const {
  return std::max(1, static_cast<int>(std::lround(seconds * scene_.fps)));
}

void Simulation::end(std::string_view how, const std::string& detail) {
  report_.ended = how;
  add_reason(failure_, how, detail);
}

// A pass gets this reservation.
void Simulation::qualify(std::string_view code, const std::string& detail) {
  add_reason(qualifications_, code, detail);
}

// The step failed at every step size: reports the offenders, also to the observer.
void Simulation::collapse(const std::string& when, const FrameReport& frame, const ClothMesh& mesh,
                          std::span<const Vec3> x) {
  std::string words = when + ": " + frame.diagnosis;
  if (!frame.offenders.empty()) {
    const SurfaceMesh offenders =
        offenders_obj(mesh, x, frame.offenders, body_triangles_, body_ ? body_->positions() : std::span<const Vec3>{});
    words += "; offenders.obj: " + name_triangles(mesh, frame.offenders);
    const auto of_body = std::count(offenders.object.begin(), offenders.object.end(), 1);
    if (of_body > 0) words += ", and " + std::to_string(of_body) + " triangles of the body near them";
    observer_->collapsed(offenders);
  }
  end(reason::step_collapsed, words);
}

// Called before the first step of every phase; only the first call counts.
void Simulation::end_startup() {
  if (report_.startup.total == 0) report_.startup.total = options_.seconds_before + options_.watch.seconds();
}

// The counter for the time of a part of the startup; after the first step a dummy.
double& Simulation::startup(double StartupReport::*part) {
  return report_.startup.total == 0 ? report_.startup.*part : after_startup_;
}

}  // namespace toile::internal
