// Cloth with a strain limit: no frame beyond it, whatever pulls, or a diagnosis.
#include "io/pc2.hpp"
#include "io/scratch.hpp"
#include "sim/setup.hpp"
#include "sim/simulate.hpp"
#include "verify/crossings.hpp"
#include "verify/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace toile::internal {
namespace {

struct Result {
  Report report;
  double longest = 0;  // of any frame: |w| - 1
};

Result pulled(const std::string& scene_text) {
  const Scratch scratch;
  const Scene scene = parse_scene(scene_text, "s.json");
  RunOptions options;
  options.directory = scratch / "out";
  options.command = "test";
  Result result{simulate(scene, options), 0};
  const ClothMesh mesh = load_cloth(scene, 0, read_text_file).garment.mesh;
  Pc2Reader frames(scratch / "out/cloth.pc2");
  Vec3s x;
  for (int k = 0; k < frames.samples(); ++k) {
    frames.read(k, x);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const MaterialFrame frame = material_frame(mesh.uv[t]);
      Vec3 w_u = Vec3::Zero(), w_v = Vec3::Zero();
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3& p = x[static_cast<std::size_t>(mesh.triangles[t][c])];
        w_u += frame.alpha[static_cast<Eigen::Index>(c)] * p;
        w_v += frame.beta[static_cast<Eigen::Index>(c)] * p;
      }
      result.longest = std::max({result.longest, w_u.norm() - 1, w_v.norm() - 1});
    }
  }
  return result;
}

// Hung by two corners, a hundred times as heavy as on earth.
std::string hung(double limit) {
  return R"({"cloth": [{"grid": {"width_m": 0.4, "height_m": 0.4, "edge_m": 0.04},
      "fabric": {"base": "silk", "strain_limit": )" +
         std::to_string(limit) + R"(}, "pins": [{"near_m": [-0.2, 0.2, 0]}, {"near_m": [0.2, 0.2, 0]}]}],
    "world": {"gravity_m_per_s2": [0, -981, 0]}, "time": {"seconds": 0.8}})";
}

constexpr double of_float = 2e-5;  // positions in the file are float

TEST(StrainLimitRun, HoldsInEveryFrame) {
  const Result free = pulled(hung(0));
  EXPECT_EQ(free.report.ended, "time");
  EXPECT_GT(free.longest, 0.1);
  for (const double limit : {0.05, 0.01}) {
    const Result limited = pulled(hung(limit));
    EXPECT_EQ(limited.report.ended, "time") << limit;
    EXPECT_LE(limited.longest, limit + of_float);
    EXPECT_GT(limited.longest, 0.6 * limit) << "it is pulled that far";
    EXPECT_TRUE(limited.report.verdict.pass);
  }
}

TEST(StrainLimitRun, IsNotPaidForWithACrossing) {
  // Two layers on a ball that rises under held corners.
  const auto scene = [](const std::string& limit) {
    std::string sheets;
    for (const char* y : {"0.004", "0.010"})
      sheets +=
          std::string(sheets.empty() ? "" : ", ") + R"({"name": "at )" + y +
          R"(", "grid": {"width_m": 0.4, "height_m": 0.4, "edge_m": 0.04}, "fabric": {"base": "silk", "strain_limit": )" +
          limit + R"(}, "placement": {"translation_m": [0, )" + y + R"(, 0], "rotation_deg": [-90, 0, 0]},
                "pins": [{"near_m": [-0.2, 0, -0.2]}, {"near_m": [0.2, 0, -0.2]}, {"near_m": [-0.2, 0, 0.2]}, {"near_m": [0.2, 0, 0.2]}]})";
    return R"({"cloth": [)" + sheets +
           R"(], "solids": [{"sphere": {"radius_m": 0.1}, "edge_m": 0.03, "placement": {"translation_m": [0, -0.1, 0]},
      "moves": [{"t_s": 0}, {"t_s": 0.5, "shift_m": [0, 0.02, 0]}]}], "time": {"seconds": 0.6, "step_max_ms": 10}})";
  };
  const Result limited = pulled(scene("0.05"));
  EXPECT_EQ(limited.report.ended, "time");
  EXPECT_LE(limited.longest, 0.05 + of_float);
  EXPECT_EQ(limited.report.audit.cloth_cloth_edges.max, 0);
  EXPECT_EQ(limited.report.audit.cloth_body_edges.max, 0);
}

// A waistband that wants to be a fifth shorter, held at the length to which it was cut.
TEST(StrainLimitRun, LeavesElasticItsStretch) {
  const Result elastic =
      pulled(R"({"cloth": [{"name": "band", "grid": {"width_m": 0.4, "height_m": 0.1, "edge_m": 0.03},
      "fabric": {"base": "silk", "strain_limit": 0.02}, "panels": {"band": {"rest_stretch_u": 0.8, "rest_stretch_v": 0.8}},
      "pins": [{"in_box_m": [[-0.21, -1, -1], [-0.19, 1, 1]]}, {"in_box_m": [[0.19, -1, -1], [0.21, 1, 1]]}]}],
    "time": {"seconds": 1}})");
  EXPECT_EQ(elastic.report.ended, "time");
  EXPECT_EQ(elastic.report.drape.steps_rejected, 0);
  EXPECT_LE(elastic.longest, 0.02 + of_float);
}

TEST(StrainLimitRun, ContradictingPinsAreDiagnosed) {
  const Result torn = pulled(R"({"cloth": [{"name": "flag", "grid": {"width_m": 0.4, "height_m": 0.2, "edge_m": 0.04},
      "fabric": {"base": "silk", "strain_limit": 0.01},
      "pins": [{"in_box_m": [[-0.21, -1, -1], [-0.19, 1, 1]]},
               {"in_box_m": [[0.19, -1, -1], [0.21, 1, 1]], "hold": "moves", "moves": [{"t_s": 0}, {"t_s": 0.5, "shift_m": [0.02, 0, 0]}]}]}],
    "time": {"seconds": 1}})");
  EXPECT_EQ(torn.report.ended, "step_collapsed");
  EXPECT_LE(torn.longest, 0.01 + of_float);
  ASSERT_FALSE(torn.report.verdict.reasons.empty());
  const std::string& detail = torn.report.verdict.reasons.front().detail;
  EXPECT_NE(detail.find("its limit is 1 %"), std::string::npos) << detail;
  EXPECT_NE(detail.find("of flag ("), std::string::npos) << detail;
}

}  // namespace
}  // namespace toile::internal
