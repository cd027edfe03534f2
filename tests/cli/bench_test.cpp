// The benchmarks: that they print what they found, completely, in three ways.  No time is asserted.
#include "cli/program.hpp"
#include "io/json.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

namespace toile::internal {
namespace {

using test::Ended;
using test::run_toile;

Json bench(const Scratch& scratch, std::vector<std::string> words, int exit_code = 0) {
  words.insert(words.begin(), "bench");
  words.emplace_back("--json");
  const Ended ended = run_toile(scratch, words);
  EXPECT_EQ(ended.exit_code, exit_code) << ended.err;
  return Json::parse(ended.out, "stdout");
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

TEST(Bench, ScalingHasARowPerSizeAndTheExponent) {
  const Scratch scratch;
  const Json json = bench(scratch, {"scaling", "--sizes", "100,200", "--frames", "3"});
  const auto& rows = json.at("rows").array();
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1].at("size").integer(), 200);
  EXPECT_GT(rows[1].at("particles").number(), rows[0].at("particles").number());
  for (const Json& row : rows) {
    EXPECT_EQ(row.at("frames").integer(), 3);
    EXPECT_GE(row.at("steps").integer(), 3);
    EXPECT_GT(row.at("seconds_per_frame").number(), 0);
    EXPECT_GT(row.at("cg_iterations_mean").number(), 0);
    double percent = 0;
    for (const char* part : {"eval", "cg", "cloth_cloth", "cloth_solid", "other"})
      percent += row.at(std::string(part) + "_percent").number();
    EXPECT_NEAR(percent, 100, 1e-9);
  }
  // Of two sizes the fit is the line through both.
  const auto log_of = [&](std::size_t k, const char* key) { return std::log(rows[k].at(key).number()); };
  EXPECT_NEAR(json.at("exponent").number(),
              (log_of(1, "seconds_per_frame") - log_of(0, "seconds_per_frame")) /
                  (log_of(1, "particles") - log_of(0, "particles")),
              1e-9);
  EXPECT_NEAR(json.at("exponent_1998").number(), 1.43, 0.01);
}

TEST(Bench, ScalingFindsTheSizesOfThePaperWithinThreePercent) {
  const Scratch scratch;
  const Json json = bench(scratch, {"scaling", "--frames", "1"});
  const auto& rows = json.at("rows").array();
  ASSERT_EQ(rows.size(), 4u);
  for (const Json& row : rows) {
    const double size = row.at("size").number();
    EXPECT_NEAR(row.at("particles").number(), size, 0.03 * size);
    EXPECT_GT(row.at("seconds_per_frame_1998").number(), 0);
  }
}

TEST(Bench, StiffnessHasARowPerFactorAndIterationsFromOneState) {
  const Scratch scratch;
  const Json json = bench(scratch, {"stiffness", "--size", "100", "--frames", "6"});
  const auto& rows = json.at("rows").array();
  ASSERT_EQ(rows.size(), 9u);
  std::vector<double> same_b;
  for (const Json& row : rows) {
    EXPECT_EQ(row.at("frames").integer(), 6);
    EXPECT_GT(row.at("touching_mean").number(), 0);
    const bool bend = row.at("varied").string() == "bend";
    EXPECT_NEAR(row.at("bend_u_N_m").number(), 7.3e-6 * (bend ? row.at("factor").number() : 1), 1e-12);
    EXPECT_NEAR(row.at("stretch_u_N_per_m").number(), 3000 * (bend ? 1 : row.at("factor").number()), 1e-6);
    if (bend) same_b.push_back(row.at("iterations_block_jacobi_same_b").number());
    if (row.at("factor").number() == 1) {
      EXPECT_EQ(row.at("iterations_block_jacobi").integer(), row.at("iterations_block_jacobi_same_b").integer());
    }
  }
  // Stiffer threads are another matrix: were the fabric not set, these would be equal.
  EXPECT_GT(rows[8].at("iterations_block_jacobi_same_b").number(),
            rows[5].at("iterations_block_jacobi_same_b").number());
  const auto [least, largest] = std::minmax_element(same_b.begin(), same_b.end());
  EXPECT_NEAR(json.at("bend_iterations_same_b_vary_percent").number(), 100 * (*largest / *least - 1), 1e-9);
}

TEST(Bench, StiffnessAsksAgainAtEveryStateThatTheDrapeReaches) {
  const Scratch scratch;
  EXPECT_TRUE(bench(scratch, {"stiffness", "--size", "100", "--frames", "4"}).at("states").array().empty());
  const Json json = bench(scratch, {"stiffness", "--size", "400", "--frames", "15"});
  const auto& states = json.at("states").array();
  ASSERT_EQ(states.size(), 2u);
  std::vector<double> first;
  for (const Json& state : states) {
    std::vector<double> iterations;
    for (const char* key : {"bend_x_0_1", "bend_x_1", "bend_x_10", "bend_x_100", "bend_x_1000"})
      iterations.push_back(state.at(key).number());
    const auto [least, largest] = std::minmax_element(iterations.begin(), iterations.end());
    EXPECT_GT(*largest, *least);
    EXPECT_NEAR(state.at("vary_percent").number(), 100 * (*largest / *least - 1), 1e-9);
    if (first.empty()) {
      first = iterations;
    } else {
      EXPECT_NE(iterations, first);  // another state is another system
    }
  }
  EXPECT_EQ(states[0].at("state_frame").integer(), 5);
  EXPECT_EQ(states[1].at("state_frame").integer(), 15);
}

TEST(Bench, PaperHasItsColumnsBesideThoseOf1998) {
  const Scratch scratch;
  const Json json = bench(scratch, {"paper", "--rows", "2,1", "--frames", "2"});
  const auto& rows = json.at("rows").array();
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].at("row").integer(), 1) << "in the paper's order";
  const Json& row = rows[1];
  EXPECT_EQ(row.at("scene").string(), "fig2-sheet");
  EXPECT_EQ(row.at("frames").integer(), 2);
  EXPECT_EQ(row.at("frames_1998").integer(), 75);
  EXPECT_EQ(row.at("solid_vertices").integer(), 322);
  EXPECT_NEAR(row.at("cloth_vertices_off_percent").number(), 100 * (row.at("cloth_vertices").number() / 2602 - 1),
              1e-9);
  EXPECT_NEAR(row.at("times_faster").number(), 3.06 / row.at("seconds_per_frame").number(), 1e-9);
  EXPECT_LE(row.at("step_max_ms").number(), 1000.0 / 30 + 1e-9);
  EXPECT_TRUE(json.at("claims").array().empty());
}

