// `toile check` of a pattern: findings on stdout and in JSON, the drawing, the mended copy, exit codes.
#include "cli/program.hpp"
#include "io/file.hpp"
#include "io/json.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace toile::internal {
namespace {

using test::Ended;
using test::run_toile;

std::string own(const std::string& garment) { return read_file(test::source_path("patterns/") + garment + ".json"); }

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t found = text.find(what);
  EXPECT_NE(found, std::string::npos) << what;
  return text.replace(found, what.size(), by);
}

// The T-shirt with its first edge the wrong way round.
std::string reversed() { return replaced(own("tshirt"), R"({"endpoints": [1, 2]})", R"({"endpoints": [2, 1]})"); }

TEST(CheckPattern, NamesFindingsAndKeepsTheLineOfTheReader) {
  const Scratch scratch;
  scratch.put("p.json", reversed());
  const Ended ended = run_toile(scratch, {"check", "p.json", "--resolution", "4"});
  EXPECT_EQ(ended.exit_code, 3);
  EXPECT_EQ(ended.err_lines(), 1);
  EXPECT_NE(ended.err.find("p.json:"), std::string::npos);
  EXPECT_NE(ended.out.find("1. error loop_reversed: panel \"front\", edge 1, at (24.4, 17.5) cm"), std::string::npos)
      << ended.out;
  EXPECT_NE(ended.out.find("/pattern/panels/front/edges/1"), std::string::npos);
  EXPECT_NE(ended.out.find("can be mended: turned round"), std::string::npos);
  const Ended json = run_toile(scratch, {"check", "p.json", "--json", "--resolution", "4"});
  const Json file = Json::parse(json.out, "stdout").at("files").array().front();
  EXPECT_FALSE(file.at("ok").boolean());
  const Json finding = file.at("findings").array().front();
  EXPECT_EQ(finding.at("code").string(), "loop_reversed");
  EXPECT_EQ(finding.at("severity").string(), "error");
  EXPECT_TRUE(finding.at("repairable").boolean());
  EXPECT_EQ(finding.at("marks").array().front().at("edge").integer(), 1);
  EXPECT_EQ(run_toile(scratch, {"check", "p.json", "--quiet"}).out, "");
}

TEST(CheckPattern, WritesAMendedCopyThatKeepsWhatItDoesNotKnow) {
  const Scratch scratch;
  scratch.put("p.json", replaced(reversed(), "\"parameters\": {}",
                                 "\"parameters\": {}, \"mine\": {\"b\": [1.5, null], \"a\": true}"));
  const Ended ended = run_toile(scratch, {"check", "p.json", "--repair", "good.json", "--resolution", "4"});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  EXPECT_NE(ended.out.find("1 mended: good.json is written"), std::string::npos) << ended.out;
  const Json mended = Json::load(scratch / "good.json");
  EXPECT_EQ(mended.at("mine").object()[0].first, "b");
  EXPECT_EQ(mended.at("mine").at("b").array()[0].number(), 1.5);
  const Ended again = run_toile(scratch, {"check", "good.json", "--json", "--resolution", "4"});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_TRUE(Json::parse(again.out, "stdout").at("files").array().front().at("findings").array().empty());
}

