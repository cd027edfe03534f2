// The numbers that scripts know.
#include "exit_code.hpp"

#include <gtest/gtest.h>

namespace toile::internal {
namespace {

TEST(ExitCode, NumbersAreTheContractWithScripts) {
  EXPECT_EQ(static_cast<int>(exit_code(ErrorKind::usage)), 2);
  EXPECT_EQ(static_cast<int>(exit_code(ErrorKind::bad_input)), 3);
  EXPECT_EQ(static_cast<int>(exit_code(ErrorKind::bad_start)), 4);
  EXPECT_EQ(static_cast<int>(exit_code(ErrorKind::simulation_failed)), 5);
  EXPECT_EQ(static_cast<int>(exit_code(ErrorKind::io)), 6);
  EXPECT_EQ(static_cast<int>(exit_code(ErrorKind::resource_limit)), 7);
  EXPECT_EQ(static_cast<int>(exit_code(ErrorKind::interrupted)), 8);
  EXPECT_EQ(static_cast<int>(exit_code(ErrorKind::internal)), 9);
}

TEST(ExitCode, OfARunIsItsOutcome) {
  EXPECT_EQ(static_cast<int>(exit_code(Outcome::passed)), 0);
  EXPECT_EQ(static_cast<int>(exit_code(Outcome::failed)), 5);
  EXPECT_EQ(static_cast<int>(exit_code(Outcome::interrupted)), 8);
}

}  // namespace
}  // namespace toile::internal