TEST(Bench, ARowThatCannotBeginDoesNotStopTheOthers) {
  const Scratch scratch;
  std::filesystem::create_directory(scratch / "kept");
  scratch.put("kept/row-1", "a file where a folder should be");
  const Json json = bench(scratch, {"paper", "--rows", "1,2", "--frames", "1", "--out", "kept"}, 5);
  const auto& rows = json.at("rows").array();
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_FALSE(json.at("complete").boolean());
  EXPECT_EQ(rows[0].at("verdict").string(), "fail");
  EXPECT_TRUE(rows[0].at("seconds_per_frame").type() == Json::Type::null) << "not measured is not zero";
  EXPECT_EQ(rows[0].at("seconds_per_frame_1998").number(), 2.23);
  EXPECT_EQ(rows[1].at("verdict").string(), "pass");
}

TEST(Bench, PaperTakesAnotherLongestStep) {
  const Scratch scratch;
  const auto longest_ms = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"paper", "--rows", "2", "--frames", "2"};
    words.insert(words.end(), more.begin(), more.end());
    const Json json = bench(scratch, words);
    return json.at("rows").array()[0].at("step_max_ms").number();
  };
  EXPECT_NEAR(longest_ms({}), 1000.0 / 30, 1e-9);
  EXPECT_NEAR(longest_ms({"--step-max-ms", "12"}), 1000.0 / 90, 1e-9) << "a frame's third";
}