TEST(CheckPattern, RefusesToMendWhatIsNotClear) {
  const Scratch scratch;
  scratch.put("p.json", replaced(own("skirt"), R"({"panel": "back", "edge": 2})", R"({"panel": "hood", "edge": 2})"));
  const Ended ended = run_toile(scratch, {"check", "p.json", "--repair", "good.json"});
  EXPECT_EQ(ended.exit_code, 3);
  EXPECT_NE(ended.out.find("seam_missing"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("refused: "), std::string::npos);
  EXPECT_NE(ended.out.find("nothing is written"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(scratch / "good.json"));
}

TEST(CheckPattern, CopiesWhatIsGood) {
  const Scratch scratch;
  scratch.put("p.json", own("skirt"));
  EXPECT_EQ(run_toile(scratch, {"check", "p.json", "--repair", "copy.json", "--resolution", "4"}).exit_code, 0);
  EXPECT_EQ(scratch.get("copy.json"), own("skirt"));
}

TEST(CheckPattern, NeverWritesOverAnInput) {
  const Scratch scratch;
  scratch.put("p.json", reversed());
  for (const char* option : {"--repair", "--svg"}) {
    const Ended ended = run_toile(scratch, {"check", "p.json", option, "./p.json"});
    EXPECT_EQ(ended.exit_code, 6) << ended.out;
    EXPECT_EQ(scratch.get("p.json"), reversed());
  }
  EXPECT_EQ(run_toile(scratch, {"check", "p.json", "--svg", "a", "--repair", "./a"}).exit_code, 2);
}

TEST(CheckPattern, DrawsTheSameBytesTwiceAlsoWhereItCannotBeUsed) {
  const Scratch scratch;
  scratch.put("p.json", reversed());
  EXPECT_EQ(run_toile(scratch, {"check", "p.json", "--svg", "a.svg", "--resolution", "4"}).exit_code, 3);
  EXPECT_EQ(run_toile(scratch, {"check", "p.json", "--svg", "b.svg", "--quiet", "--resolution", "4"}).exit_code, 3);
  const std::string svg = scratch.get("a.svg");
  EXPECT_EQ(svg, scratch.get("b.svg"));
  EXPECT_NE(svg.find("<svg xmlns=\"http://www.w3.org/2000/svg\""), std::string::npos);
  EXPECT_NE(svg.find("loop_reversed (error)"), std::string::npos);
}

TEST(CheckPattern, KnowsWhoIsToWearIt) {
  const Scratch scratch;
  const std::string tshirt = test::source_path("patterns/tshirt.json");
  const Ended fits = run_toile(scratch, {"check", tshirt, "--body", "woman", "--resolution", "4"});
  EXPECT_EQ(fits.exit_code, 0);
  EXPECT_EQ(fits.out.find("warning"), std::string::npos) << fits.out;
  scratch.put("p.json", replaced(own("skirt"), "[0, 110.5, 20]", "[0, 110.5, 220]"));
  scratch.put("p.json", replaced(scratch.get("p.json"), "[0, 110.5, -24]", "[0, 110.5, 176]"));
  const Ended beside =
      run_toile(scratch, {"check", "p.json", "--body", "woman", "--repair", "good.json", "--resolution", "4"});
  EXPECT_EQ(beside.exit_code, 0) << beside.err;
  EXPECT_NE(beside.out.find("warning off_body"), std::string::npos) << beside.out;
  EXPECT_EQ(run_toile(scratch, {"check", "good.json", "--body", "woman", "--resolution", "4"}).out.find("warning"),
            std::string::npos);
}

TEST(CheckPattern, ItsOptionsAreForOnePattern) {
  const Scratch scratch;
  const std::string skirt = test::source_path("patterns/skirt.json"), scene = test::source_path("scenes/cylinder.json");
  for (const std::vector<std::string>& words : {std::vector<std::string>{"check", scene, "--svg", "a.svg"},
                                                {"check", scene, "--repair", "a.json"},
                                                {"check", scene, "--body", "woman"},
                                                {"check", skirt, skirt, "--svg", "a.svg"}}) {
    const Ended ended = run_toile(scratch, words);
    EXPECT_EQ(ended.exit_code, 2) << ended.out;
    EXPECT_EQ(ended.err_lines(), 1);
  }
}

// The measurements beside a body, or those that are named, tell whom a pattern was cut for.
TEST(CheckPattern, TellsWhomAPatternIsCutForByTheBodysMeasurements) {
  const Scratch scratch;
  scratch.put("skirt.json", own("skirt"));
  // A pillar 1.7 m tall and 68 cm round.
  std::string obj;
  for (const char* y : {"0", "1.7"})
    for (const char* xz : {"-0.08 -0.09", "0.08 -0.09", "0.08 0.09", "-0.08 0.09"}) {
      const std::string pair = xz;
      obj += "v " + pair.substr(0, pair.find(' ')) + ' ' + y + pair.substr(pair.find(' ')) + '\n';
    }
  scratch.put("body.obj", obj + "f 1 2 3 4\nf 8 7 6 5\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n");
  const auto codes = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"check", "skirt.json", "--json", "--resolution", "5", "--body", "body.obj"};
    words.insert(words.end(), more.begin(), more.end());
    const Ended ended = run_toile(scratch, words);
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    std::vector<std::string> found;
    const Json said = Json::parse(ended.out, "stdout");
    for (const Json& finding : said.at("files").array().front().at("findings").array())
      found.push_back(finding.at("code").string());
    return found;
  };
  const std::vector<std::string> told = {"other_body"};
  EXPECT_EQ(codes({}), std::vector<std::string>());
  scratch.put("body.yaml", "body: {height: 170, head_l: 24, waist_line: 45}");
  EXPECT_EQ(codes({}), told);
  scratch.put("tape.yaml", "body: {height: 170, head_l: 24, waist_line: 35.5}");
  EXPECT_EQ(codes({"--measurements", "tape.yaml"}), std::vector<std::string>());

  scratch.put("body.yaml", "body: {height: 150}");
  const Ended other = run_toile(scratch, {"check", "skirt.json", "--body", "body.obj"});
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_NE(
      other.err.find("body.yaml: body.height: expected 170.0 cm within 2 %, the height of body.obj, got 150.0 cm"),
      std::string::npos)
      << other.err;
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"check", "skirt.json", "--measurements", "tape.yaml"},
        std::vector<std::string>{"check", "body.obj", "--measurements", "tape.yaml"},
        std::vector<std::string>{"dress", "skirt.json", "--body", "woman", "--measurements", "tape.yaml"}}) {
    const Ended ended = run_toile(scratch, words);
    EXPECT_EQ(ended.exit_code, 2) << ended.err;
    EXPECT_NE(ended.err.find("--measurements"), std::string::npos) << ended.err;
  }
}

}  // namespace
}  // namespace toile::internal
