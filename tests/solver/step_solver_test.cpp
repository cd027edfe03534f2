// The system of a step in the precision that it needs.
#include "solver/step_solver.hpp"

#include "assembly/elements.hpp"
#include "support/fabrics.hpp"
#include "support/sheets.hpp"

#include <gtest/gtest.h>

#include <array>

namespace toile::internal {
namespace {

// A nearly flat sheet with edges of 5 mm, `times` as stiff as cotton, in a step of 1/30 s.  Nothing pulls it, as it does in crumpled_problem.hpp: with as
// large a load the solve need not be as fine as rounding is.
struct FineSheet {
  explicit FineSheet(double times) : model(make(times)), elements(model), constraints(model.particle_count()) {
    test::Random random(3);
    const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());  // or rounding is seen by few numbers
    state.x = test::crumpled(test::equilateral_sheet(0.1, 0.1, 0.005).x, 3e-5, 1);
    for (std::size_t i = 0; i < state.x.size(); ++i) {
      state.x[i] = turn * state.x[i];
      state.v.push_back(random.vector(0.1));
      reference.push_back(h * model.mass_kg[i] * Vec3(0, -9.81, 0));
      b.push_back(reference[i] + model.mass_kg[i] * random.vector(1));
    }
    elements.evaluate(model, state);
    constraints.hold(0, Vec3::Zero());
  }
  template <class T>
  void fill(BlockMatrix<T>& A) {
    for (Index i = 0; i < A.rows(); ++i) A.grounded(i) = model.mass_kg[static_cast<std::size_t>(i)] * Mat3::Identity();
    elements.assemble(h, A);
  }
  template <class T>
  PcgReport solve(double tolerance, Vec3s& dv) {
    BlockMatrix<T> A(elements.pattern());
    fill(A);
    LinearSystem<T> system(A);
    system.update({}, constraints);
    ModifiedPcg<T> pcg(model.mesh);
    PcgOptions options;
    options.tolerance = tolerance;
    pcg.prepare(system, options);
    dv.assign(b.size(), Vec3::Zero());
    return pcg.solve(system, b, reference, options, dv);
  }
  static ClothModel make(double times) {
    Fabric fabric = test::linear_cotton();
    fabric.shear_N_per_m = 200;  // with less, rounding tells earlier: docs/theory/solver.md
    fabric.stretch_u_N_per_m *= times;
    fabric.stretch_v_N_per_m *= times;
    fabric.bend_u_N_m = fabric.bend_v_N_m = 1e-5;
    ModelOptions hinges;
    hinges.bend_element = BendElement::hinge;
    return build_model(test::equilateral_sheet(0.1, 0.1, 0.005).mesh, std::array{fabric}, hinges);
  }
  static constexpr double h = 1.0 / 30;
  ClothModel model;
  Elements elements;
  ParticleConstraints constraints;
  ClothState state;
  Vec3s b, reference;
};

double difference(const Vec3s& a, const Vec3s& b) {
  double sum = 0, of_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += (a[i] - b[i]).squaredNorm();
    of_b += b[i].squaredNorm();
  }
  return std::sqrt(sum / of_b);
}

TEST(StepSolver, StiffClothIsSolvedInDouble) {
  for (const double times : {1.0, 4.0}) {
    FineSheet sheet(times);
    Vec3s exact, single, dv(sheet.b.size(), Vec3::Zero());
    ASSERT_TRUE(sheet.solve<double>(1e-9, exact));
    const PcgReport in_single = sheet.solve<float>(1e-3, single);
    StepSolver solver(sheet.elements.pattern(), sheet.model.mesh);
    solver.assemble([&](auto& A) { sheet.fill(A); });
    EXPECT_EQ(solver.is_in_double(), times > 1);
    PcgOptions options;
    options.tolerance = 1e-3;
    solver.prepare({}, sheet.constraints, options);
    const PcgReport report = solver.solve(sheet.b, sheet.reference, options, dv);
    EXPECT_TRUE(report) << report.explain();
    EXPECT_LT(difference(dv, exact), 1e-4);
    EXPECT_EQ(static_cast<bool>(in_single), times == 1);  // rounded, A is not positive definite any more
    if (times == 1) {
      EXPECT_EQ(dv, single);
    }
    Vec3s e(dv.size()), product(dv.size());
    solver.multiply_unfiltered(dv, product);
    solver.held_residual(dv, sheet.b, e);
    EXPECT_LT((e[0] - (product[0] - sheet.b[0])).norm(), 1e-7 * e[0].norm());
    EXPECT_EQ(dv[0], Vec3::Zero());
  }
}

}  // namespace
}  // namespace toile::internal