TEST(Bench, ClaimsCountIterationsOfThePaperAndOfOurs) {
  const Scratch scratch;
  const Json json = bench(scratch, {"paper", "--rows", "cg", "--frames", "3"});
  EXPECT_TRUE(json.at("rows").array().empty());
  std::map<std::string, double> measured;
  for (const Json& claim : json.at("claims").array())
    measured[claim.at("claim").string()] = claim.at("measured").number();
  ASSERT_EQ(measured.size(), 5u);
  EXPECT_LT(measured["cg_paper_1998_eps_0.01"], measured["cg_paper_1998_eps_0.001"]);
  EXPECT_LT(measured["cg_block_ssor_coarse"], measured["cg_block_jacobi"]);
  EXPECT_LT(measured["cg_block_jacobi"], measured["cg_diagonal"]);
}

TEST(Bench, MicroTimesEveryPiece) {
  const Scratch scratch;
  const Json json = bench(scratch, {"micro", "--size", "200", "--limits", "200", "--repeat", "3"});
  const auto& rows = json.at("rows").array();
  EXPECT_EQ(rows.size(), 14u);
  for (const Json& row : rows) {
    EXPECT_GE(row.at("count").integer(), 1) << row.at("what").string();
    EXPECT_GE(row.at("nanoseconds_each").number(), row.at("least_nanoseconds_each").number());
    EXPECT_NEAR(row.at("nanoseconds_each").number() * row.at("count").number(), 1e6 * row.at("milliseconds").number(),
                1e-6 * 1e6 * row.at("milliseconds").number());
  }
  EXPECT_EQ(json.at("repeats").integer(), 3);
}

TEST(Bench, MicroPutsPiecesBesideWhatTheMachineReads) {
  const Scratch scratch;
  const Json json =
      bench(scratch, {"micro", "--size", "200", "--limits", "100,2200", "--repeat", "3", "--threads", "1"});
  const auto& limits = json.at("limits").array();
  ASSERT_EQ(limits.size(), 8u) << "four pieces, two sizes";
  std::map<std::string, double> moved;  // at the larger size
  for (const Json& row : limits) {
    const std::string piece = row.at("piece").string();
    EXPECT_EQ(row.at("threads").integer(), 1);
    EXPECT_GT(row.at("microseconds").number(), 0) << piece;
    EXPECT_GT(row.at("limit_microseconds").number(), 0) << piece;
    EXPECT_GE(row.at("moved_bytes").number(), row.at("worked_on_bytes").number()) << piece;
    EXPECT_NEAR(row.at("share_percent").number(),
                100 * row.at("limit_microseconds").number() / row.at("microseconds").number(), 1e-6);
    moved[piece] = row.at("moved_bytes").number();
  }
  // Of a regular sheet a particle has six blocks of its own, of 52 bytes, fewer at the rim; an iteration reads them twice.
  EXPECT_NEAR(moved["matrix product, float"] / 2200, 6 * 52 + 84, 25);
  EXPECT_NEAR(moved["iterate block_ssor"] / 2200, 2 * 6 * 52 + 488, 50);
  EXPECT_GT(moved["iterate block_ssor_coarse"], moved["iterate block_ssor"]);
}

TEST(Bench, CsvHasTheKeysAndValuesOfTheRows) {
  const Scratch scratch;
  const Json json = bench(scratch, {"scaling", "--sizes", "100", "--frames", "1"});
  const Ended ended = run_toile(scratch, {"bench", "scaling", "--sizes", "100", "--frames", "1", "--csv"});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  const Json& row = json.at("rows").array().front();
  std::string keys;
  for (const auto& [key, value] : row.object()) keys.append(keys.empty() ? "" : ",").append(key);
  EXPECT_EQ(first_line(ended.out), keys);
  std::istringstream names(first_line(ended.out)), values(ended.out.substr(ended.out.find('\n') + 1));
  std::string name, value;
  while (std::getline(names, name, ',')) {
    std::getline(values, value, ',');
    if (name == "particles") {
      EXPECT_EQ(value, std::to_string(row.at("particles").integer()));
    }
    if (name == "verdict") {
      EXPECT_EQ(value, row.at("verdict").string());
    }
  }
}

