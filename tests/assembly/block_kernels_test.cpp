#include "assembly/block_kernels.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "assembly/elements.hpp"
#include "support/every_target.hpp"
#include "support/fabrics.hpp"
#include "support/sheets.hpp"

namespace toile::internal {
namespace {

struct Assembled {
  std::vector<Block<float>> below;
  std::vector<Mat3> diagonal;
  Vec3s product;
};

bool same(const void* a, const void* b, std::size_t bytes) { return std::memcmp(a, b, bytes) == 0; }

TEST(BlockKernels, GiveTheSameBitsOnEveryInstructionSet) {
  const test::Sheet sheet = test::equilateral_sheet(0.4, 0.3, 0.02);
  const Fabric fabric = test::linear_cotton();
  const ClothModel model = build_model(sheet.mesh, {&fabric, 1});
  ClothState state{test::crumpled(sheet.x, 0.004, 3), {}};
  test::Random random(4);
  Vec3s x;
  for (std::size_t i = 0; i < sheet.x.size(); ++i) {
    state.v.push_back(random.vector(0.5));
    x.push_back(random.vector(1));
  }
  const auto assemble = [&] {
    Elements elements(model);
    elements.evaluate(model, state);
    BlockMatrix<float> A(elements.pattern());
    for (Index i = 0; i < A.rows(); ++i) A.grounded(i) = model.mass_kg[static_cast<std::size_t>(i)] * Mat3::Identity();
    elements.assemble(1.0 / 60, A);
    Assembled result;
    result.product.resize(x.size());
    A.multiply(x, result.product);
    for (Index i = 0; i < A.rows(); ++i) {
      result.diagonal.push_back(A.diagonal(i));
      EXPECT_EQ(A.multiply_row(i, x), result.product[static_cast<std::size_t>(i)]) << i;
    }
    result.below.assign(A.blocks().begin(), A.blocks().end());
    return result;
  };
  const Assembled widest = assemble();
  const int targets = test::on_every_target([&](const char* name) {
    const Assembled r = assemble();
    EXPECT_TRUE(same(r.below.data(), widest.below.data(), r.below.size() * sizeof r.below[0])) << name;
    EXPECT_TRUE(same(r.diagonal.data(), widest.diagonal.data(), r.diagonal.size() * sizeof r.diagonal[0])) << name;
    EXPECT_TRUE(same(r.product.data(), widest.product.data(), r.product.size() * sizeof r.product[0])) << name;
  });
  EXPECT_GE(targets, 2);
}

// In single precision as in double, but for the rounding of blocks; diagonals are minus the sums of what was rounded.
TEST(BlockKernels, AgreeWithTheMatrixInDouble) {
  const test::Sheet sheet = test::equilateral_sheet(0.3, 0.3, 0.03);
  const Fabric fabric = test::linear_cotton();
  const ClothModel model = build_model(sheet.mesh, {&fabric, 1});
  ClothState state{test::crumpled(sheet.x, 0.006, 5), Vec3s(sheet.x.size(), Vec3::Zero())};
  Elements elements(model);
  elements.evaluate(model, state);
  BlockMatrix<float> A(elements.pattern());
  BlockMatrix<double> B(elements.pattern());
  for (Index i = 0; i < A.rows(); ++i)
    A.grounded(i) = B.grounded(i) = model.mass_kg[static_cast<std::size_t>(i)] * Mat3::Identity();
  elements.assemble(1.0 / 30, A);
  elements.assemble(1.0 / 30, B);
  for (Slot s = 0; s < A.pattern().block_count(); ++s) {
    const Mat3 wanted = B.below(s).to_mat3();
    EXPECT_LE((A.below(s).to_mat3() - wanted).norm(), 1e-7 * wanted.norm()) << s;
    EXPECT_EQ(A.below(s).c0[3], 0);
    EXPECT_EQ(A.below(s).c1[3], 0);
    EXPECT_EQ(A.below(s).c2[3], 0);
  }
  const Eigen::MatrixXd dense = A.to_dense();
  for (Index i = 0; i < A.rows(); ++i) {
    Mat3 sum = Mat3::Zero();
    for (Index j = 0; j < A.rows(); ++j)
      if (j != i) sum += dense.block<3, 3>(3 * i, 3 * j);
    EXPECT_LE((A.diagonal(i) - (A.grounded(i) - sum)).norm(), 1e-13 * A.diagonal(i).norm()) << i;
  }
}

}  // namespace
}  // namespace toile::internal
