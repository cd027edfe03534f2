#include "sim/budget.hpp"

#include "body/solid_shapes.hpp"
#include "core/available_memory.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "dress/dressing_body.hpp"
#include "dress/outfit_run.hpp"
#include "dress/sewing.hpp"
#include "io/mdd.hpp"
#include "io/pc2.hpp"
#include "sim/body_figure.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

namespace toile::internal {
namespace {

// Memory, measured as the peak of whole runs (bench/notes.md, "What a run takes").
constexpr double program_mb = 10;  // without cloth or body
constexpr double mb_per_particle =
    7.2e-3;  // model, matrix, contact, judge; 6.1 in the air, 8.2 where cloth lies on cloth
constexpr double mb_per_body_triangle = 1.1e-3;
constexpr double mb_per_sample = 12.0 / (1 << 20);  // of a vertex of a motion from a file: three floats

// Time of one step on two cores of a Xeon (docs/benchmarks.md, "How far from real time" and the drapes up to 100,000 particles).
constexpr double step_us = 6;  // per particle, of small cloth
constexpr double small_particles = 2600;
constexpr double body_step_us = 0.3;            // per triangle of a body
constexpr double second_core = 1.5;             // speed of two threads over one
constexpr double meshing_us = 20, load_us = 5;  // per particle of a pattern, per triangle of a body

constexpr double after_closing_s = 0.5;  // until the weld

constexpr std::size_t told_items = 3;

std::string quoted(const std::string& name) { return '"' + printable(name) + '"'; }

// A periodic motion.
bool by_name(const SceneCollider& collider) { return collider.motion && !collider.motion->name.empty(); }

double samples_of_motion(const std::string& path) {
  if (is_point_cache(path)) {
    try {
      return path.ends_with(".mdd") ? MddReader(path).samples() : Pc2Reader(path).samples();
    } catch (const Error&) {  // reported when it is read
      return 0;
    }
  }
  double samples = 0;
  std::error_code error;
  // A folder, or a pattern of names in one.
  const std::filesystem::path folder =
      std::filesystem::is_directory(path, error) ? path : std::filesystem::path(path).parent_path().string();
  for (std::filesystem::directory_iterator entry(folder.empty() ? "." : folder, error), end; !error && entry != end;
       entry.increment(error))
    if (has_mesh_ending(entry->path().string())) samples += 1;
  return samples;
}

class Estimate {
 public:
  Estimate(const Scene& scene, const TextSource& read) : scene_(&scene), read_(&read) {}

  Budget operator()() {
    budget_.name = scene_->name;
    for (std::size_t k = 0; k < scene_->cloth.size(); ++k) add_cloth(scene_->cloth[k]);
    add_collider("body", scene_->body, "/body");
    for (std::size_t k = 0; k < scene_->solids.size(); ++k)
      add_collider("solid " + std::to_string(k), scene_->solids[k], path_of_solid(k));
    for (const BudgetItem& item : budget_.items) budget_.memory_mb += item.memory_mb;
    budget_.memory_mb = program_mb + std::max(budget_.memory_mb, making_mb_);
    count_frames();
    return std::move(budget_);
  }

 private:
  void add_cloth(const SceneCloth& cloth) {
    const ClothCost cost = cost_of(cloth, *read_);
    for (const ClothCost::Part& part : cost.parts) {
      budget_.items.push_back({part.what, part.triangles, mb_per_particle * part.particles});
      budget_.particles += part.particles;
      budget_.triangles += part.triangles;
    }
    sewn_ = sewn_ || cloth.is_sewn();
    if (!cost.seams || !scene_->start.empty()) return;  // nothing is sewn
    if (cost.seams->farthest) budget_.far_panels.push_back(*cost.seams->farthest);
    const SewingOptions sewing;
    sewing_frames_ += std::ceil((cost.seams->widest_m / sewing.closing_speed_m_per_s + after_closing_s) * sewing.fps);
  }

  void add_collider(const std::string& name, const SceneCollider& collider, std::string_view path) {
    const ColliderCost cost = cost_of(collider);
    if (cost.what.empty()) return;
    if (!collider.worn) check_own_limit(collider, cost.triangles, path);
    budget_.items.push_back({name + ' ' + cost.what, cost.triangles, mb_per_body_triangle * cost.triangles});
    budget_.seconds += cost.making_s;
    body_triangles_ += cost.triangles;
    making_mb_ = std::max(making_mb_, cost.making_mb);
    if (!collider.motion || !collider.motion->name.empty()) return;
    const SceneMotion& motion = *collider.motion;
    if (moves_a_skeleton(motion.path)) {  // its poses take little
      motion_duration_s_ = std::max(motion_duration_s_, skeleton_motion_s(motion) + motion.lead_in_s);
      return;
    }
    const double samples = samples_of_motion(motion.path), vertices = cost.triangles / 2;
    motion_duration_s_ = std::max(motion_duration_s_, samples / motion.fps + motion.lead_in_s);
    budget_.items.push_back({"motion " + printable(motion.path), 0, mb_per_sample * samples * vertices});
  }

  // An item that is too large by itself is refused at its place in the file, as it would be when it is made, before the sum is checked.
  static void check_own_limit(const SceneCollider& solid, double triangles, std::string_view path) {
    constexpr auto most = static_cast<double>(most_solid_triangles);
    if (solid.is_person() || triangles <= most) return;
    throw InputError("", "edge_m", fmt::sprintf("at most %.0f triangles", most),
                     fmt::sprintf("at least %.0f", triangles))
        .of(path);
  }

