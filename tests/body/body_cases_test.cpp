// Bodies after public reports of people's files: each loads, is mended and says so, or is refused with the true reason.
#include "body/collision_body.hpp"

#include "core/error.hpp"
#include "io/mesh_file.hpp"
#include "mesh/check.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace toile::internal {
namespace {

struct Case {
  const char* folder;
  std::size_t vertices;  // 0: refused
  const char* says;      // in a note, or in the refusal; "": there is no note
};

void PrintTo(const Case& one, std::ostream* out) { *out << one.folder; }

class BodyCases : public testing::TestWithParam<Case> {};

TEST_P(BodyCases, HasItsOutcome) {
  const auto& [folder, vertices, says] = GetParam();
  const std::string path = test::shared_path("../cases/") + folder + "/body.obj";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "needs " << path;
  if (vertices == 0) {
    try {
      make_collision_body(load_mesh(path), path, LengthUnit::automatic);
      FAIL() << "was taken";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
    }
    return;
  }
  const CollisionBody body = make_collision_body(load_mesh(path), path, LengthUnit::automatic);
  EXPECT_EQ(body.positions.size(), vertices);
  EXPECT_NO_THROW(check_closed(path, body.positions, body.triangles));
  std::string notes;
  for (const std::string& note : body.notes) notes += note + '\n';
  if (*says == '\0')
    EXPECT_EQ(notes, "");
  else
    EXPECT_NE(notes.find(says), std::string::npos) << notes;
}

constexpr std::size_t whole_triangles = 338;
const Case cases[] = {
    {"o00-plain", whole_triangles, ""},
    {"o01-bom-crlf", whole_triangles, ""},
    {"o02-cr-only", whole_triangles, ""},
    {"o03-negative", whole_triangles, ""},
    {"o04-exponent-colour", whole_triangles, ""},
    {"o05-names", whole_triangles, ""},
    {"o06-nan-vt", whole_triangles, "skipped 1 texture coordinates that are no numbers"},
    {"o07-lines", whole_triangles, "skipped 1 faces of fewer than three corners"},
    {"o08-unknown-keyword", whole_triangles, "skipped 2 lines of statements that OBJ does not have"},
    {"o09-comma", 0, "a decimal point, not a comma"},
    {"o10-mm", 0, "--body-unit mm if the body is 1.70 m tall"},
    {"o11-inch", 0, "--body-unit in if the body is 1.70 m tall, or cm"},
    {"o12-zup", whole_triangles, "z is up in it: turned"},
    {"o13-upside-down", whole_triangles, "it may stand on its head"},
    {"o14-uv-split", whole_triangles, "60 vertices lie where another one does"},
    {"o15-soup", whole_triangles, "1678 vertices lie where another one does"},
    {"o16-open-neck", 289, "1 hole (0.424 m round at "},
    {"o17-inside-out", whole_triangles, "all triangles are turned: it was inside out"},
    {"o18-one-flipped", whole_triangles, "2 triangles are turned to face outwards"},
    {"o19-degenerate", whole_triangles, "1 triangles with a corner twice are gone"},
    {"o20-duplicate-face", whole_triangles, "2 triangles that were there before are gone"},
    {"o21-inner-wall", whole_triangles, "22 triangles of walls inside are gone"},
    {"o22-extra-shells", whole_triangles, "of 3 vertices (hair_card) left out"},
    {"o23-parts", 366, ""},
    {"o24-body-group-partial", whole_triangles, "taken with what it hangs together with (Body, Head)"},
    {"o25-huge-offset", whole_triangles, ""},
    {"o26-below-floor", whole_triangles, ""},
    {"o27-child", whole_triangles, ""},
    {"o28-named-body-drops-legs", 364, "the name is not followed"},
};
INSTANTIATE_TEST_SUITE_P(, BodyCases, testing::ValuesIn(cases), [](const auto& one) {
  std::string name = one.param.folder;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace toile::internal