TEST(Bench, OutKeepsTheRunsAndTheResult) {
  const Scratch scratch;
  const Json json = bench(scratch, {"scaling", "--sizes", "100", "--frames", "2", "--out", "kept"});
  const Json report = Json::load(scratch / "kept/100-particles/report.json");
  EXPECT_EQ(report.at("frames").integer(), 3) << "the start and two more";
  EXPECT_EQ(report.at("cloth").at("vertices").integer(), json.at("rows").array().front().at("particles").integer());
  EXPECT_EQ(Json::load(scratch / "kept/scaling.json").at("rows").array().size(), 1u);
  EXPECT_TRUE(std::filesystem::exists(scratch / "kept/scaling.csv"));
}

TEST(Bench, WithoutOutNothingIsLeft) {
  const Scratch scratch;
  const std::string temporary = scratch / "temporary";
  std::filesystem::create_directory(temporary);
  setenv("TMPDIR", temporary.c_str(), 1);
  bench(scratch, {"scaling", "--sizes", "100", "--frames", "1"});
  unsetenv("TMPDIR");
  EXPECT_TRUE(std::filesystem::is_empty(temporary));
}

TEST(Bench, TortureSaysOfEveryRunWhetherItHolds) {
  const Scratch scratch;
  const Json json = bench(scratch, {"torture", "--scenes", "07,14", "--starts", "2", "--frames", "2", "--out", "kept"});
  const auto& rows = json.at("rows").array();
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(json.at("runs").integer(), 4);
  EXPECT_EQ(json.at("held").integer(), 4);
  for (const Json& row : rows) {
    EXPECT_EQ(row.at("frames").integer(), 2);
    EXPECT_EQ(row.at("frames_expected").integer(), 2);
    EXPECT_EQ(row.at("holds").string(), "yes");
    EXPECT_GT(row.at("vertices").integer(), 2000);
    EXPECT_LT(row.at("vertices").integer(), 4000);
  }
  EXPECT_EQ(rows[0].at("scene").string(), "07-rotating-sphere");
  EXPECT_EQ(rows[1].at("start").integer(), 1);
  EXPECT_NE(rows[0].at("state_hash").string(), rows[1].at("state_hash").string()) << "another start";
  EXPECT_TRUE(std::filesystem::exists(scratch / "kept/14-sphere-through-S-1/cloth.pc2"));
  const Json belts = bench(scratch, {"torture", "--scenes", "15", "--frames", "1"});
  EXPECT_EQ(belts.at("held").integer(), 2) << "what the one cannot do is not asked for in its first frame";
  const Json again = bench(scratch, {"torture", "--scenes", "07", "--first-start", "1", "--frames", "2"});
  EXPECT_EQ(again.at("rows").array().at(0).at("state_hash").string(), rows[1].at("state_hash").string());
}

TEST(Bench, OptionsThatMeanNothingAreUsageErrors) {
  const Scratch scratch;
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"bench"},
                                             {"bench", "fly"},
                                             {"bench", "scaling", "--sizes", "abc"},
                                             {"bench", "scaling", "--sizes", "0"},
                                             {"bench", "scaling", "--sizes", "100,-5"},
                                             {"bench", "scaling", "--rows", "1"},
                                             {"bench", "stiffness", "--sizes", "100"},
                                             {"bench", "paper", "--rows", "10"},
                                             {"bench", "micro", "--frames", "3"},
                                             {"bench", "micro", "--limits", "10"},
                                             {"bench", "scaling", "--limits", "100"},
                                             {"bench", "torture", "--size", "XL"},
                                             {"bench", "torture", "--scenes", "99"},
                                             {"bench", "paper", "--starts", "2"},
                                             {"bench", "paper", "--step-max-ms", "0"},
                                             {"bench", "scaling", "--step-max-ms", "10"},
                                             {"bench", "stiffness", "--size", "100,200"},
                                             {"bench", "scaling", "--repeat", "0"},
                                             {"bench", "scaling", "--csv", "--json"},
                                             {"bench", "--sizes", "500"}}) {
    const Ended ended = run_toile(scratch, words);
    EXPECT_EQ(ended.exit_code, 2) << words.back() << ": " << ended.err;
    EXPECT_EQ(ended.err_lines(), 1) << ended.err;
  }
}

}  // namespace
}  // namespace toile::internal
