// Shapes whose numbers look right and that are none: refused when they are meshed, by `check` and `run` alike, at their place.
#include "mesh/check.hpp"
#include "sim/setup.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <random>
#include <string>

namespace toile::internal {
namespace {

// What a scene of one object is refused with; empty: it is a shape.
std::string shape_refusal(const std::string& scene_text) {
  try {
    const auto [scene, places] = read_scene("\n" + scene_text, "s.json");
    const LoadedScene loaded = places.complete_errors_of([&, &s = scene] { return load_scene(s, read_text_file); });
    for (const LoadedCloth& cloth : loaded.cloth) check_cloth("accepted", cloth.garment.mesh, cloth.garment.x);
    const SolidMesh& solid = loaded.colliders.joined.surface;
    if (!solid.positions.empty()) check_closed("accepted", solid.positions, solid.triangles);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

std::string ribbon(const std::string& keys) { return std::string(R"({"cloth": [{"ribbon": {)") + keys + "}}]}"; }
std::string solid(const std::string& keys) {
  return std::string(R"({"cloth": [{"grid": {}}], "solids": [{)") + keys + "}]}";
}

void expect_refused(const std::string& scene, const std::string& pointer, const std::string& words) {
  const std::string message = shape_refusal(scene);
  EXPECT_EQ(message.rfind("s.json:2:", 0), 0U) << message;
  EXPECT_NE(message.find(": " + pointer), std::string::npos) << message;
  EXPECT_NE(message.find(words), std::string::npos) << message;
}

std::string number(double x) { return std::to_string(x); }

TEST(DegenerateShapes, PointsThatAreNearlyOne) {
  for (const char* x : {"1e-300", "1e-160", "1e-9", "-9e-7"})
    expect_refused(ribbon(R"("width_m": 0.05, "edge_m": 0.01, "path_m": [[0, 0, 0], [)" + std::string(x) +
                          ", 0, 0], [0.3, 0, 0]]"),
                   "/cloth/0/ribbon/path_m/1", "another place");
  expect_refused(ribbon(R"("closed": true, "path_m": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [1e-200, 0, 0]])"),
                 "/cloth/0/ribbon/path_m", "only once");
  EXPECT_EQ(
      shape_refusal(ribbon(R"("width_m": 1e-3, "edge_m": 0.01, "path_m": [[0, 0, 0], [1e-3, 0, 0], [0.3, 0, 0]])")),
      "");
}

TEST(DegenerateShapes, WaysThatAreTooLong) {
  std::string spiral;
  for (int k = 0; k < 120; ++k)
    spiral += (k == 0 ? "[" : ", [") + number(std::cos(k)) + ", 0, " + number(std::sin(k)) + "]";
  expect_refused(ribbon(R"("width_m": 0.01, "edge_m": 0.01, "path_m": [)" + spiral + "]"), "/cloth/0/ribbon/path_m",
                 "at most 32 m along it");
  expect_refused(ribbon(R"("width_m": 1e-3, "edge_m": 1, "path_m": [[-1e4, 0, 0], [1e4, 0, 0]])"),
                 "/cloth/0/ribbon/path_m", "at most 32 m along it");
  // Not from point to point, but on the way between them.
  expect_refused(
      ribbon(
          R"("width_m": 0.01, "edge_m": 0.1, "path_m": [[0, 0, 0], [15.95, 0, 0], [15.95, 0.2, 0], [0.15, 0.2, 0]])"),
      "/cloth/0/ribbon", "at most 32 m along it");
  expect_refused(R"({"cloth": [{"tube": {"radius_m": 6, "edge_m": 0.5}}]})", "/cloth/0/tube", "at most 32 m around it");
}

TEST(DegenerateShapes, RibbonsThatLieOnThemselves) {
  expect_refused(ribbon(R"("width_m": 0.1, "edge_m": 0.02, "path_m": [[0, 0, 0], [1, 0, 0], [0, 0, 0]])"),
                 "/cloth/0/ribbon", "path_m");
  // In its plane around a bend of a third of its width.
  expect_refused(
      ribbon(
          R"("width_m": 0.6, "edge_m": 0.02, "across": [0, 1, 0], "path_m": [[-1, 0, 0], [0, 0.05, 0], [0.2, 0.2, 0], [0, 0.4, 0], [-1, 0.4, 0]])"),
      "/cloth/0/ribbon", "bends wider than half of width_m");
  // The same line with the breadth across its plane is a ribbon.
  EXPECT_EQ(
      shape_refusal(ribbon(
          R"("width_m": 0.6, "edge_m": 0.02, "across": [0, 0, 1], "path_m": [[-1, 0, 0], [0, 0.05, 0], [0.2, 0.2, 0], [0, 0.4, 0], [-1, 0.4, 0]])")),
      "");
  expect_refused(ribbon(R"("across": [1e-200, 0, 0], "path_m": [[0, 0, 0], [0, 1, 0]])"), "/cloth/0/ribbon/across",
                 "direction");
}

TEST(DegenerateShapes, SolidsOfNoVolume) {
  expect_refused(solid(R"("revolved": {"profile_m": [[0, 0], [1e-300, 0.5], [0, 1]]})"), "/solids/0", "got");
  expect_refused(solid(R"("revolved": {"profile_m": [[1, 0], [1, 0.5], [1, 1]]})"), "/solids/0", "got");
  expect_refused(solid(R"("revolved": {"profile_m": [[0, 0], [0.5, 0], [1e-200, 0], [0, 1e-200]]})"), "/solids/0",
                 "got");
}

// Whatever the numbers: a mesh of finite triangles with an area, or a refusal with its place.  Some are drawn from where arithmetic ends.
TEST(DegenerateShapes, AreRefusedAtTheirPlaceWhateverTheNumbers) {
  std::mt19937 random(7);
  const auto pick = [&](double least, double most) {
    const int kind = std::uniform_int_distribution<int>(0, 5)(random);
    if (kind == 0) return least;
    if (kind == 1) return most;
    if (kind == 2 && least <= 0) return std::pow(10.0, -std::uniform_real_distribution<double>(3, 320)(random));
    if (kind == 3 && least > 0)
      return least * std::pow(most / least, std::uniform_real_distribution<double>(0, 1)(random));
    const double low = std::clamp(-2.0, least, most);
    return std::uniform_real_distribution<double>(low, std::clamp(2.0, low, most))(random);
  };
  const auto text = [](double x) {
    char digits[32];
    return std::string(digits, std::to_chars(digits, digits + sizeof digits, x).ptr);
  };
  const auto vector = [&] {
    return std::string("[") + text(pick(-1e4, 1e4)) + ", " + text(pick(-1e4, 1e4)) + ", " + text(pick(-1e4, 1e4)) + "]";
  };
  int accepted = 0, refused = 0;
  const auto look = [&](const std::string& scene, const std::string& pointer) {
    const std::string message = shape_refusal(scene);
    if (message.empty()) {
      ++accepted;
      return;
    }
    ++refused;
    EXPECT_EQ(message.rfind("s.json:2:", 0), 0U) << message << "\n" << scene;
    EXPECT_NE(message.find(": " + pointer), std::string::npos) << message;
    EXPECT_EQ(message.find("nan"), std::string::npos) << message;
  };
  for (int k = 0; k < 40; ++k) {
    const std::string edge = std::string(R"("edge_m": )") + text(pick(0.1, 1)) + ", ";
    look(R"({"cloth": [{"grid": {)" + edge + R"("width_m": )" + text(pick(1e-3, 10)) + R"(, "height_m": )" +
             text(pick(1e-3, 10)) + "}}]}",
         "/cloth/0/grid");
    look(R"({"cloth": [{"tube": {)" + edge + R"("radius_m": )" + text(pick(1e-3, 10)) + R"(, "length_m": )" +
             text(pick(1e-3, 10)) + "}}]}",
         "/cloth/0/tube");
    std::string path = vector();
    for (int p = std::uniform_int_distribution<int>(1, 5)(random); p > 0; --p) path += ", " + vector();
    look(ribbon(edge + R"("width_m": )" + text(pick(1e-3, 10)) + R"(, "closed": )" + (k % 3 == 0 ? "true" : "false") +
                R"(, "across": )" + vector() + R"(, "path_m": [)" + path + "]"),
         "/cloth/0/ribbon");
    std::string near;  // points about a metre around the origin, so that more of them are ribbons
    for (int p = std::uniform_int_distribution<int>(2, 6)(random); p > 0; --p)
      near += (near.empty() ? "[" : ", [") + text(0.01 * pick(-100, 100)) + ", " + text(0.01 * pick(-100, 100)) + ", " +
              text(pick(-1, 1)) + "]";
    look(ribbon(edge + R"("path_m": [)" + near + "]"), "/cloth/0/ribbon");
    const std::string coarse = std::string(R"("edge_m": )") + text(pick(4, 10)) + ", ";
    std::string profile = "[0, 0]";
    for (int p = std::uniform_int_distribution<int>(1, 4)(random); p > 0; --p)
      profile += ", [" + text(pick(0, 100)) + ", " + text(pick(-100, 100)) + "]";
    look(solid(coarse + R"("revolved": {"profile_m": [)" + profile + ", [0, 1]]}"), "/solids/0");
    look(solid(coarse + R"("sphere": {"radius_m": )" + text(pick(1e-3, 100)) + "}"), "/solids/0");
    look(solid(std::string(R"("box": {"size_m": [)") + text(pick(1e-3, 100)) + ", " + text(pick(1e-3, 100)) + ", " +
               text(pick(1e-3, 100)) + "]}"),
         "/solids/0");
  }
  EXPECT_GT(accepted, 60);
  EXPECT_GT(refused, 60);
}

}  // namespace
}  // namespace toile::internal