  void count_frames() {
    const auto frames_in = [&](double seconds) { return std::max(1.0, std::round(seconds * scene_->fps)); };
    const bool moves = scene_->body.motion.has_value() ||
                       std::any_of(scene_->solids.begin(), scene_->solids.end(),
                                   [](const SceneCollider& solid) { return solid.moves_by_itself(); });
    double duration_s = scene_->seconds;
    if (moves && !scene_->seconds_given) {
      double longest_s = motion_duration_s_;
      for (const SceneCollider& solid : scene_->solids) longest_s = std::max(longest_s, solid.moves.duration_s());
      const bool endless = by_name(scene_->body) || std::any_of(scene_->solids.begin(), scene_->solids.end(), by_name);
      if (!endless) duration_s = longest_s;
    }
    budget_.frames = frames_in(duration_s);
    if (moves) budget_.frames += scene_->drape_seconds > 0 ? frames_in(scene_->drape_seconds) : 1;
    const double inner = sewn_ && scene_->start.empty() ? static_cast<double>(scene_->cloth.size() - 1) : 0;
    const double inner_frames = inner * frames_in(scene_->drape_seconds);
    const bool grows = sewn_ && scene_->start.empty() && body_triangles_ > 0;  // if it is a person
    const double growth_frames = grows ? frames_in(DressingBody::longest_growth_s) : 0;
    budget_.unwritten_frames = sewing_frames_ + growth_frames + inner_frames;

    const double longest_s = scene_->step_max_s.value_or(sewn_ ? 1.0 / 60 : 1 / scene_->fps);
    const double steps = sewing_frames_ + (budget_.frames + growth_frames + inner_frames) *
                                              std::ceil(1 / (scene_->fps * longest_s) - 1e-9);
    // Iterations and refused steps grow with the number of particles, measured by its power 0.35: 3/8 is made of square roots.
    const double more = std::max(1.0, budget_.particles / small_particles), fourth_root = std::sqrt(std::sqrt(more));
    const double slower = fourth_root * std::sqrt(fourth_root);
    const double step_s = 1e-6 * (step_us * slower * budget_.particles + body_step_us * body_triangles_);
    const double threads = available_threads() > 1 ? 1 : second_core;
    budget_.seconds += threads * steps * step_s + 1e-6 * load_us * body_triangles_;
    if (sewn_) budget_.seconds += 1e-6 * meshing_us * budget_.particles;
  }

  const Scene* scene_;
  const TextSource* read_;
  Budget budget_;
  bool sewn_ = false;
  double sewing_frames_ = 0, motion_duration_s_ = 0;
  double body_triangles_ = 0;
  double making_mb_ = 0;  // the peak of making one body, before there is cloth
};

std::string with_thousands(double value) {
  std::string digits = fmt::sprintf("%.0f", value);
  for (std::size_t k = digits.size(); k > 3; k -= 3) digits.insert(k - 3, 1, ',');
  return digits;
}

std::string largest_items(const Budget& budget) {
  std::vector<BudgetItem> items = budget.items;
  std::stable_sort(items.begin(), items.end(),
                   [](const BudgetItem& a, const BudgetItem& b) { return a.memory_mb > b.memory_mb; });
  std::string text;
  for (std::size_t k = 0; k < std::min(told_items, items.size()); ++k)
    text += (k == 0 ? "" : "; ") + items[k].what + ", " + with_thousands(items[k].triangles) + " triangles, " +
            with_thousands(items[k].memory_mb) + " MB";
  if (items.size() > told_items) text += "; and " + std::to_string(items.size() - told_items) + " more";
  return text;
}

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw Error(ErrorKind::resource_limit, printable(where) + ": " + what);
}

}  // namespace

Budget estimate_budget(const Scene& scene, const TextSource& read) { return Estimate(scene, read)(); }

void check_budget(const Budget& budget, const BudgetLimits& limits) {
  if (!budget.far_panels.empty()) {
    const FarPanel& far = budget.far_panels.front();
    const SewingOptions sewing;
    refuse(
        far.file,
        fmt::sprintf("panel %s: expected within %.0f m of what it is sewn to, got %.4g m from panel %s (seam %s); it "
                     "would be drawn in for %.0f s",
                     quoted(far.panel), most_drawn_m, far.distance_m, quoted(far.other), far.seam,
                     far.distance_m / sewing.closing_speed_m_per_s));
  }
  const double memory_mb = limits.memory_mb.value_or(available_memory_mb());
  if (budget.memory_mb > memory_mb)
    refuse(budget.name,
           fmt::sprintf("memory: expected at most %s MB (%s), got about %s MB: %s", with_thousands(memory_mb),
                        limits.memory_mb ? "--max-memory" : "what there is; --max-memory sets another limit",
                        with_thousands(budget.memory_mb), largest_items(budget)));
  const double frames = budget.frames + budget.unwritten_frames;
  if (frames > limits.frames)
    refuse(
        budget.name,
        fmt::sprintf("frames: expected at most %s (--max-frames), got up to %s, %s of them before the first is written",
                     with_thousands(limits.frames), with_thousands(frames), with_thousands(budget.unwritten_frames)));
  if (budget.seconds > 3600 * limits.hours)
    refuse(
        budget.name,
        fmt::sprintf("time: expected at most %.4g hours (--max-hours), got about %.4g: %s frames of %s triangles: %s",
                     limits.hours, budget.seconds / 3600, with_thousands(frames), with_thousands(budget.triangles),
                     largest_items(budget)));
}

}  // namespace toile::internal
