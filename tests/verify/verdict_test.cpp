// Which reports pass, and with which codes the others fail.
#include "verify/verdict.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace toile::internal {
namespace {

VerifyReport good() {
  VerifyReport report;
  report.frames = 31;
  report.stretch.gauge_p99 = 0.08;
  report.stretch.gauge_max = 0.25;
  report.still_mm_per_s_p99 = 5;
  return report;
}

std::vector<std::string> codes(const VerifyReport& report, const Limits& limits = {}) {
  const Verdict verdict = judge(report, limits);
  EXPECT_EQ(verdict.pass, verdict.reasons.empty());
  std::vector<std::string> result;
  for (const Reason& reason : verdict.reasons) {
    EXPECT_FALSE(reason.detail.empty());
    result.push_back(reason.code);
  }
  return result;
}
using Codes = std::vector<std::string>;

TEST(Verdict, PassesARunExactlyAtItsLimits) {
  Limits limits;
  limits.must_be_still = true;
  EXPECT_EQ(codes(good(), limits), Codes{});
}

TEST(Verdict, GivesOneCodeForEachExcess) {
  VerifyReport report = good();
  report.cloth_body_edges.last = report.outside_pinches.last = 1;
  EXPECT_EQ(codes(report), Codes{"cloth_body_intersection"});
  report = good();
  report.cloth_cloth_edges.last = 1;
  EXPECT_EQ(codes(report), Codes{"cloth_self_intersection"});
  report = good();
  report.stretch.gauge_p99 = 0.0801;
  EXPECT_EQ(codes(report), Codes{"stretch"});
  report = good();
  report.stretch.gauge_max = 0.2501;
  EXPECT_EQ(codes(report), Codes{"stretch"});
  report.stretch.gauge_p99 = 0.06;
  EXPECT_EQ(codes(report), Codes{"stretch"});
  report = good();
  report.finite = false;
  report.first_bad_frame = 4;
  EXPECT_EQ(codes(report), Codes{"not_finite"});
  report = good();
  report.frames_expected = 32;
  EXPECT_EQ(codes(report), Codes{"unfinished"});
  report = good();
  report.frames = 0;
  EXPECT_EQ(codes(report), Codes{"unfinished"});
}

TEST(Verdict, PassesClothThatTheBodyPinchesWithAReservation) {
  VerifyReport report = good();
  report.cloth_body_edges.last = 5;
  report.outside_pinches.last = 0;
  report.last_body_crossings.resize(1);
  report.last_body_crossings[0].edge = {7, 8};
  report.reported_qualifications = {{"pinched_cloth", "what the report says of it"}};
  Verdict verdict = judge(report);
  EXPECT_TRUE(verdict.pass);
  ASSERT_EQ(verdict.qualifications.size(), 1u) << "the report's word is not repeated";
  EXPECT_EQ(verdict.qualifications[0].code, "pinched_cloth");
  EXPECT_TRUE(verdict.qualifications[0].detail.starts_with("5 edges pass between cloth and body"))
      << verdict.qualifications[0].detail;
  EXPECT_NE(verdict.qualifications[0].detail.find("vertices 7, 8"), std::string::npos)
      << verdict.qualifications[0].detail;
  report.outside_pinches.last = 2;
  verdict = judge(report);
  EXPECT_EQ(codes(report), Codes{"cloth_body_intersection"});
  EXPECT_TRUE(verdict.reasons[0].detail.starts_with("2 edges pass through")) << verdict.reasons[0].detail;
  EXPECT_TRUE(verdict.qualifications[0].detail.starts_with("3 edges")) << verdict.qualifications[0].detail;
  report.cloth_body_edges.last = 2;
  EXPECT_TRUE(judge(report).qualifications.empty());
}

TEST(Verdict, SaysOfAMisfitWhichGirthIsAroundWhichGirthOfTheBody) {
  VerifyReport report = good();
  report.stretch.gauge_p99 = 0.15;
  report.stretch.ring = {.worn_m = 0.254, .cut_m = 0.221, .closed = true};
  const auto detail = [&] { return judge(report, {}).reasons.at(0).detail; };
  EXPECT_TRUE(detail().starts_with("the garment is 22.1 cm round and worn at 25.4 cm near")) << detail();
  report.stretch.body_girth_m = 0.239;
  EXPECT_TRUE(detail().starts_with(
      "too narrow by 1.8 cm: the garment is 22.1 cm round and worn at 25.4 cm, around 23.9 cm of body, near"))
      << detail();
}

TEST(Verdict, SaysWhatSlidOffABodyThatMoved) {
  VerifyReport report = good();
  report.slip.first_frame = 3;
  report.slip.loops.resize(2);
  report.slip.loops[0] = {"wb_front, wb_back", 1.05, 0.72, true, {40, 0.05, 0.06, 12}};
  report.slip.loops[1] = {"skirt", 0.6, 1.1, false, {40, 0.3, 0.3, 12}};
  report.slip.shoulders = {12, 0.08, 0.2, 7};
  EXPECT_EQ(codes(report), Codes{}) << "exactly at the limit, and hems may swing";
  report.slip.loops[0].drop.last_m = 0.0501;
  EXPECT_EQ(codes(report), Codes{"slid_off"});
  EXPECT_EQ(judge(report).reasons.at(0).detail,
            "the edge of wb_front, wb_back, 72 cm round at 1.05 m, dropped 5.0 cm against the body since it began to "
            "move, limit 5.0 cm; most was 6.0 cm, in frame 12");
  report.slip.loops[0].drop.last_m = 0;
  report.slip.shoulders.last_m = 0.081;
  EXPECT_EQ(codes(report), Codes{"slid_off"});
  EXPECT_NE(judge(report).reasons.at(0).detail.find("on a shoulder moved 8.1 cm"), std::string::npos);
  EXPECT_TRUE(is_measured_reason("slid_off"));
}

TEST(Verdict, DoesNotJudgeElasticNorEarlierFrames) {
  VerifyReport report = good();
  report.stretch.max = report.stretch.p99 = 0.5;
  report.cloth_body_edges.max = report.cloth_body_edges.frames = 12;
  EXPECT_EQ(codes(report), Codes{});
}

TEST(Verdict, AsksForRestOnlyWhereItIsRequired) {
  VerifyReport report = good();
  report.still_mm_per_s_p99 = 5.1;
  EXPECT_EQ(codes(report), Codes{});
  Limits limits;
  limits.must_be_still = true;
  EXPECT_EQ(codes(report, limits), Codes{"static_equilibrium"});
  report = good();
  report.frames = 1;
  EXPECT_EQ(codes(report, limits), Codes{"static_equilibrium"});
}

TEST(Verdict, DoesNotAcquitOfWhatTheRunConfessed) {
  VerifyReport report = good();
  report.reported_reasons = {"unfinished", "simulation_timeout"};
  report.frames_expected = 40;
  EXPECT_EQ(codes(report), (Codes{"unfinished", "simulation_timeout"}));  // each once
}

TEST(Verdict, TakesNaNForAnExcess) {
  VerifyReport report = good();
  report.stretch.gauge_max = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(codes(report), Codes{"stretch"});
}

TEST(Verdict, UsesTheLimitsGivenAndReturnsThem) {
  VerifyReport report = good();
  report.cloth_cloth_edges.last = 300;
  Limits limits;
  limits.cloth_cloth_edges = 300;
  limits.stretch_max = 0.02;
  EXPECT_EQ(codes(report, limits), Codes{"stretch"});
  EXPECT_EQ(judge(report, limits).limits.cloth_cloth_edges, 300);
}

}  // namespace
}  // namespace toile::internal
