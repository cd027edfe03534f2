// Patterns made from our own good ones by one fault each: the linter names the fault and its place, and mends it or says why not.
#include "broken_patterns.hpp"
#include "garment/garment_mesh.hpp"
#include "garment/pattern_svg.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace toile::internal {
namespace {

using test::BrokenPattern;
using test::PatternFile;

const LintFinding* find(const LintReport& report, std::string_view code) {
  for (const LintFinding& finding : report.findings)
    if (finding.code == code) return &finding;
  return nullptr;
}

std::string findings_of(const LintReport& report) {
  std::string text;
  for (const LintFinding& f : report.findings)
    text += std::string(to_string(f.severity)) + " " + std::string(f.code) + ": " + f.place + ": expected " +
            f.expected + ", got " + f.got + "; " + f.repair + "\n";
  return text;
}

// Middles of all edges as placed.
std::vector<Vec3> placed_edges(const Pattern& pattern) {
  std::vector<Vec3> middles;
  for (const Panel& panel : pattern.panels)
    for (const PanelEdge& edge : panel.edges) middles.push_back(panel.place(sample_edge(panel, edge, 2)[1]));
  return middles;
}

// For each seam, where its two middles are: of the stitch as a pair without order.
std::vector<std::pair<Vec3, Vec3>> placed_seams(const Pattern& pattern) {
  std::vector<std::pair<Vec3, Vec3>> seams;
  const auto middle = [&](const StitchSide& side) {
    const Panel& panel = pattern.panels[static_cast<std::size_t>(side.panel)];
    return panel.place(sample_edge(panel, panel.edges[static_cast<std::size_t>(side.edge)], 2)[1]);
  };
  for (const Stitch& stitch : pattern.stitches) seams.emplace_back(middle(stitch.a), middle(stitch.b));
  return seams;
}

void expect_same_garment(const Pattern& good, const Pattern& mended) {
  constexpr double tolerance_m = 0.001;  // half of the widest gap that is closed here
  const std::vector<Vec3> before = placed_edges(good), after = placed_edges(mended);
  ASSERT_EQ(before.size(), after.size());
  for (const Vec3& p : before)
    EXPECT_TRUE(std::any_of(after.begin(), after.end(), [&](const Vec3& q) { return (p - q).norm() < tolerance_m; }))
        << p.transpose();
  const auto seams = placed_seams(good), mended_seams = placed_seams(mended);
  ASSERT_EQ(seams.size(), mended_seams.size());
  for (const auto& [a, b] : seams)
    EXPECT_TRUE(std::any_of(mended_seams.begin(), mended_seams.end(), [&a = a, &b = b](const auto& seam) {
      return std::min((a - seam.first).norm() + (b - seam.second).norm(),
                      (a - seam.second).norm() + (b - seam.first).norm()) < 2 * tolerance_m;
    })) << a.transpose();
}

void expect_told(const BrokenPattern& broken) {
  SCOPED_TRACE(broken.name + " of " + broken.garment);
  PatternFile file(broken.garment);
  const Pattern good = parse_pattern(to_text(file.root), "good.json");
  broken.break_it(file);
  const std::string text = to_text(file.root);
  const LintReport report = lint_pattern(text, "broken.json", broken.body);
  const LintFinding* finding = find(report, broken.code);
  ASSERT_NE(finding, nullptr) << "not found; told instead:\n" << findings_of(report);
  EXPECT_EQ(finding, report.findings.data()) << "not told first:\n" << findings_of(report);
  EXPECT_EQ(finding->severity, broken.severity) << findings_of(report);
  EXPECT_NE(finding->place.find(broken.place), std::string::npos) << finding->place;
  EXPECT_EQ(finding->where.rfind("broken.json:", 0), 0U) << finding->where;
  EXPECT_FALSE(finding->pointer.empty());
  EXPECT_FALSE(finding->expected.empty() || finding->got.empty());
  EXPECT_EQ(finding->mended, broken.mended) << findings_of(report);
  EXPECT_EQ(finding->repair.rfind("refused: ", 0) == 0, !broken.mended) << finding->repair;
  // An error is what the reader or the mesher refuses, and nothing else.
  std::string refused;
  try {
    mesh_garment(parse_pattern(text, "broken.json"), 0.04);
  } catch (const InputError& error) {
    refused = error.what();
  }
  EXPECT_EQ(report.has_errors(), !refused.empty()) << refused << "\n" << findings_of(report);
  EXPECT_EQ(draw_pattern(report.drawing, report.findings), draw_pattern(report.drawing, report.findings));
  if (!broken.mended) {
    EXPECT_TRUE(report.mended_text.empty()) << findings_of(report);
    return;
  }
  ASSERT_TRUE(report.usable) << findings_of(report);
  const LintReport again = lint_pattern(report.mended_text, "mended.json", broken.body);
  EXPECT_TRUE(again.findings.empty()) << findings_of(again);
  const Pattern mended = parse_pattern(report.mended_text, "mended.json");
  EXPECT_NO_THROW(mesh_garment(mended, 0.04));
  if (broken.as_before) expect_same_garment(good, mended);
}

TEST(LintBroken, NamesFaultAndPlaceAndMendsItOrSaysWhyNot) {
  const std::vector<BrokenPattern> all = test::broken_patterns();
  EXPECT_GE(all.size(), 60U);
  for (const BrokenPattern& broken : all) expect_told(broken);
}

TEST(LintBroken, EveryKindIsMadeFromTwoGarments) {
  std::set<std::pair<std::string_view, std::string>> kinds;
  std::set<std::string_view> codes;
  for (const BrokenPattern& broken : test::broken_patterns()) {
    kinds.insert({broken.code, broken.garment});
    codes.insert(broken.code);
  }
  codes.erase(reason::no_way_for_foot);  // one of our garments has legs
  for (const std::string_view code : codes) {
    const auto garments =
        std::count_if(kinds.begin(), kinds.end(), [&](const auto& kind) { return kind.first == code; });
    EXPECT_GE(garments, 2) << code;
  }
}

TEST(LintBroken, MendsSeveralFaultsOfOneFile) {
  PatternFile file("tshirt");
  const Pattern good = parse_pattern(to_text(file.root), "good.json");
  file.turn_edge("front", 1);           // against the others
  file.open_corner("back", 3, 0.1, 0);  // a gap of a millimetre
  file.corners("left_sleeve_front").push_back(PatternFile::point(3, 3));
  file.stitches()[4].array()->emplace_back(std::string("right_wrong"));
  file.root.member("pattern").member("designer") = JsonValue(std::string("K\xc3\xa4the"));
  const LintReport report = lint_pattern(to_text(file.root), "broken.json");
  for (const std::string_view code :
       {reason::loop_reversed, reason::loop_open, reason::corner_unused, reason::seam_twisted}) {
    const LintFinding* finding = find(report, code);
    ASSERT_NE(finding, nullptr) << code << "\n" << findings_of(report);
    EXPECT_TRUE(finding->mended) << code;
  }
  EXPECT_EQ(report.findings.size(), 4U) << findings_of(report);
  EXPECT_TRUE(report.usable);
  EXPECT_NE(report.mended_text.find("\"designer\": \"K\xc3\xa4the\""), std::string::npos) << "others' keys stay";
  expect_same_garment(good, parse_pattern(report.mended_text, "mended.json"));
}

TEST(LintBroken, NumbersWithoutMeasureAreToldAndNotMeasured) {
  const std::vector<std::function<void(PatternFile&)>> breaks = {
      [](PatternFile& f) { f.corners("front")[4] = PatternFile::point(1e300, -1e300); },
      [](PatternFile& f) {
        f.corners("front")[5] = PatternFile::point(1e300, 1e12);
        f.turn_edge("front", 0);
      },
      [](PatternFile& f) {
        PatternFile::number(
            f.edges("front")[2].member("curvature").member("params").array()->front().array()->front()) = 1e250;
      },
      [](PatternFile& f) { PatternFile::number((*f.panel("front").member("translation").array())[0]) = 1e200; },
      [](PatternFile& f) { f.set_units(1e-200); },
      [](PatternFile& f) { f.set_units(1e200); },
  };
  for (std::size_t k = 0; k < breaks.size(); ++k) {
    PatternFile file("tshirt");
    breaks[k](file);
    const LintReport report = lint_pattern(to_text(file.root), "p.json");
    EXPECT_TRUE(report.has_errors()) << k << findings_of(report);
    EXPECT_LT(draw_pattern(report.drawing, report.findings).size(), 1'000'000U) << k;
  }
}

// All values of a file, in order.
void collect(JsonValue& value, std::vector<JsonValue*>& all) {
  all.push_back(&value);
  if (JsonValue::Array* array = value.array())
    for (JsonValue& element : *array) collect(element, all);
  if (JsonValue::Object* object = value.object())
    for (auto& member : *object) collect(member.second, all);
}

void change_something(JsonValue& root, std::mt19937& random) {
  std::vector<JsonValue*> all;
  collect(root, all);
  JsonValue& value = *all[random() % all.size()];
  const auto kind = random() % 7;
  if (value.number() != nullptr) {
    const double old = *value.number();
    const double changed[] = {double(random() % 12) - 2, -old, 100 * old, 0.01 * old, old + 1, 1e30, 1e-30};
    value = JsonValue(changed[kind]);
  } else if (JsonValue::Array* array = value.array(); array != nullptr && !array->empty()) {
    const std::size_t i = random() % array->size(), j = random() % array->size();
    if (kind < 2) {
      array->erase(array->begin() + static_cast<std::ptrdiff_t>(i));
    } else if (kind < 4) {
      const JsonValue copy = (*array)[i];
      array->push_back(copy);
    } else {
      std::swap((*array)[i], (*array)[j]);
    }
  }
}

TEST(LintBroken, WhateverIsChangedItAgreesWithTheReaderAndMendsWhatItSaysItMends) {
  std::mt19937 random(7);
  const std::vector<BrokenPattern> all = test::broken_patterns();
  for (int k = 0; k < 400; ++k) {
    const BrokenPattern& broken = all[random() % all.size()];
    PatternFile file(broken.garment);
    if (k % 3 == 0) broken.break_it(file);
    for (int changes = 0; changes <= k % 4; ++changes) change_something(file.root, random);
    const std::string text = to_text(file.root);
    const LintReport report = lint_pattern(text, "p.json", broken.body);
    std::string refused;
    try {
      parse_pattern(text, "p.json");
    } catch (const InputError& error) {
      refused = error.what();
    }
    if (!refused.empty()) {
      EXPECT_TRUE(report.has_errors()) << k << ": " << refused;
    }
    EXPECT_FALSE(draw_pattern(report.drawing, report.findings).empty());
    if (report.mended_text.empty() || !report.usable) continue;
    EXPECT_NO_THROW(parse_pattern(report.mended_text, "mended.json")) << k;
    for (const LintFinding& finding : lint_pattern(report.mended_text, "mended.json", broken.body).findings)
      EXPECT_FALSE(finding.mended) << k << ": " << finding.code << " again";
  }
}

TEST(LintBroken, AFileThatIsNoPatternIsToldWithItsPlace) {
  const LintReport report =
      lint_pattern(R"({"pattern": {"panels": {"a": {"translation": [0, 0, 0]}}, "stitches": []}})", "p.json");
  ASSERT_EQ(report.findings.size(), 1U);
  EXPECT_EQ(report.findings[0].code, reason::unreadable);
  EXPECT_EQ(report.findings[0].pointer, "/pattern/panels/a");
  EXPECT_EQ(report.findings[0].where, "p.json:1:30");
  EXPECT_FALSE(report.usable);
  EXPECT_EQ(lint_pattern("{", "p.json").findings.size(), 1U);
}

TEST(LintBroken, WhatAFileHasBetweenTheWordsOfAMessageIsNotTakenForThem) {
  const LintReport report = lint_pattern(
      R"({"pattern": {"panels": {"as expected ": {"translation": "0, got 0", "rotation": [0, 0, 0]}}, "stitches": []}})",
      "p.json");
  ASSERT_EQ(report.findings.size(), 1U);
  EXPECT_EQ(report.findings[0].code, reason::unreadable);
  EXPECT_EQ(report.findings[0].pointer, "/pattern/panels/as expected /translation");
  EXPECT_EQ(report.findings[0].place, report.findings[0].pointer);
  EXPECT_EQ(report.findings[0].where, "p.json:1:57");
  EXPECT_EQ(report.findings[0].got, "the string \"0, got 0\"");
}

}  // namespace
}  // namespace toile::internal
