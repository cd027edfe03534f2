// Stacks of sheets that fall on each other, on the floor and on a sphere: they come to rest, and nothing passes through anything.
#include "assembly/elements.hpp"
#include "core/hash.hpp"
#include "dress/outfit_run.hpp"
#include "io/file.hpp"
#include "io/scratch.hpp"
#include "sim/setup.hpp"
#include "sim/simulate.hpp"
#include "support/bodies.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <string>

namespace toile::internal {
namespace {

enum class Under { floor, sphere };

std::string to_obj(const BodySurface& body) {
  std::string text;
  for (const Vec3& p : body.positions())
    text += "v " + std::to_string(p.x()) + ' ' + std::to_string(p.y()) + ' ' + std::to_string(p.z()) + '\n';
  for (const Triangle& t : body.triangles())
    text += "f " + std::to_string(t[0] + 1) + ' ' + std::to_string(t[1] + 1) + ' ' + std::to_string(t[2] + 1) + '\n';
  return text;
}

// Each sheet is turned by 18 degrees against the one below it and lies 5 mm above it.
Scene stack(const Scratch& scratch, int sheets, Under under, double seconds, double aside_m) {
  std::string text = R"({"cloth": [)";
  for (int i = 0; i < sheets; ++i) {
    text += std::string(i == 0 ? "" : ", ") + R"({"name": "sheet )" + std::to_string(i) +
            R"(", "grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": 0.025}, "placement": {"translation_m": [)" +
            std::to_string((0.003 + aside_m) * i) + ", " + std::to_string(0.005 + 0.005 * i) + ", " +
            std::to_string(0.002 * i) + R"(], "rotation_deg": [-90, )" + std::to_string(18 * i) + ", 0]}}";
  }
  text += R"(], "body": )";
  if (under == Under::floor) {
    text += R"({"cylinder": {"radius_m": 0.6, "height_m": 0.3}})";
  } else {
    scratch.put("sphere.obj", to_obj(test::sphere(Vec3(0, -0.15, 0), 0.15, 4)));
    text += R"({"mesh": "sphere.obj", "unit": "m"})";
  }
  text += R"(, "time": {"seconds": )" + std::to_string(seconds) + R"(, "step_max_ms": 20, "until_still": false}})";
  return parse_scene(text, scratch / "s.json");
}

Report run(int sheets, Under under, double seconds, double aside_m) {
  const Scratch scratch;
  RunOptions options;
  options.directory = scratch / "out";
  options.command = "test";
  return simulate(stack(scratch, sheets, under, seconds, aside_m), options);
}

// From any start: how far aside each sheet lies changes which threads come to lie on which, and every bit.
void expect_rest(int sheets, Under under, double seconds) {
  std::array<double, 3> speed{};
  for (std::size_t k = 0; k < speed.size(); ++k) {
    const Report report = run(sheets, under, seconds, 0.37e-3 * static_cast<double>(k));
    EXPECT_EQ(report.ended, "time");
    EXPECT_EQ(report.audit.cloth_cloth_edges.max, 0) << sheets;
    EXPECT_EQ(report.audit.cloth_body_edges.max, 0) << sheets;
    speed[k] = report.audit.still_mm_per_s_p99;
  }
  std::printf("%d sheets: %.2f %.2f %.2f mm/s\n", sheets, speed[0], speed[1], speed[2]);
  for (const double p99 : speed) EXPECT_LT(p99, 2) << sheets << " sheets, the last second of " << seconds;
}

TEST(Stack, OfTwoFiveAndTenSheetsOnTheFloorComesToRest) {
  for (const int sheets : {2, 5, 10}) expect_rest(sheets, Under::floor, 2);
}

TEST(Stack, OfTwoAndFiveSheetsOnASphereComesToRest) {
  for (const int sheets : {2, 5}) expect_rest(sheets, Under::sphere, 8);
}

TEST(StackLong, OfTenSheetsOnASphereComesToRest) { expect_rest(10, Under::sphere, 8); }

// Kinetic, elastic, of gravity, and what contacts store: ten sheets that land together have a sixth of it there for a moment.
double energy_J(const ClothModel& model, Elements& elements, const ClothState& state, double in_contacts_J) {
  elements.evaluate(model, state);
  double sum = in_contacts_J + elements.energy_J();
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    sum += 0.5 * model.mass_kg[i] * state.v[i].squaredNorm();
    sum -= model.mass_kg[i] * model.gravity_m_per_s2.dot(state.x[i]);
  }
  return sum;
}

struct Rises {
  double largest, sum;  // from one frame to the next, and all of them: of what is lost in the end
  int frame;            // of the largest
};

Rises rises_of_energy(int sheets, Under under, double step_max_s) {
  const double seconds = under == Under::floor ? 1 : 1.5;
  const Scratch scratch;
  Scene scene = stack(scratch, sheets, under, seconds, 0);
  scene.step_max_s = step_max_s;
  std::vector<LoadedCloth> cloth;
  for (std::size_t k = 0; k < scene.cloth.size(); ++k) cloth.push_back(load_cloth(scene, k, read_text_file));
  Outfit outfit = outfit_of_shapes(cloth);
  SolidMesh loaded = load_collider(scene.body).surface;
  BodySurface body(std::move(loaded.positions), std::move(loaded.triangles));
  OutfitRun run(run_options(scene, step_options(scene, cloth.front().edge_m)), outfit, &body);
  Elements elements(run.model());
  const double first = energy_J(run.model(), elements, outfit.state, 0);
  double last = first;
  Rises rises{0, 0, 0};
  for (int frame = 1; frame <= static_cast<int>(seconds * scene.fps); ++frame) {
    EXPECT_TRUE(run.frame().ok);
    const double now = energy_J(run.model(), elements, outfit.state, run.stored_in_contacts_J());
    if (now - last > rises.largest) rises.largest = now - last, rises.frame = frame;
    rises.sum += std::max(0.0, now - last);
    last = now;
  }
  EXPECT_LT(last, first);
  return {rises.largest / (first - last), rises.sum / (first - last), rises.frame};
}

void expect_rises_below(double share, double step_max_s) {
  for (const Under under : {Under::floor, Under::sphere}) {
    for (const int sheets : {2, 5, 10}) {
      const Rises rises = rises_of_energy(sheets, under, step_max_s);
      std::printf("%d sheets: the energy rises by at most %.4f %% in a frame (%d), %.4f %% in all\n", sheets,
                  100 * rises.largest, rises.frame, 100 * rises.sum);
      EXPECT_LT(rises.largest, share) << sheets << (under == Under::floor ? " on the floor" : " on the sphere");
    }
  }
}

TEST(Stack, LosesEnergyInEveryFrameInStepsOf8Milliseconds) { expect_rises_below(1e-3, 8e-3); }

// One start in thirty has a fold that snaps within a step.  With one linear solve per step two sheets on the sphere gain 165 % in a frame
// (docs/validation.md#energy).
TEST(Stack, GainsLittleInAnyFrameInStepsOf20Milliseconds) { expect_rises_below(0.04, 20e-3); }

}  // namespace
}  // namespace toile::internal
