// Additive CCD against published queries: every one of them, and the oracle itself against their ground truth.
#include "contact/ccd_count.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

namespace toile::internal {
namespace {

using namespace ccd_test;

// A whole number that is a double: read, and written again to be sure of it.
double whole(const std::string& text) {
  double value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  std::array<char, 400> again{};
  const auto written = std::to_chars(again.data(), again.data() + again.size(), value, std::chars_format::fixed, 0);
  if (std::string(again.data(), written.ptr) != text) ADD_FAILURE() << text << " is not a double";
  return value;
}

// numerator / denominator, which is a double: the denominator is a power of two.
double ratio(const std::string& numerator, const std::string& denominator) {
  const double d = whole(denominator);
  int exponent = 0;
  if (std::frexp(d, &exponent) != 0.5) ADD_FAILURE() << denominator << " is not a power of two";
  return std::ldexp(whole(numerator), 1 - exponent);
}

struct PublicQuery {
  Motion motion;
  bool touches = false;  // the ground truth
};

std::vector<PublicQuery> read_queries(const std::filesystem::path& path, Features features) {
  std::ifstream file(path);
  std::vector<PublicQuery> queries;
  std::string line;
  for (std::size_t row = 0; std::getline(file, line); ++row) {
    if (row % 8 == 0) queries.push_back({Motion(features), false});
    std::array<std::string, 7> cell;
    std::istringstream cells(line);
    for (std::string& c : cell) std::getline(cells, c, ',');
    PublicQuery& query = queries.back();
    Vec3& point = row % 8 < 4 ? query.motion.start[row % 8] : query.motion.end[row % 8 - 4];
    for (std::size_t k = 0; k < 3; ++k) point[static_cast<int>(k)] = ratio(cell[2 * k], cell[2 * k + 1]);
    query.touches = cell[6].front() == '1';
  }
  return queries;
}

TEST(CcdPublicQueries, NoneIsMissedAndTheOracleAgreesWithTheirGroundTruth) {
  const std::filesystem::path folder(test::shared_path("ccd"));
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << folder << " is absent";
  Count all;
  std::size_t disagreements = 0;
  for (const Features features : {Features::vertex_face, Features::edge_edge}) {
    Count of_features;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
      if (entry.path().extension() == ".csv" &&
          (entry.path().parent_path().filename() == "edge-edge") == (features == Features::edge_edge))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const std::filesystem::path& path : files) {
      for (const PublicQuery& query : read_queries(path, features)) {
        of_features.add(query.motion, touch_of(query.motion));
        if (exact::ExactTouch(query.motion).touches() != query.touches) ++disagreements;
        if (touch_of(query.motion).touches != query.touches) ++disagreements;
      }
    }
    std::cout << of_features.text(features == Features::edge_edge ? "edge-edge" : "vertex-face") << '\n';
    all.add(of_features);
  }
  EXPECT_GE(all.queries, 4884);
  EXPECT_EQ(disagreements, 0);
  EXPECT_EQ(all.false_negatives, 0);
  EXPECT_EQ(all.late, 0);
}

}  // namespace
}  // namespace toile::internal
