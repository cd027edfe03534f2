// apps/bench/bench_torture.cpp: `toile bench torture`: scenes that break cloth simulators, each at three sizes, from jittered starts.
//
// The scenes are those of scenes/torture, drawn by us after published ones (docs/torture.md).  A size scales every edge of the
// cloth.  Start 0 is the scene as it is; start k shifts every cloth by up to a thousandth of its extent and turns it by up to a
// hundredth of a radian about each axis, by a generator with seed k.
//
// A run holds when it reaches its last frame, with finite positions, and no edge passes through a triangle in any frame; an
// impossible scene holds when it ends early with the right diagnosis, and no frame with crossings was written.
#include "bench.hpp"
#include "embedded.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <random>
#include <string>

namespace toile::internal {
namespace {

struct Size {
  std::string_view name;
  double edge_scale;
};
constexpr std::array<Size, 3> sizes = {{{"S", 1}, {"M", 0.34}, {"L", 0.17}}};

constexpr std::string_view torture_folder = "scenes/torture/";

struct Impossible {
  std::string_view scene, diagnosis;
};
constexpr std::array<Impossible, 1> impossible = {{{"15-belt-5-percent", "its limit is 5 %"}}};

std::vector<std::string> torture_scenes(const std::vector<std::string>& wanted) {
  std::vector<std::string> names, numbers;
  std::string known;
  for (const EmbeddedFile& file : embedded_files()) {
    if (!file.path.starts_with(torture_folder)) continue;
    std::string name(file.path.substr(torture_folder.size()));
    name.resize(name.size() - std::string_view(".json").size());
    const std::string number = name.substr(0, name.find('-'));
    if (wanted.empty() || std::find(wanted.begin(), wanted.end(), number) != wanted.end())
      names.push_back(std::move(name));
    known.append(known.empty() ? "" : ", ").append(number);
    numbers.push_back(number);
  }
  for (const std::string& one : wanted)
    if (std::find(numbers.begin(), numbers.end(), one) == numbers.end())
      throw Error(ErrorKind::usage, "bench torture: --scenes: expected of " + known + ", got " + printable(one));
  return names;
}

double extent_m(const SceneCloth& cloth) {
  if (const auto* grid = cloth.as<SceneGrid>()) return std::max(grid->width_m, grid->height_m);
  if (const auto* tube = cloth.as<SceneTube>()) return std::max(2 * tube->radius_m, tube->length_m);
  if (const auto* ribbon = cloth.as<SceneRibbon>()) {
    double farthest = 0;
    for (const Vec3& p : ribbon->path_m) farthest = std::max(farthest, (p - ribbon->path_m.front()).norm());
    return farthest;
  }
  return 1;
}

// The generator's numbers are fixed by the standard; its distributions are not.
void jitter(Scene& scene, int seed) {
  if (seed == 0) return;
  std::mt19937_64 generator(static_cast<std::uint64_t>(seed));
  const auto one = [&] { return 2 * (static_cast<double>(generator() >> 11) / 9007199254740992.0) - 1; };
  const auto vector = [&] {
    const double x = one(), y = one(), z = one();
    return Vec3(x, y, z);
  };
  for (SceneCloth& cloth : scene.cloth) {
    cloth.translation_m += 1e-3 * extent_m(cloth) * vector();
    cloth.rotation_deg += 1e-2 * (180 / std::numbers::pi) * vector();
  }
}

bool moves(const Scene& scene) {
  return scene.body.motion.has_value() ||
         std::any_of(scene.solids.begin(), scene.solids.end(),
                     [](const SceneCollider& solid) { return solid.moves_by_itself(); });
}

int expected_frames(const Scene& scene) {
  return static_cast<int>(std::lround(scene.seconds * scene.fps)) - (moves(scene) ? 0 : 1);
}

bool finished(const Scene& scene, const Report& report) {
  return reached_its_end(report) && measured_phase(report).frames == expected_frames(scene);
}

// Whether it ended as the scene should.  With `first_frames` an impossible scene may finish: its impossible part may come later.
bool came_to_its_end(const std::string& name, const Scene& scene, const Report& report, bool first_frames) {
  const auto scene_is = [&](const Impossible& one) { return one.scene == name; };
  const auto found = std::find_if(impossible.begin(), impossible.end(), scene_is);
  if (found == impossible.end() || (first_frames && finished(scene, report))) return finished(scene, report);
  const std::vector<Reason>& reasons = report.verdict.reasons;
  return report.ended == reason::step_collapsed && !reasons.empty() &&
         reasons.front().detail.find(found->diagnosis) != std::string::npos;
}

bool holds(bool ended_as_it_should, const Report& report) {
  const VerifyReport& audit = report.audit;
  return ended_as_it_should && audit.finite && audit.cloth_cloth_edges.max == 0 && audit.cloth_body_edges.max == 0;
}

BenchRow row_of(const std::string& name, const Size& size, int start, const Scene& scene, const Report& report,
                bool ended_as_it_should) {
  const PhaseReport& phase = measured_phase(report);
  const VerifyReport& audit = report.audit;
  BenchRow row;
  row.add("scene", "scene", name);
  row.add("size", "size", std::string(size.name));
  row.add("start", "start", static_cast<long>(start));
  row.add("vertices", "vertices", static_cast<long>(report.vertices));
  row.add("frames", "frames", static_cast<long>(phase.frames));
  row.add("frames_expected", "of", static_cast<long>(expected_frames(scene)));
  row.add("holds", "holds", std::string(holds(ended_as_it_should, report) ? "yes" : "no"));
  row.add("ended", "ended", report.ended);
  row.add("cloth_cloth_edges_max", "c-c max", static_cast<long>(audit.cloth_cloth_edges.max));
  row.add("cloth_cloth_frames", "frames", static_cast<long>(audit.cloth_cloth_edges.frames));
  row.add("cloth_body_edges_max", "c-b max", static_cast<long>(audit.cloth_body_edges.max));
  row.add("cloth_body_frames", "frames", static_cast<long>(audit.cloth_body_edges.frames));
  row.add("outside_pinches_max", "with room", static_cast<long>(audit.outside_pinches.max));
  row.add("stretch_max_percent", "stretch %", 100 * audit.stretch.max, 1);
  if (audit.has_body)
    row.add("gap_min_mm", "gap mm", audit.gap.min_mm, 2);
  else
    row.add_empty("gap_min_mm", "gap mm");
  row.add("steps", "steps", phase.steps);
  row.add("steps_rejected", "rejected", phase.steps_rejected);
  row.add("corrected", "corrected", phase.corrected);
  row.add("truncated", "frozen", phase.truncated);
  row.add("pierced", "pierced", phase.pierced);
  row.add("pinched_max", "pinched", static_cast<long>(phase.pinched));
  row.add("seconds_per_frame", "s/frame", seconds_per_frame(phase), 3);
  row.add("peak_memory_mb", "MB so far", report.peak_memory_mb, 0);
  row.add("state_hash", "hash", report.state_hash);
  return row;
}

}  // namespace

BenchResult bench_torture(BenchRuns& runs) {
  BenchResult result{"torture", {{"rows", {}, false}}, {}, {}, true};
  const CommandLine& line = runs.line();
  const Size& size =
      *std::find_if(sizes.begin(), sizes.end(), [&](const Size& one) { return one.name == line.torture_size; });
  long held = 0, all = 0;
  for (const std::string& name : torture_scenes(line.rows)) {
    for (int start = line.first_start; start < line.first_start + line.starts && !interrupted(); ++start) {
      Scene scene = embedded_scene("torture/" + name);
      for (SceneCloth& cloth : scene.cloth) cloth.set_edge_m(size.edge_scale * cloth.edge_m());
      jitter(scene, start);
      if (line.bench_frames) scene.seconds = (*line.bench_frames + (moves(scene) ? 0 : 1)) / scene.fps;
      const std::string run = name + "-" + std::string(size.name) + "-" + std::to_string(start);
      ++all;
      try {
        const Report report = runs.run(scene, run);
        const bool ended_as_it_should = came_to_its_end(name, scene, report, line.bench_frames.has_value());
        result.tables[0].rows.push_back(row_of(name, size, start, scene, report, ended_as_it_should));
        if (holds(ended_as_it_should, report)) ++held;
        if (ended_as_it_should) continue;
        result.complete = false;
        const std::vector<Reason>& reasons = report.verdict.reasons;
        result.notes.push_back(run + ": " +
                               (reasons.empty() ? report.ended : reasons.front().code + ": " + reasons.front().detail));
      } catch (const Error& error) {
        result.complete = false;
        result.notes.push_back(run + ": " + error.what());
      }
    }
  }
  result.facts.add("runs", "runs", all);
  result.facts.add("held", "of them without a fault", held);
  return result;
}

}  // namespace toile::internal
