#include "core/hash.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string_view>
#include <vector>

namespace toile::internal {
namespace {

std::uint64_t hash_of(std::string_view text) {
  Hash hash;
  hash.add_bytes(text.data(), text.size());
  return hash.value();
}

TEST(Hash, AgreesWithThePublishedVectorsOfFnv1a) {
  EXPECT_EQ(hash_of(""), 0xcbf29ce484222325ULL);
  EXPECT_EQ(hash_of("a"), 0xaf63dc4c8601ec8cULL);
  EXPECT_EQ(hash_of("b"), 0xaf63df4c8601f1a5ULL);
  EXPECT_EQ(hash_of("foobar"), 0x85944171f73967e8ULL);
}

TEST(Hash, OfPiecesIsTheHashOfTheWhole) {
  Hash hash;
  hash.add_bytes("foo", 3);
  hash.add_bytes("bar", 3);
  EXPECT_EQ(hash.value(), hash_of("foobar"));
}

TEST(Hash, IsWrittenInSixteenDigits) {
  EXPECT_EQ(Hash().hex(), "cbf29ce484222325");
  Hash hash;
  hash.add_bytes("foobar", 6);
  EXPECT_EQ(hash.hex(), "85944171f73967e8");
}

TEST(Hash, SeesTheBitsOfNumbers) {
  const auto of = [](std::vector<double> values) {
    Hash hash;
    hash.add(std::span<const double>(values));
    return hash.value();
  };
  EXPECT_NE(of({0.0}), of({-0.0}));
  EXPECT_NE(of({1.0}), of({1.0 + std::numeric_limits<double>::epsilon()}));
  EXPECT_NE(of({1.0, 2.0}), of({2.0, 1.0}));
  EXPECT_EQ(of({1.0, 2.0}), of({1.0, 2.0}));
}

}  // namespace
}  // namespace toile::internal
