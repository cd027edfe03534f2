#include "preview/looks.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "core/error.hpp"
#include "io/scratch.hpp"
#include "preview/pictures.hpp"
#include "preview/png.hpp"
#include "preview/preview.hpp"
#include "preview/srgb.hpp"
#include "support/paths.hpp"

namespace toile::internal {
namespace {

const std::vector<ClothPart> run{{0, "shirt", "front", "cotton"},
                                 {0, "shirt", "collar", "cotton"},
                                 {1, "coat", "coat/front", "wool"},
                                 {1, "coat", "coat/sleeve", "wool"}};

Looks looks_in(const std::string& rules) { return Looks::parse("{\"looks\": [" + rules + "]}", "looks.json"); }
Vec3f colour_in(const std::string& rules, std::size_t part) {
  const Looks looks = looks_in(rules);
  looks.check(run);
  const ClothLook look = looks.look_of(run[part], look_of(run[part].fabric));
  return mean_colour(look, true);
}
const Vec3f red = Vec3f(srgb_decoded(200 / 255.0f), srgb_decoded(16 / 255.0f), srgb_decoded(32 / 255.0f));
const std::string paint_red = "\"colour\": \"#c81020\"}", paint_black = "\"colour\": \"#000000\"}";

bool is(const Vec3f& a, const Vec3f& b) { return (a - b).cwiseAbs().maxCoeff() < 1e-3f; }

TEST(Looks, AColourIsSRGBAndThatOfTheRightSide) {
  for (const char* fabric : {"cotton", "denim", "silk", "knit", "leather", "wool", "linen"}) {
    const ClothPart part{0, "shirt", "front", fabric};
    const ClothLook look = looks_in("{" + paint_red).look_of(part, look_of(fabric));
    EXPECT_TRUE(is(mean_colour(look, true), red)) << fabric << ' ' << mean_colour(look, true).transpose();
  }
  EXPECT_TRUE(is(colour_in("{\"colour\": [200, 16, 32]}", 0), red));
  EXPECT_TRUE(is(colour_in("{\"colour\": \"#C81020\"}", 0), red));
  // No cloth reflects all light, and no thread of it does.
  const ClothLook white = looks_in("{\"colour\": \"#ffffff\"}").look_of({0, "", "", "denim"}, look_of("denim"));
  EXPECT_TRUE(is(mean_colour(white, true), Vec3f::Constant(whitest)));
  EXPECT_LE(white.weft.maxCoeff(), whitest + 1e-4f);
}

TEST(Looks, ARuleIsOfTheNamesThatItGives) {
  const Vec3f own = mean_colour(look_of("wool"), true);
  const auto painted = [](const std::string& names) {
    std::string which;
    for (std::size_t p = 0; p < run.size(); ++p)
      which += is(colour_in("{" + names + ", " + paint_red, p), red) ? 'x' : '.';
    return which;
  };
  EXPECT_EQ(painted("\"sheen\": 0.1"), "xxxx");
  EXPECT_EQ(painted("\"garment\": 1"), "..xx");
  EXPECT_EQ(painted("\"garment\": \"shirt\""), "xx..");
  EXPECT_EQ(painted("\"garment\": [\"shirt\", \"coat\"]"), "xxxx");
  EXPECT_EQ(painted("\"fabric\": \"wool\""), "..xx");
  EXPECT_EQ(painted("\"panel\": \"front\""), "x.x.") << "of any garment";
  EXPECT_EQ(painted("\"panel\": \"coat/front\""), "..x.");
  EXPECT_EQ(painted("\"panel\": [\"collar\", \"sleeve\"]"), ".x.x");
  EXPECT_EQ(painted("\"panel\": \"front\", \"fabric\": \"wool\""), "..x.");
  EXPECT_TRUE(is(colour_in("{\"garment\": 0, " + paint_red, 2), own)) << "as it was";
}

TEST(Looks, LaterRulesReplaceWhatTheySay) {
  EXPECT_TRUE(is(colour_in("{\"panel\": \"front\", " + paint_red + ", {" + paint_black, 0), Vec3f::Zero()));
  EXPECT_TRUE(is(colour_in("{" + paint_black + ", {\"panel\": \"front\", " + paint_red, 0), red));
  const Looks looks = looks_in("{\"gloss\": 0.2, \"sheen\": 0, \"roughness\": 0.3, " + paint_red +
                               ", {\"gloss\": 0.1, \"stitch\": \"#000000\"}");
  const ClothLook look = looks.look_of(run[0], look_of("cotton"));
  EXPECT_TRUE(is(mean_colour(look, true), red));
  EXPECT_FLOAT_EQ(look.gloss, 0.1f);
  EXPECT_FLOAT_EQ(look.sheen, 0.0f);
  EXPECT_FLOAT_EQ(look.roughness, 0.3f);
  EXPECT_TRUE(is(look.stitch, Vec3f::Zero()));
  const std::string striped = "{\"print\": {\"stripes\": [[\"#ffffff\", 10]]}}, {" + paint_red;
  EXPECT_TRUE(is(colour_in(striped, 0), Vec3f::Constant(whitest))) << "the print covers the ground";
  EXPECT_TRUE(is(colour_in(striped + ", {\"print\": \"none\"}", 0), red));
}

// Of threads that are dyed both sides show the pattern; what is printed shows through a little.
TEST(Looks, TheWrongSideShowsPrintsWeaker) {
  const Vec2 middle(0, 0);
  const Vec2f fine = Vec2f::Constant(0.002f);
  const auto side = [&](const std::string& print, bool right_side) -> Vec3f {
    const Looks looks = looks_in("{\"colour\": \"#000000\", \"print\": " + print + "}");
    ClothLook look = looks.look_of(run[0], look_of("poplin"));
    look.uneven = 0;
    return thread_colour(look, right_side, middle, fine);
  };
  const std::string dots = R"({"dots": {"colour": "#ffffff", "diameter_mm": 10, "spacing_mm": 20})";
  EXPECT_TRUE(is(side(dots + "}", true), Vec3f::Constant(whitest)));
  EXPECT_TRUE(is(side(dots + "}", false), Vec3f::Constant(0.25f * whitest)));
  EXPECT_TRUE(is(side(dots + ", \"through\": 0}", false), Vec3f::Zero()));
  const std::string stripes = R"({"stripes": [["#ffffff", 10]])";
  EXPECT_TRUE(is(side(stripes + "}", false), Vec3f::Constant(whitest)));
  EXPECT_TRUE(is(side(stripes + ", \"through\": 0.5}", false), Vec3f::Constant(0.5f * whitest)));
}

// Half the threads that show are the warp's, on cloth of any weave.
TEST(Looks, ACheckMixesWarpAndWeftEvenly) {
  for (const char* fabric : {"cotton", "wool", "silk", "knit", "leather"}) {
    const Looks looks = looks_in(R"({"print": {"check": [["#ffffff", 10], ["#000000", 10]]}})");
    ClothLook look = looks.look_of({0, "", "", fabric}, look_of(fabric));
    look.uneven = 0;
    const auto at = [&](double x, double y, bool right_side) {
      return thread_colour(look, right_side, Vec2(x, y), Vec2f::Constant(0.004f)).y();
    };
    for (const bool right_side : {true, false}) {
      EXPECT_NEAR(at(0.005, 0.005, right_side), whitest, 1e-3f) << fabric;
      EXPECT_NEAR(at(0.015, 0.005, right_side), 0.5f * whitest, 1e-3f) << fabric;
      EXPECT_NEAR(at(0.005, 0.015, right_side), 0.5f * whitest, 1e-3f) << fabric;
      EXPECT_NEAR(at(0.015, 0.015, right_side), 0.0f, 1e-3f) << fabric;
    }
  }
}

TEST(Looks, ACheckOfTwillKeepsItsMeanCloseUp) {
  const Looks looks = looks_in(R"({"print": {"check": [["#c81020", 10]]}})");
  ClothLook look = looks.look_of({0, "", "", "wool"}, look_of("wool"));
  Vec3f sum = Vec3f::Zero();
  constexpr int samples = 400;
  for (int i = 0; i < samples; ++i)
    for (int j = 0; j < samples; ++j)
      sum += thread_colour(look, true, Vec2(0.018 * (i + 0.5) / samples, 0.018 * (j + 0.5) / samples),
                           Vec2f(1e-6f, 1e-6f));
  EXPECT_LT((sum / (samples * samples) - red).cwiseAbs().maxCoeff(), 0.02f);
}

std::string error_of(const std::string& rules) {
  try {
    looks_in(rules).check(run);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Looks, RefusesWhatCannotBeMeantAndSaysWhere) {
  const std::vector<std::array<std::string, 2>> wrong = {
      {R"({"color": "#ffffff"})", "looks.json:1:22: /looks/0/color: expected"},
      {R"({"color": "#ffffff"})", "\"colour\""},
      {R"({"panel": "front"})", "at least one of \"colour\""},
      {R"({"colour": "#fff"})", "/looks/0/colour: expected a colour, \"#rrggbb\""},
      {R"({"colour": "#gg0000"})", "/looks/0/colour"},
      {R"({"colour": "#+10000"})", "/looks/0/colour"},
      {R"({"colour": "#-10000"})", "/looks/0/colour"},
      {R"({"colour": [0.2, 0.4, 0.1]})", "/looks/0/colour/0: expected a whole number from 0 to 255, got 0.2"},
      {R"({"colour": [0, 256, 1]})", "/looks/0/colour/1"},
      {R"({"colour": [1, 2]})", "/looks/0/colour"},
      {R"({"sheen": 2})", "/looks/0/sheen: expected a number of at least 0 and at most 1, got 2"},
      {R"({"colour": "#ffffff"}, {"print": {}})", "/looks/1/print: expected one of \"stripes\""},
      {R"({"print": {"stripes": [["#ffffff", 3]], "dots": {}}})", "got 2 of them"},
      {R"({"print": {"stripes": []}})", "/looks/0/print/stripes: expected bands"},
      {R"({"print": {"stripes": [["#ffffff", 0]]}})", "/looks/0/print/stripes/0/1: expected a number"},
      {R"({"print": {"stripes": ["#ffffff"]}})", "/looks/0/print/stripes/0: expected a band"},
      {R"({"print": {"check": [["white", 4]]}})", "/looks/0/print/check/0/0: expected a colour"},
      {R"({"print": {"stripes": [["#ffffff", 3]], "width_mm": 4}})", "/looks/0/print/width_mm"},
      {R"({"print": {"dots": {"colour": "#ffffff", "diameter_mm": 5, "spacing_mm": 4}}})",
       "at most spacing_mm, 4, got 5"},
      {R"({"print": {"dots": {"colour": "#ffffff", "diameter_mm": 5}}})", "spacing_mm"},
      {R"({"print": {"stripes": [["#ffffff", 3]], "offset_mm": 4}})", "/looks/0/print/offset_mm: expected two numbers"},
      {R"({"print": {"stripes": [["#ffffff", 3]], "turn_deg": 400}})", "/looks/0/print/turn_deg"},
      {R"({"print": {"stripes": [["#ffffff", 3]], "through": 1.5}})", "/looks/0/print/through"},
      {R"({"print": "plain"})", "/looks/0/print: expected an object"},
      {R"({"print": {"image": "not_there.png", "width_mm": 4}})", "/looks/0/print/image: expected a PNG picture"},
      {R"({"print": {"image": "not_there.png", "width_mm": 4}})", "not_there.png"},
      {R"({"panel": "colar", "colour": "#ffffff"})",
       "/looks/0/panel: expected a panel of this run: \"coat/front\", \"coat/sleeve\", \"collar\", \"front\"; nearest "
       "is "
       "\"collar\", got \"colar\""},
      {R"({"garment": 2, "colour": "#ffffff"})", "/looks/0/garment: expected a garment of this run: 0 to 1, got 2"},
      {R"({"garment": -1, "colour": "#ffffff"})", "/looks/0/garment"},
      {R"({"garment": "coats", "colour": "#ffffff"})", "nearest is \"coat\""},
      {R"({"fabric": "denim", "colour": "#ffffff"})", "expected a fabric of this run: \"cotton\", \"wool\""},
      {R"({"fabric": "wool", "panel": "collar", "colour": "#ffffff"})", "/looks/0: expected names that one panel"},
      {R"({"panel": [], "colour": "#ffffff"})", "/looks/0/panel: expected a name or a list"},
  };
  for (const auto& [rules, words] : wrong) {
    const std::string error = error_of(rules);
    EXPECT_NE(error.find(words), std::string::npos) << rules << "\n  " << error << "\n  " << words;
    EXPECT_EQ(error.find("looks.json:"), 0u) << error;
  }
  EXPECT_EQ(error_of(R"({"panel": "collar", "colour": "#ffffff"})"), "");
  EXPECT_THROW(Looks::parse("[]", "looks.json"), InputError);
  EXPECT_THROW(Looks::parse(R"({"look": []})", "looks.json"), InputError);
}

Image quarters() {  // from the top: red and green, blue and white
  return {2, 2, {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}};
}

TEST(Looks, ReadsAPictureBesideTheFile) {
  const Scratch scratch;
  std::filesystem::create_directories(scratch / "motifs");
  write_png(scratch / "motifs/four.png", quarters());
  scratch.put("looks.json", R"({"looks": [{"print": {"image": "motifs/four.png", "width_mm": 200}}]})");
  const Looks looks = Looks::load(scratch / "looks.json");
  EXPECT_EQ(looks.files(), (std::vector<std::string>{scratch / "looks.json", scratch / "motifs/four.png"}));
  const ClothLook look = looks.look_of(run[0], look_of("cotton"));
  ASSERT_TRUE(look.print);
  const Vec2f fine = Vec2f::Constant(1e-6f);
  EXPECT_TRUE(is(look.print->at({0.05, 0.15}, fine).warp, Vec3f(whitest, 0, 0)));
  EXPECT_TRUE(is(look.print->at({0.15, 0.05}, fine).warp, Vec3f::Constant(whitest)));

  scratch.put("motifs/four.png", "GIF89a, say");
  try {
    Looks::load(scratch / "looks.json");
    FAIL();
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("/looks/0/print/image: expected a PNG picture"), std::string::npos) << what;
    EXPECT_NE(what.find("four.png"), std::string::npos) << what;
  }
}

TEST(Looks, TheExamplesAreRead) {
  for (const char* name : {"breton", "check", "gingham", "motif"}) {
    const Looks looks = Looks::load(test::source_path(std::string("examples/looks_") + name + ".json"));
    EXPECT_TRUE(looks.look_of(run[0], look_of("cotton")).print) << name;
  }
}

TEST(Looks, APngComesBackAsItWasWrittenAndACutOneIsRefused) {
  const Image image = quarters();
  const std::string bytes = png_of(image, "");
  const RgbaImage back = parse_png(bytes, "four.png");
  ASSERT_EQ(back.width, 2);
  ASSERT_EQ(back.height, 2);
  for (std::size_t p = 0; p < 4; ++p)
    for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(back.rgba[4 * p + k], k < 3 ? image.rgb[3 * p + k] : 255);
  for (const std::size_t size : {std::size_t{0}, std::size_t{5}, std::size_t{30}, bytes.size() - 20})
    EXPECT_THROW(parse_png(bytes.substr(0, size), "four.png"), InputError) << size;
}

// upright_square in n x n squares: their subdivision leaves it as it is, but for its corners.
Sheet upright_grid(const Vec3& centre, double side, int n) {
  Sheet s;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      s.positions.push_back(centre + side * Vec3(double(i) / n - 0.5, double(j) / n - 0.5, 0));
  const auto uv = [&](Index i) { return Vec2(side * (i % (n + 1)) / n, side * (i / (n + 1)) / n); };
  for (Index j = 0; j < n; ++j)
    for (Index i = 0; i < n; ++i) {
      const Index a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
      for (const Triangle& t : {Triangle{a, b, c}, Triangle{a, c, d}}) {
        s.triangles.push_back(t);
        s.uv.push_back({uv(t[0]), uv(t[1]), uv(t[2])});
      }
    }
  return s;
}

// A square metre that fills the picture, with the four quarters of a picture on it; seen from behind it is printed weaker, on white, the other way
// round.
TEST(Looks, APictureShowsThePrintWhereItLies) {
  const Scratch scratch;
  write_png(scratch / "four.png", quarters());
  scratch.put(
      "looks.json",
      R"({"looks": [{"colour": "#ffffff", "print": {"image": "four.png", "width_mm": 1000, "height_mm": 1000}}]})");
  const Looks all = Looks::load(scratch / "looks.json");
  const Sheet square = upright_grid({0, 1, 0}, 1, 20);
  const std::vector<ClothLook> looks{all.look_of(run[0], look_of("poplin"))};
  const std::vector<Index> look(square.triangles.size(), 0);
  PreviewScene scene;
  scene.cloths.push_back(cloth_of(square));
  scene.cloths[0].looks = looks;
  scene.cloths[0].look = look;
  RenderOptions options;
  options.width = options.height = 64;
  options.samples = 16;
  const auto shown = [&](double eye_z) {
    const Camera camera{{0, 1, eye_z}, {0, 1, 0}, 20};
    const Image image = render(scene, camera, options);
    std::vector<std::array<int, 3>> pixels;
    for (const Vec3& p : {Vec3(-0.25, 1.25, 0), Vec3(0.25, 1.25, 0), Vec3(-0.25, 0.75, 0), Vec3(0.25, 0.75, 0)}) {
      const Vec3 at = project(camera, 64, 64, p);
      pixels.push_back(pixel(image, static_cast<int>(at.x()), static_cast<int>(at.y())));
    }
    return pixels;
  };
  // Of a pixel: its channel k, and the brighter of the two others.
  const auto own_and_other = [](const std::array<int, 3>& p, std::size_t k) {
    return std::array{p[k], std::max(p[(k + 1) % 3], p[(k + 2) % 3])};
  };
  const auto front = shown(3), back = shown(-3);
  for (std::size_t k = 0; k < 3; ++k) {  // the red, the green and the blue quarter
    const auto [own, other] = own_and_other(front[k], k);
    EXPECT_GT(own, 2 * other + 40) << "quarter " << k;
    const auto [through, ground] = own_and_other(back[k], k);
    EXPECT_GT(through, ground + 8) << "shows through, quarter " << k;
    EXPECT_LT(through, 2 * ground) << "quarter " << k;
  }
  EXPECT_GT(*std::min_element(front[3].begin(), front[3].end()), 150);
}

TEST(Looks, AHemShowsTheRightSideInside) {
  const Sheet square = upright_grid({0, 1, 0}, 1, 20);
  std::vector<ClothLook> looks{
      looks_in(R"({"colour": "#ffffff", "print": {"stripes": [["#c81020", 9]], "through": 0}})")
          .look_of(run[0], look_of("poplin"))};
  looks[0].hem_m = 0.1f;
  const std::vector<Index> look(square.triangles.size(), 0);
  PreviewScene scene;
  scene.cloths.push_back(cloth_of(square));
  scene.cloths[0].looks = looks;
  scene.cloths[0].look = look;
  RenderOptions options;
  options.width = options.height = 64;
  const Camera camera{{0, 1, -3}, {0, 1, 0}, 20};
  const Image image = render(scene, camera, options);
  const auto redness = [&](const Vec3& p) {
    const Vec3 on = project(camera, 64, 64, p);
    const std::array<int, 3> c = pixel(image, static_cast<int>(on.x()), static_cast<int>(on.y()));
    return static_cast<double>(c[0]) / c[1];
  };
  EXPECT_LT(redness({0, 1, 0}), 1.2);
  EXPECT_GT(redness({0.45, 1.1, 0}), 2);
}

// One and a half pixels from stripe to stripe: an even grey, without a wave that is not in the cloth.
TEST(Looks, FineStripesDoNotBeatWithThePixels) {
  const Sheet square = upright_grid({0, 1, 0}, 2, 20);
  const std::vector<ClothLook> looks{
      looks_in(R"({"print": {"stripes": [["#ffffff", 12.4], ["#000000", 12.4]]}})").look_of(run[0], look_of("poplin"))};
  const std::vector<Index> look(square.triangles.size(), 0);
  PreviewScene scene;
  scene.cloths.push_back(cloth_of(square));
  scene.cloths[0].looks = looks;
  scene.cloths[0].look = look;
  RenderOptions options;
  options.width = options.height = 64;
  options.samples = 64;
  const Image image = render(scene, {{0, 1, 3}, {0, 1, 0}, 20}, options);
  double sum = 0, squares = 0;
  int count = 0;
  for (int x = 8; x < 56; ++x) {
    double column = 0;
    for (int y = 8; y < 56; ++y) column += brightness(pixel(image, x, y)) / 3.0 / 48;
    sum += column;
    squares += column * column;
    ++count;
  }
  const double mean = sum / count;
  EXPECT_GT(mean, 100);
  EXPECT_LT(std::sqrt(squares / count - mean * mean), 0.02 * mean);
}

TEST(Looks, TheTechnicalStyleHasAColourOfEachTriangle) {
  const Sheet square = upright_square({0, 1, 0}, 1);
  const std::vector<Vec3> colours{Vec3(0.6, 0.05, 0.05), Vec3(0.05, 0.05, 0.6)};
  PreviewScene scene;
  scene.cloths.push_back(cloth_of(square));
  scene.cloths[0].colours = colours;
  RenderOptions options;
  options.width = options.height = 64;
  const Camera camera{{0, 1, 3}, {0, 1, 0}, 20};
  const Image image = render(scene, camera, options);
  const auto at = [&](const Vec3& p) {
    const Vec3 on = project(camera, 64, 64, p);
    return pixel(image, static_cast<int>(on.x()), static_cast<int>(on.y()));
  };
  const auto lower = at({0.25, 0.75, 0}), upper = at({-0.25, 1.25, 0});
  EXPECT_GT(lower[0], 2 * lower[2]);
  EXPECT_GT(upper[2], 2 * upper[0]);
  scene.cloths[0].colours = std::span(colours).first(1);
  EXPECT_THROW(render(scene, camera, options), InputError);
}

TEST(Looks, TheTechnicalColourIsTheMeanOfThePrint) {
  const Looks looks = looks_in(R"({"panel": "front", "print": {"stripes": [["#c81020", 10], ["#000000", 10]]}})");
  const auto colour = looks.colour_of(run[0], look_of("cotton"));
  ASSERT_TRUE(colour);
  EXPECT_TRUE(is(*colour, 0.5f * red));
  EXPECT_FALSE(looks.colour_of(run[1], look_of("cotton")));
}

}  // namespace
}  // namespace toile::internal
