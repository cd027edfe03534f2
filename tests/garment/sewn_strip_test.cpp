// Strips of two panels whose seam has allowances, loose and stitched down: how they bend along and across it, and what they weigh.
#include "garment/garment_mesh.hpp"
#include "garment/pattern_text.hpp"
#include "material/edge_finish.hpp"
#include "support/strip_rigidity.hpp"

#include <numeric>

namespace toile::internal {
namespace {

constexpr double length_m = 0.2, width_m = 0.04, allowance_m = 0.01;

enum class SeamRuns { along, across };

// A strip of 20 x 4 cm, upright, sewn of two in its middle.
ClothMesh sewn_strip(SeamRuns seam, double edge_m, const EdgeFinish& finish) {
  const std::string edges = pattern_text::square_edges, placed = "[0, 100, 20]";
  const bool along = seam == SeamRuns::along;
  const std::string first = along ? "[[0, 0], [2, 0], [2, 20], [0, 20]]" : "[[0, 0], [4, 0], [4, 10], [0, 10]]",
                    second = along ? "[[2, 0], [4, 0], [4, 20], [2, 20]]" : "[[0, 10], [4, 10], [4, 20], [0, 20]]";
  Pattern pattern = pattern_text::parse(
      pattern_text::file("{\"first\": " + pattern_text::panel(first, edges, placed) +
                             ", \"second\": " + pattern_text::panel(second, edges, placed) + "}",
                         "[" + pattern_text::stitch("first", along ? 1 : 2, "second", along ? 3 : 0) + "]"));
  finish_other_edges(pattern, finish);
  return weld(mesh_garment(pattern, edge_m)).mesh;
}

Fabric cloth() {
  Fabric fabric = test::elastic_cotton();
  fabric.bend_poisson = 0;  // a strip's rigidity is then D, however wide it is
  return fabric;
}

// How far the strip sags that is held at its lower end, over what it does with the rigidity D and no allowances.
double sag(SeamRuns seam, double edge_m, const EdgeFinish& finish, double D_N_m) {
  const Fabric fabric = cloth();
  Fabric other = fabric;
  other.bend_u_N_m = other.bend_v_N_m = D_N_m;
  const ClothModel plain = build_model(sewn_strip(seam, edge_m, {}), {&other, 1});
  ClothModel sewn = build_model(sewn_strip(seam, edge_m, finish), {&fabric, 1});
  sewn.mass_kg = plain.mass_kg;  // the same load
  const auto end = [&](const ClothModel& model) {
    return test::end_deflection(model, test::StripAlong::u, length_m, 1.01 * edge_m);
  };
  return end(sewn) / end(plain);
}

TEST(SewnStrip, BendsAlongItsSeamByTheSumOfAllLayers) {
  const Fabric fabric = cloth();
  const double D = fabric.bend_u_N_m, coupling = layer_coupling_N_m(fabric, {1, 0});
  EXPECT_NEAR(coupling, 0.1 / 1.1 * 3000 * 3e-4 * 3e-4, 1e-12);
  for (const double edge : {0.01, 0.005}) {
    const double loose = D + 2 * allowance_m / width_m * D, stitched = loose + 2 * allowance_m / width_m * coupling;
    EXPECT_NEAR(sag(SeamRuns::along, edge, {0, 0, allowance_m, false}, loose), 1, 0.03) << edge;
    EXPECT_NEAR(sag(SeamRuns::along, edge, {0, 0, allowance_m, true}, stitched), 1, 0.03) << edge;
  }
}

// Held at x = h, under q per length: w = int M (L - x)/(D(x) b) dx, M = q (L - x)^2/2.
TEST(SewnStrip, BendsAcrossItsSeamAsTheClothOrStitchedDownAsABundle) {
  const Fabric fabric = cloth();
  const double D = fabric.bend_u_N_m, bundle = 2 * D + layer_coupling_N_m(fabric, {1, 0});
  EXPECT_GT(bundle, 3.5 * D);
  for (const double edge : {0.01, 0.007, 0.005}) {  // the band is one row of triangles, and ends within them
    const auto fourth = [](double x) { return std::pow(length_m - x, 4); };
    const double share = (fourth(0.1 - allowance_m) - fourth(0.1 + allowance_m)) / fourth(edge);
    EXPECT_NEAR(sag(SeamRuns::across, edge, {0, 0, allowance_m, false}, D), 1, 1e-3) << edge;
    const double less = share * (1 - D / bundle);
    EXPECT_NEAR(1 - sag(SeamRuns::across, edge, {0, 0, allowance_m, true}, D), less, 0.12 * less) << edge;
  }
}

TEST(SewnStrip, CarriesOneMoreLayerOnEitherSideOfTheSeam) {
  const Fabric fabric = cloth();
  for (const SeamRuns seam : {SeamRuns::along, SeamRuns::across}) {
    const ClothModel plain = build_model(sewn_strip(seam, 0.01, {}), {&fabric, 1}),
                     sewn = build_model(sewn_strip(seam, 0.01, {0, 0, allowance_m, false}), {&fabric, 1});
    const double seam_m = seam == SeamRuns::along ? length_m : width_m;
    const auto mass = [](const ClothModel& model) {
      return std::accumulate(model.mass_kg.begin(), model.mass_kg.end(), 0.0);
    };
    EXPECT_NEAR(mass(sewn) - mass(plain), 2 * allowance_m * seam_m * fabric.density_kg_per_m2, 1e-15);
    double thread_N_m = 0, expected_N_m = 0;  // stretch stiffness times length, of both sides
    for (const EdgeThread& thread : sewn.threads) {
      const auto& uv = sewn.mesh.uv[at(thread.triangle)];
      const double piece_m = (uv[(thread.side + 1U) % 3] - uv[thread.side]).norm();
      thread_N_m += piece_m * thread.stretch_N;
    }
    const double k = seam == SeamRuns::along ? fabric.stretch_u_N_per_m : fabric.stretch_v_N_per_m;
    expected_N_m = 2 * seam_m * allowance_m * k;
    EXPECT_NEAR(thread_N_m, expected_N_m, 1e-9 * expected_N_m);
    EXPECT_TRUE(plain.threads.empty() && plain.line_bends.empty());
  }
}

// Each panel's own: the sides of a seam may be of two cloths, and one side may be without.
TEST(SewnStrip, EitherSideHasItsOwnClothAndWidth) {
  ClothMesh mesh = sewn_strip(SeamRuns::along, 0.01, {0, 0, allowance_m, true});
  std::array<Fabric, 2> fabrics{cloth(), cloth()};
  fabrics[1].density_kg_per_m2 = 0.4;
  std::erase_if(mesh.finished, [&](const FinishedEdge& edge) {
    return std::none_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
      const bool second = mesh.panel[static_cast<std::size_t>(&t - mesh.triangles.data())] == 1;
      return second && ((t[0] == edge.a && t[1] == edge.b) || (t[1] == edge.a && t[2] == edge.b) ||
                        (t[2] == edge.a && t[0] == edge.b));
    });
  });
  ASSERT_EQ(mesh.finished.size(), 20U) << "walked as the second panel's triangles do";
  const ClothModel model = build_model(mesh, fabrics);
  ClothMesh bare_mesh = mesh;
  bare_mesh.finished.clear();
  const ClothModel bare = build_model(bare_mesh, fabrics);
  const auto sum = [](const ClothModel& of) { return std::accumulate(of.mass_kg.begin(), of.mass_kg.end(), 0.0); };
  EXPECT_NEAR(sum(model) - sum(bare), allowance_m * length_m * 0.4, 1e-15);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.panel[t] == 0) {
      EXPECT_EQ(model.plate_compliance[t], bare.plate_compliance[t]);
    }
  }
}

}  // namespace
}  // namespace toile::internal
