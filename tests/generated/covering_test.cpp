// Every pair of features of a scene that can meet is in one of the first scenes, and the same number gives the same scene.
#include "generated/scene_generator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

namespace toile::internal::generated {
namespace {

constexpr std::uint64_t in_make_test = 150;

TEST(GeneratedScenes, HaveEveryPairOfFeatures) {
  const Space& space = scene_space();
  const std::vector<ValuePair> possible = possible_pairs(space);
  std::vector<Choice> rows;
  for (std::uint64_t k = 0; k < in_make_test; ++k) rows.push_back(generate_scene(k).choice);
  for (const Choice& row : rows) EXPECT_TRUE(space.is_allowed(row)) << describe(row);
  const std::vector<ValuePair> missing = missing_pairs(space, possible, rows);
  EXPECT_TRUE(missing.empty()) << missing.size() << " pairs are missing";
  RecordProperty("pairs", static_cast<int>(possible.size()));
  std::printf("%zu features, %zu values, %zu pairs in %zu scenes\n", space.axes().size(), space.value_count(),
              possible.size(), rows.size());
  EXPECT_GT(possible.size(), 9000u);
}

// Whatever may meet by the exclusions alone does: no value is barred by others in silence.
TEST(GeneratedScenes, LeaveOutWhatIsExcludedAlone) {
  const Space& space = scene_space();
  std::size_t excluded = 0, all = 0;
  for (std::size_t j = 0; j < space.axes().size(); ++j)
    for (std::size_t k = j + 1; k < space.axes().size(); ++k)
      for (std::size_t a = 0; a < space.axes()[j].values.size(); ++a)
        for (std::size_t b = 0; b < space.axes()[k].values.size(); ++b) {
          ++all;
          if (!space.may_meet(space.number(j, a), space.number(k, b))) ++excluded;
        }
  const std::size_t possible = possible_pairs(space).size();
  EXPECT_LE(possible, all - excluded);
  EXPECT_GT(possible, (all - excluded) * 95 / 100) << all - excluded;
}

TEST(GeneratedScenes, AreTheSameFromTheSameNumber) {
  for (const std::uint64_t number : {0u, 77u, 140u, 4711u}) {
    EXPECT_EQ(generate_scene(number).scene, generate_scene(number).scene);
    EXPECT_NE(generate_scene(number).scene, generate_scene(number + 1).scene);
  }
  std::set<std::string> different;
  for (std::uint64_t k = 1000; k < 1200; ++k) different.insert(generate_scene(k).scene);
  EXPECT_EQ(different.size(), 200u);
}

// Of three axes of which two exclude each other in part.
TEST(Covering, RowsHaveAllPairsThatCanMeetAndNoOther) {
  const Space space({{"a", {"0", "1", "2"}}, {"b", {"0", "1"}}, {"c", {"0", "1", "2"}}},
                    {{"a", {"1", "2"}, "b", {"1"}}});
  const std::vector<ValuePair> possible = possible_pairs(space);
  EXPECT_EQ(possible.size(), 3u * 2 + 3u * 3 + 2u * 3 - 2);
  std::vector<Choice> rows = covering_rows(space);
  for (const Choice& row : rows) EXPECT_TRUE(space.is_allowed(row));
  EXPECT_TRUE(missing_pairs(space, possible, rows).empty());
  EXPECT_LE(rows.size(), 12u);
  rows.pop_back();
  EXPECT_FALSE(missing_pairs(space, possible, rows).empty()) << "the last row was needed";
}

}  // namespace
}  // namespace toile::internal::generated
