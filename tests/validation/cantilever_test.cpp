// The heavy cantilever: strips of cloth against the elastica, and the textile standard that is built on it.
//
//   Gamma = rho g L^3 / D,  H/W: drop over reach of the tip         Romero et al. 2021, "Physical validation of simulators in computer
//   graphics"; ASTM D1388: at a chord of 41.5 degrees the bending length is half the overhang, D = rho g (L/2)^3
#include "validation/cantilever.hpp"
#include "material/bend_hysteresis.hpp"
#include "support/fabrics.hpp"

namespace toile::internal {
namespace {

using test::clamped_strip;
using test::Elastica;
using test::elastica;
using test::elastica_of;
using test::Figures;
using test::gamma_of_chord;
using test::Sag;
using test::Strip;
using test::StripMesh;

constexpr int edges_40 = 46;  // rows of triangles whose edge is L/40
constexpr double density = 0.15, weight = density * 9.81, length = 0.2;
constexpr double degree = 3.14159265358979323846 / 180, standard_rad = 41.5 * degree;  // the chord of ASTM D1388

Fabric of_rigidity(double D_u, double D_v) {
  Fabric fabric = test::elastic_cotton();
  fabric.density_kg_per_m2 = density;
  fabric.bend_u_N_m = D_u;
  fabric.bend_v_N_m = D_v;
  fabric.bend_poisson = 0;  // one rigidity, whether a strip may curl across or not
  return fabric;
}

double chord(StripMesh mesh, int rows, double D, BendElement element = BendElement::plate) {
  const Sag tip = sag(clamped_strip(mesh, length, rows), of_rigidity(D, D), element);
  return tip.H_m / tip.W_m;
}

TEST(Elastica, IsThatOfTheTable) {
  // Boundary value problem solved by collocation to 1e-8, and the small deflections of a beam.
  for (const auto& [gamma, H, W, tip_deg] : {std::array{0.5, 0.06231, 0.99778, 4.763},
                                             {5.0, 0.49591, 0.84666, 39.93},
                                             {50.0, 0.90792, 0.24501, 87.46},
                                             {1000.0, 0.98114, 0.04599, 90.0}}) {
    const Elastica e = elastica(gamma);
    EXPECT_NEAR(e.H, H, 1.1e-5) << gamma;
    EXPECT_NEAR(e.W, W, 1.1e-5) << gamma;
    EXPECT_NEAR(e.tip_rad * 180 / 3.14159265358979323846, tip_deg, 6e-3) << gamma;
    EXPECT_NEAR(gamma_of_chord(e.H / e.W) / gamma, 1, 1e-6) << gamma;
  }
  EXPECT_NEAR(elastica(1e-3).H, 1e-3 / 8, 1e-9);
}

TEST(Cantilever, BendsAsTheElasticaWithinTwoPercent) {
  Figures figures("cantilever");
  for (const double gamma : {1.0, 5.0, 10.0, 50.0}) {
    const Elastica e = elastica(gamma);
    const double D = weight * length * length * length / gamma;
    const std::string name = "Gamma " + std::to_string(static_cast<int>(gamma));
    for (const StripMesh mesh : {StripMesh::rows_across, StripMesh::mesher_15}) {
      const double measured = chord(mesh, edges_40, D);
      figures.add(name, std::string(to_string(mesh)) + " L/40", "H/W", e.H / e.W, measured);
      EXPECT_NEAR(measured / (e.H / e.W), 1, 0.02) << gamma << ", " << to_string(mesh);
    }
    const double hinges = chord(StripMesh::rows_across, edges_40, D / test::strip_rigidity_middle(test::nu_of_hinges),
                                BendElement::hinge);
    figures.add(name, "equilateral L/40, hinges", "H/W", e.H / e.W, hinges);
    EXPECT_NEAR(hinges / (e.H / e.W), 1, 0.03) << gamma;
  }
}

TEST(Cantilever, WithAPoissonRatioLiesBetweenCurlingFreelyAndNotAtAll) {
  constexpr double nu = 0.4, gamma = 5, D = weight * length * length * length / gamma;
  Fabric fabric = of_rigidity(D, D);
  fabric.bend_poisson = nu;
  const Sag tip = sag(clamped_strip(StripMesh::rows_across, length, edges_40), fabric);
  const Elastica stiff = elastica(gamma), soft = elastica(gamma / test::strip_rigidity_low(nu));
  EXPECT_GT(tip.H_m / tip.W_m, 0.99 * stiff.H / stiff.W);
  EXPECT_LT(tip.H_m / tip.W_m, 1.01 * soft.H / soft.W);
}

TEST(Cantilever, ReachesTheStandardsChordAtTwiceItsBendingLength) {
  // H/W = tan 41.5 degrees at Gamma = 8.004: the standard's rule and the elastica are one.
  EXPECT_NEAR(gamma_of_chord(std::tan(standard_rad)), 8, 0.01);
  Figures figures("bending_length");
  const double D = weight * std::pow(length / 2, 3);
  const double measured = chord(StripMesh::rows_across, edges_40, D);
  figures.add("ASTM D1388", "equilateral L/40", "chord deg", 41.5, std::atan(measured) / degree);
  EXPECT_NEAR(std::atan(measured) / degree, 41.5, 0.8);
}

TEST(CantileverLong, FollowsTheWholeCurveOnEveryMesh) {
  Figures figures("cantilever_curve");
  for (const StripMesh mesh :
       {StripMesh::rows_across, StripMesh::rows_along, StripMesh::mesher, StripMesh::mesher_15, StripMesh::mesher_30}) {
    for (const double gamma : {0.1, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 1000.0}) {
      const double measured = chord(mesh, edges_40, weight * length * length * length / gamma);
      const Elastica e = elastica(gamma);
      char name[32];
      std::snprintf(name, sizeof name, "Gamma %g", gamma);
      figures.add(name, std::string(to_string(mesh)) + " L/40", "H/W", e.H / e.W, measured);
      // At 1000 only four cells bend, and a lattice whose columns do not line up at the clamp misses by a fifth: reported.
      if (mesh == StripMesh::rows_along && gamma > 500) continue;
      EXPECT_NEAR(measured / (e.H / e.W), 1, gamma > 500 ? 0.03 : 0.02) << to_string(mesh) << ", Gamma " << gamma;
    }
  }
}

TEST(CantileverLong, ComesNearerTheElasticaOnFinerMeshes) {
  Figures figures("cantilever_refined");
  for (const StripMesh mesh : {StripMesh::rows_across, StripMesh::mesher, StripMesh::mesher_30}) {
    for (const int edges : {20, 40, 60}) {
      const int rows = static_cast<int>(std::lround(edges * 2 / std::sqrt(3.0)));
      for (const double gamma : {5.0, 50.0}) {
        const Elastica e = elastica(gamma);
        const double measured = chord(mesh, rows, weight * length * length * length / gamma);
        char name[32];
        std::snprintf(name, sizeof name, "Gamma %g", gamma);
        figures.add(name, std::string(to_string(mesh)) + " L/" + std::to_string(edges), "H/W", e.H / e.W, measured);
      }
    }
  }
}

TEST(CantileverLong, BendsBothThreadsAsAskedFor) {
  Figures figures("cantilever_anisotropic");
  constexpr double gamma = 10;  // of the thread that runs along the strip
  const double D = weight * length * length * length / gamma;
  for (const StripMesh mesh : {StripMesh::rows_across, StripMesh::mesher_15}) {
    for (const double ratio : {1.0, 5.0, 20.0}) {
      for (const bool along_warp : {true, false}) {
        const Fabric fabric = along_warp ? of_rigidity(D, D / ratio) : of_rigidity(D * ratio, D);
        double realised[2];
        for (const int finer : {1, 2}) {
          const Sag tip = sag(clamped_strip(mesh, length, finer * edges_40, along_warp), fabric);
          realised[finer - 1] = gamma / gamma_of_chord(tip.H_m / tip.W_m);
        }
        char name[32];
        std::snprintf(name, sizeof name, "%g : 1 along %s", ratio, along_warp ? "warp" : "weft");
        figures.add(name, std::string(to_string(mesh)) + " L/40", "D realised / asked", 1, realised[0]);
        figures.add(name, std::string(to_string(mesh)) + " L/80", "D realised / asked", 1, realised[1]);
        // Where the soft thread is held the clamp gives way by a part of a row: the error is of first order.
        EXPECT_NEAR(realised[0], 1, ratio > 10 ? 0.06 : 0.03) << name << ", " << to_string(mesh);
        EXPECT_NEAR(2 * realised[1] - realised[0], 1, 0.02) << name << ", " << to_string(mesh);
      }
    }
  }
}

// The chord of a strip of the fabric, rad.  Bent one way only, threads that rub hold the moment D_f kappa up to kappa_y and D_f kappa_y
// beyond it (docs/theory/bend.md#bends-that-stay), D_f = (stiffening - 1) D.  Curling freely across, with S_vv = -nu S_uu, its moments are
// those of D (1 - nu^2), and |S| reaches kappa_y sooner.
double chord_of_elastica(const Fabric& fabric, double D, double overhang_m, bool curls) {
  const double nu = curls ? fabric.bend_poisson : 0, stiffening = friction_stiffening(fabric);
  const double elastic = D * (1 - nu * nu), rubbing = (stiffening - 1) * elastic;
  const double kappa_y = fabric.bend_friction_curvature_per_m / std::sqrt(1 + nu * nu);
  const double unit_N = fabric.density_kg_per_m2 * 9.81 * overhang_m * overhang_m;
  const Elastica e = elastica_of([&](double M) {
    const double kappa = M * unit_N / (elastic + rubbing);
    return overhang_m * (kappa < kappa_y ? kappa : (M * unit_N - rubbing * kappa_y) / elastic);
  });
  return std::atan2(e.H, e.W);
}

TEST(CantileverLong, MeasuresTheFabricsAsALaboratoryWould) {
  Figures figures("bending_length_fabrics");
  for (const Fabric& fabric : fabric_presets()) {
    for (const bool along_warp : {true, false}) {
      const double D = along_warp ? fabric.bend_u_N_m : fabric.bend_v_N_m;
      double low = 0.01, high = 1;
      for (int n = 0; n < 40; ++n) {
        const double middle = std::sqrt(low * high);
        (chord_of_elastica(fabric, D, middle, false) < standard_rad ? low : high) = middle;
      }
      const double overhang_m = low, bending_length_m = overhang_m / 2;
      const auto chord_deg = [&](const Fabric& of) {
        const Sag tip = sag(clamped_strip(StripMesh::rows_across, overhang_m, edges_40, along_warp), of);
        return std::atan2(tip.H_m, tip.W_m) / degree;
      };
      Fabric without_poisson = fabric;
      without_poisson.bend_poisson = 0;
      const double measured = chord_deg(fabric);
      const std::string strip = fabric.name + (along_warp ? " warp" : " weft");
      figures.add(strip, "equilateral L/40", "chord deg", 41.5, measured);
      figures.add(strip, "equilateral L/40", "bending length cm", Figures::no_reference, 100 * bending_length_m);
      if (fabric.bend_friction_N == 0) {
        EXPECT_NEAR(bending_length_m / std::cbrt(D / (fabric.density_kg_per_m2 * 9.81)), 1, 1e-3) << strip;
      }
      EXPECT_NEAR(chord_deg(without_poisson), 41.5, 0.3) << strip;
      EXPECT_GT(measured, 41.5 - 0.3) << strip;
      EXPECT_LT(measured, chord_of_elastica(fabric, D, overhang_m, true) / degree + 0.3) << strip;
    }
  }
}

}  // namespace
}  // namespace toile::internal
