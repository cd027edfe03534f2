#include "core/error.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace toile::internal {
namespace {

std::string_view nearest(std::string_view name, const std::vector<std::string_view>& names) {
  return nearest_name(name, names.data(), names.size());
}

TEST(InputError, ReadsAsFilePlaceExpectedGot) {
  const InputError error("scene.json:14:22", "/cloth/0/density_kg_per_m2", "a finite number > 0", "-0.2");
  EXPECT_STREQ(error.what(), "scene.json:14:22: /cloth/0/density_kg_per_m2: expected a finite number > 0, got -0.2");
  EXPECT_EQ(error.kind(), ErrorKind::bad_input);
}

TEST(InputError, LeavesOutWhatIsNotKnown) {
  EXPECT_STREQ(InputError("", "edge 3-7", "a", "b").what(), "edge 3-7: expected a, got b");
  EXPECT_STREQ(InputError("a.obj", "", "a", "b").what(), "a.obj: expected a, got b");
  EXPECT_STREQ(InputError("", "", "a", "b").what(), "expected a, got b");
}

TEST(InputError, KnowsWhatOfTheModelItIsAboutAndSaysNoMoreOfIt) {
  const InputError error = InputError("", "to_m", "a", "b").of("/solids/0");
  EXPECT_STREQ(error.what(), "to_m: expected a, got b");
  EXPECT_EQ(error.path(), "/solids/0");
  EXPECT_EQ(error.place() + '|' + error.expected() + '|' + error.got(), "to_m|a|b");
  EXPECT_EQ(error.within("sheet").path(), "/solids/0");
}

TEST(InputError, KnowsTheFileThatItsMessageBeginsWith) {
  EXPECT_EQ(InputError("p.json:3:4", "/x", "a", "b").where(), "p.json:3:4");
  EXPECT_EQ(InputError("", "uv_m", "a", "b").within("sheet").where(), "sheet");
  EXPECT_EQ(InputError("line 3", "uv_m", "a", "b").within("a.obj").where(), "a.obj: line 3");
}

TEST(InputError, IsOfAFileThatItDoesNotNameItself) {
  EXPECT_STREQ(InputError("", "uv_m", "a", "b").within("sheet").what(), "sheet: uv_m: expected a, got b");
  EXPECT_STREQ(InputError("p.json:3:4", "/x", "a", "b").within("p.json").what(), "p.json:3:4: /x: expected a, got b");
  EXPECT_EQ(InputError("", "uv_m", "a", "b").within("sheet").kind(), ErrorKind::bad_input);
}

TEST(IoError, NamesThePathAndTheReason) {
  const IoError error("out/cloth.pc2", "cannot write: No space left on device");
  EXPECT_STREQ(error.what(), "out/cloth.pc2: cannot write: No space left on device");
  EXPECT_EQ(error.kind(), ErrorKind::io);
}

TEST(IoError, KeepsControlCharactersOfAPathOutOfTheLog) {
  EXPECT_STREQ(IoError("a\nb\x1b[31m.obj", "x").what(), "a?b?[31m.obj: x");
}

TEST(Printable, ReplacesControlCharactersAndKeepsTheRest) {
  EXPECT_EQ(printable("a\tb\nc\x7f"), "a?b?c?");
  EXPECT_EQ(printable("\xc3\xa4rmel"), "\xc3\xa4rmel");
  EXPECT_EQ(printable(std::string_view("\0", 1)), "?");
}

TEST(Printable, CutsWhatIsTooLongForALine) {
  EXPECT_EQ(printable(std::string(200, 'x')), std::string(200, 'x'));
  EXPECT_EQ(printable(std::string(201, 'x')), std::string(200, 'x') + "...");
}

TEST(NearestName, IsTheOneWithTheFewestEdits) {
  const std::vector<std::string_view> names = {"gravity_m_per_s2", "wind_m_per_s", "air_density_kg_per_m3"};
  EXPECT_EQ(nearest("wind_m_s", names), "wind_m_per_s");
  EXPECT_EQ(nearest("gravity", names), "gravity_m_per_s2");
  EXPECT_EQ(nearest("airdensity_kg_per_m3", names), "air_density_kg_per_m3");
}

TEST(NearestName, CountsInsertionsDeletionsAndSubstitutionsAlike) {
  EXPECT_EQ(nearest("silk", {"milk", "silky soft"}), "milk");   // 1 substitution against 6 insertions
  EXPECT_EQ(nearest("kitten", {"sitting", "kit"}), "sitting");  // 3 against 3: the first wins
  EXPECT_EQ(nearest("kitten", {"sittings", "kit"}), "kit");     // 4 against 3
  EXPECT_EQ(nearest("", {"abc", "ab"}), "ab");
}

TEST(NearestName, IsEmptyWithoutCandidates) { EXPECT_EQ(nearest("wind", {}), ""); }

TEST(Printable, IsUtf8WhateverTheBytes) {
  EXPECT_EQ(printable("\xc3\xa4 \xe2\x82\xac \xf0\x9f\x91\x95"), "\xc3\xa4 \xe2\x82\xac \xf0\x9f\x91\x95");
  EXPECT_EQ(printable("a\xfdz\xc3"), "a?z?");
  EXPECT_EQ(printable("\xc0\xaf\xed\xa0\x80\xf5\x80"), "???????") << "overlong, a surrogate, beyond Unicode";
  const std::string cut = printable(std::string(199, 'a') + "\xc3\xa4");
  EXPECT_EQ(cut, std::string(199, 'a') + "...") << "no half of a character";
}

}  // namespace
}  // namespace toile::internal
