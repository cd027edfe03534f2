#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <utility>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "preview/cloth_look.hpp"
#include "preview/pictures.hpp"
#include "preview/preview.hpp"

namespace toile::internal {
namespace {

RenderOptions small(int width = 96, int height = 96, int samples = 8) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.samples = samples;
  return options;
}

// A cloth before a body on the ground.
struct Stage {
  Sheet ball = sphere({0, 0.5, 0}, 0.3);
  Sheet square = upright_square({0.25, 0.6, 0.4}, 0.3);
  PreviewScene scene() const {
    PreviewScene s;
    s.cloths.push_back(cloth_of(square));
    s.body_triangles = ball.triangles;
    s.body_positions = ball.positions;
    return s;
  }
};
const Camera front{{0, 0.5, 3}, {0, 0.5, 0}, 28};

TEST(Render, IsTheSameToTheBitOnAnyNumberOfThreads) {
  const Stage stage;
  Image one;
  with_threads(1, [&] { one = render(stage.scene(), front, small()); });
  for (const int threads : {2, 5}) {
    Image many;
    with_threads(threads, [&] { many = render(stage.scene(), front, small()); });
    EXPECT_EQ(one.rgb, many.rgb) << threads << " threads";
  }
}

// The same stage as in a studio: the square is silk.
struct Studio : Stage {
  std::vector<ClothLook> looks{look_of("silk")};
  std::vector<Index> look = std::vector<Index>(square.triangles.size(), 0);
  PreviewScene scene() const {
    PreviewScene s = Stage::scene();
    s.cloths[0].looks = looks;
    s.cloths[0].look = look;
    return s;
  }
};

TEST(Render, AStudioPictureIsTheSameToTheBitOnAnyNumberOfThreads) {
  const Studio studio;
  Image one;
  with_threads(1, [&] { one = render(studio.scene(), front, small()); });
  EXPECT_NE(one.rgb, render(studio.Stage::scene(), front, small()).rgb);
  for (const int threads : {2, 5}) {
    Image many;
    with_threads(threads, [&] { many = render(studio.scene(), front, small()); });
    EXPECT_EQ(one.rgb, many.rgb) << threads << " threads";
  }
}

TEST(Render, AStudioPictureNamesLooksThatDoNotFit) {
  Studio studio;
  studio.look.pop_back();
  EXPECT_THROW(render(studio.scene(), front, small()), InputError);
  studio.look.push_back(1);
  EXPECT_THROW(render(studio.scene(), front, small()), InputError);
}

// A square that reflects the key light to the camera is brighter where it is glossy, and its colour is that of the light.
TEST(Render, GlossAddsTheLightThatIsMirrored) {
  Studio studio;
  const auto middle = [&](float gloss) {
    studio.looks[0].gloss = gloss;
    return pixel(render(studio.scene(), Camera{{0.25, 0.6, 3}, {0.25, 0.6, 0.4}, 10}, small(48, 48, 64)), 24, 24);
  };
  const std::array<int, 3> matt = middle(0), glossy = middle(0.3f);
  EXPECT_GT(brightness(glossy), brightness(matt) + 15);
}

TEST(Render, DoesNotDependOnThePicturesBefore) {
  const Stage stage;
  PreviewScene other = stage.scene();
  other.cloths.clear();
  Renderer renderer(small());
  const Image first = renderer.render(stage.scene(), front);
  renderer.render(other, front);
  EXPECT_EQ(first.rgb, renderer.render(stage.scene(), front).rgb);
  EXPECT_NE(first.rgb, renderer.render(other, front).rgb);
  EXPECT_EQ(first.rgb, render(stage.scene(), front, small()).rgb);
}

TEST(Render, ShowsTheBodyWhereItProjects) {
  const Stage stage;
  PreviewScene with = stage.scene();
  with.cloths.clear();
  PreviewScene without;
  const Image a = render(with, front, small()), b = render(without, front, small());
  EXPECT_GT(std::set<std::uint8_t>(a.rgb.begin(), a.rgb.end()).size(), 40u);
  int changed_inside = 0, inside = 0;
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 96; ++x) {
      // Distance of the pixel's ray to the sphere's centre decides what it meets.
      const Vec3 centre = project(front, 96, 96, {0, 0.5, 0});
      const double pixel_radius = 0.3 / std::sqrt(9 - 0.09) * 48 / std::tan(14 * M_PI / 180);
      const double r = std::hypot(x + 0.5 - centre.x(), y + 0.5 - centre.y());
      const int difference = std::abs(brightness(pixel(a, x, y)) - brightness(pixel(b, x, y)));
      if (r < pixel_radius - 2) {
        ++inside;
        changed_inside += difference > 12 ? 1 : 0;
      }
      if (r > pixel_radius + 2 && y < 40) {  // above: nothing but background
        EXPECT_LE(difference, 1) << x << ',' << y;
      }
    }
  }
  EXPECT_GT(inside, 500);
  EXPECT_EQ(changed_inside, inside);
}

TEST(Render, PutsNearClothBeforeTheBodyAndDrawsItInItsColour) {
  const Stage stage;
  PreviewScene scene = stage.scene();
  scene.cloths[0].colour = {0.6, 0.05, 0.05};
  const Image image = render(scene, front, small());
  const Vec3 p = project(front, 96, 96, {0.2, 0.55, 0.4});
  const auto red = pixel(image, static_cast<int>(p.x()), static_cast<int>(p.y()));
  EXPECT_GT(red[0], 2 * red[1]);
  EXPECT_GT(red[0], 100);
}

TEST(Render, CastsAShadowOnTheGroundAndLeavesTheRestAsItWas) {
  const Sheet ball = sphere({0, 0.3, 0}, 0.3);
  PreviewScene with, without;
  with.body_triangles = ball.triangles;
  with.body_positions = ball.positions;
  const Camera camera{{0, 1.2, 3}, {0, 0.2, 0}, 50};
  const Image a = render(with, camera, small()), b = render(without, camera, small());
  const auto darker_at = [&](const Vec3& point) {
    const Vec3 p = project(camera, 96, 96, point);
    const int x = static_cast<int>(p.x()), y = static_cast<int>(p.y());
    return brightness(pixel(b, x, y)) - brightness(pixel(a, x, y));
  };
  EXPECT_GT(darker_at({0.12, 0, 0.2}), 30);    // under the ball
  EXPECT_GT(darker_at({0.35, 0, -0.25}), 60);  // away from the key light
  EXPECT_LT(darker_at({-0.6, 0, 0.7}), 25);    // towards it
  EXPECT_EQ(pixel(a, 1, 94), pixel(b, 1, 94));
}

TEST(Render, KeepsTheShadowOfWhatHangsHighAboveTheGround) {
  const Sheet ball = sphere({0, 2, 0}, 0.3);
  PreviewScene with, without;
  with.body_triangles = ball.triangles;
  with.body_positions = ball.positions;
  const Camera camera{{0, 6, 9}, {0, 0, 0}, 40};
  const Image a = render(with, camera, small()), b = render(without, camera, small());
  // The key light comes from the left and the front, about 47 degrees high.
  const Vec3 p = project(camera, 96, 96, {1.40, 0, -1.23});
  const int x = static_cast<int>(p.x()), y = static_cast<int>(p.y());
  EXPECT_GT(brightness(pixel(b, x, y)) - brightness(pixel(a, x, y)), 30);
  EXPECT_EQ(pixel(a, 48, 94), pixel(b, 48, 94));
}

// The same triangles in space, with half the pattern coordinates: cloth stretched to twice its size.
TEST(Render, DrawsTheGridInPatternCoordinatesSoThatStretchShows) {
  const auto lines = [](double uv_scale) {
    Sheet square = upright_square({0, 1, 0}, 0.4, uv_scale);
    PreviewScene scene;
    scene.cloths.push_back(cloth_of(square));
    RenderOptions options = small(400, 400, 8);
    options.grid_m = 0.04;
    // The square fills the picture: 1 px = 1 mm; y = 1.02 lies between two lines of constant v.
    const Camera camera{{0, 1, 2}, {0, 1, 0}, 2 * std::atan(0.1) * 180 / M_PI};
    return dark_lines(render(scene, camera, options), 180, 10, 390, 60);
  };
  const std::vector<double> rest = lines(1.0), stretched = lines(0.5);
  ASSERT_EQ(rest.size(), 9u);
  for (std::size_t i = 0; i < rest.size(); ++i) EXPECT_NEAR(rest[i], 40 * (static_cast<int>(i) + 1), 1.5);
  ASSERT_EQ(stretched.size(), 4u);
  for (std::size_t i = 0; i < stretched.size(); ++i) EXPECT_NEAR(stretched[i], 80 * (static_cast<int>(i) + 1), 1.5);
}

TEST(Render, DrawsTheWrongSideDarkerAndPalerButNotBlack) {
  Sheet square = upright_square({0, 1, 0}, 1);
  PreviewScene scene;
  scene.cloths.push_back({square.triangles, {}, square.positions, Vec3(0.1, 0.2, 0.6)});
  const Camera camera{{0, 1, 3}, {0, 1, 0}, 10};
  const auto right = pixel(render(scene, camera, small(16, 16)), 8, 8);
  for (Triangle& t : square.triangles) std::swap(t[1], t[2]);
  const auto wrong = pixel(render(scene, camera, small(16, 16)), 8, 8);
  EXPECT_LT(brightness(wrong), 0.85 * brightness(right));
  EXPECT_GT(brightness(wrong), 120);
  EXPECT_LT(wrong[2] - wrong[0], 0.6 * (right[2] - right[0]));
}

// Light from behind must not show in front, whatever the smooth normals say.
TEST(Render, LetsNoLightThroughClothInFrontOfDarkness) {
  // A closed black-lined box is not needed: a sphere seen from inside gets no light at all but from its own surface.
  Sheet ball = sphere({0, 2, 0}, 0.5, 6);
  for (Triangle& t : ball.triangles) std::swap(t[1], t[2]);
  PreviewScene scene;
  scene.cloths.push_back({ball.triangles, {}, ball.positions, Vec3(0.5, 0.5, 0.5)});
  const Image inside = render(scene, {{0, 2, 0}, {0, 2, 0.4}, 60}, small(48, 48, 32));
  int brightest = 0;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 48; ++x) brightest = std::max(brightest, brightness(pixel(inside, x, y)));
  }
  // What remains is the light that is assumed after the last bounce: evenly dim, no bright cracks.
  EXPECT_LT(brightest, 3 * 110);
}

const std::vector<Vec3> box_corners = {{-0.3, 0.2, 0.3},  {0.3, 0.2, 0.3},  {0.3, 0.8, 0.3},  {-0.3, 0.8, 0.3},
                                       {-0.3, 0.2, -0.3}, {0.3, 0.2, -0.3}, {0.3, 0.8, -0.3}, {-0.3, 0.8, -0.3}};
const std::vector<Triangle> box_faces = {{0, 1, 2}, {0, 2, 3}, {5, 4, 7}, {5, 7, 6}, {4, 0, 3}, {4, 3, 7},
                                         {1, 5, 6}, {1, 6, 2}, {3, 2, 6}, {3, 6, 7}, {4, 5, 1}, {4, 1, 0}};

// A body that faces inwards is a room: what is in it is seen, and lit.
TEST(Render, LooksIntoARoomAndLetsLightIn) {
  std::vector<Triangle> inwards = box_faces;
  for (Triangle& t : inwards) std::swap(t[1], t[2]);
  const Sheet square = upright_square({0, 0.5, 0}, 0.2);
  PreviewScene solid, room, alone;
  for (PreviewScene* s : {&solid, &room, &alone}) s->cloths.push_back(cloth_of(square));
  solid.body_triangles = box_faces;
  room.body_triangles = inwards;
  solid.body_positions = room.body_positions = box_corners;
  const Vec3 centre = project(front, 96, 96, {0.011, 0.511, 0});
  const int x = static_cast<int>(centre.x()), y = static_cast<int>(centre.y());
  const auto at_centre = [&](const PreviewScene& scene) { return pixel(render(scene, front, small()), x, y); };
  const auto in_box = at_centre(solid), in_room = at_centre(room), open = at_centre(alone);
  EXPECT_GT(in_room[2], in_room[0] + 15) << "blue cloth";
  EXPECT_LT(in_box[2], in_box[0] + 5) << "clay";
  EXPECT_GT(brightness(in_room), 0.5 * brightness(open));
}

TEST(Render, ABoxHasFlatFaces) {
  // Its front face, seen straight on, is one colour from the middle to the corner; smooth normals would darken it.
  PreviewScene scene;
  scene.body_triangles = box_faces;
  scene.body_positions = box_corners;
  const Image image = render(scene, front, small(96, 96, 64));
  const auto bright = [&](const Vec3& p) {
    const Vec3 at = project(front, 96, 96, p);
    return brightness(pixel(image, static_cast<int>(at.x()), static_cast<int>(at.y())));
  };
  const double middle = bright({0, 0.5, 0.3});
  for (const Vec3& corner :
       {Vec3(-0.27, 0.76, 0.3), Vec3(0.27, 0.76, 0.3), Vec3(0.27, 0.6, 0.3), Vec3(-0.27, 0.6, 0.3)})
    EXPECT_NEAR(bright(corner) / middle, 1, 0.06) << corner.transpose();
}

// Beside a fold of 170 degrees the mean normal of both sides would point along the cloth.
TEST(Render, APressedFoldHasFlatSides) {
  const double back = 0.6 * std::cos(10 * 3.14159265358979323846 / 180),
               away = 0.6 * std::sin(10 * 3.14159265358979323846 / 180);
  const std::vector<Vec3> corners = {{-0.3, 0.2, 0.3},
                                     {0.3, 0.2, 0.3},
                                     {0.3, 0.8, 0.3},
                                     {-0.3, 0.8, 0.3},
                                     {0.3 - back, 0.2, 0.3 - away},
                                     {0.3 - back, 0.8, 0.3 - away}};
  const std::vector<Triangle> faces = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
  PreviewScene scene;
  scene.cloths.push_back({faces, {}, corners, Vec3(0.5, 0.5, 0.5)});
  const Image image = render(scene, front, small(96, 96, 64));
  const auto bright = [&](const Vec3& p) {
    const Vec3 at = project(front, 96, 96, p);
    return brightness(pixel(image, static_cast<int>(at.x()), static_cast<int>(at.y())));
  };
  for (const double y : {0.3, 0.5, 0.7})
    EXPECT_NEAR(bright({0.25, y, 0.3}) / double(bright({-0.2, y, 0.3})), 1, 0.06) << y;
}

TEST(Render, DrawsCrossingsOverEverything) {
  const Stage stage;
  PreviewScene scene = stage.scene();
  const Image before = render(scene, front, small());
  scene.red_segments = {{Vec3(-0.1, 0.5, -0.1), Vec3(0.0, 0.5, -0.1)},  // inside the body
                        {Vec3(0.2, 0.6, 0.41), Vec3(0.2, 0.6, 0.41)},   // a dot
                        {Vec3(0, 0.4, 0), Vec3(0, 0.4, 50)},            // past the camera
                        {Vec3(0, std::numeric_limits<double>::quiet_NaN(), 0), Vec3(0, 0, 0)}};
  const Image after = render(scene, front, small());
  for (const Vec3& point : {Vec3(-0.05, 0.5, -0.1), Vec3(0.2, 0.6, 0.41), Vec3(0, 0.4, 0.0)}) {
    const Vec3 p = project(front, 96, 96, point);
    const int x = static_cast<int>(p.x()), y = static_cast<int>(p.y());
    const auto red = pixel(after, x, y);
    EXPECT_GT(red[0], 180);
    EXPECT_LT(red[1], 140);
    EXPECT_NE(pixel(before, x, y), red);
  }
  EXPECT_EQ(pixel(before, 5, 5), pixel(after, 5, 5));
}

TEST(Render, SmoothsTheLightOfFewSamplesTowardsThatOfMany) {
  const Stage stage;
  PreviewScene scene = stage.scene();
  RenderOptions few = small(96, 96, 4), many = small(96, 96, 512);
  many.denoise = false;
  const Image truth = render(scene, front, many);
  const auto error = [&](bool denoise) {
    few.denoise = denoise;
    const Image image = render(scene, front, few);
    double sum = 0;
    for (std::size_t i = 0; i < image.rgb.size(); ++i) sum += std::pow(image.rgb[i] - truth.rgb[i], 2);
    return std::sqrt(sum / static_cast<double>(image.rgb.size()));
  };
  const double raw = error(false), smooth = error(true);
  EXPECT_LT(smooth, 0.6 * raw);
  EXPECT_LT(smooth, 4.0);
}

TEST(Render, LooksTheSameFarFromTheOrigin) {
  Stage stage;
  const Image here = render(stage.scene(), front, small());
  const Vec3 far(4096, 0, -8192);
  for (Vec3& p : stage.ball.positions) p += far;
  for (Vec3& p : stage.square.positions) p += far;
  const Image there = render(stage.scene(), {front.eye + far, front.target + far, 28}, small());
  double difference = 0;
  for (std::size_t i = 0; i < here.rgb.size(); ++i) difference += std::abs(here.rgb[i] - there.rgb[i]);
  EXPECT_LT(difference / static_cast<double>(here.rgb.size()), 0.05);
}

TEST(Render, LightsTheBackAsWellAsTheFront) {
  const Sheet ball = sphere({0, 0.5, 0}, 0.3);
  PreviewScene scene;
  scene.body_triangles = ball.triangles;
  scene.body_positions = ball.positions;
  const Image a = render(scene, front, small());
  const Image b = render(scene, {{0, 0.5, -3}, {0, 0.5, 0}, 28}, small());
  EXPECT_NEAR(brightness(pixel(a, 48, 48)), brightness(pixel(b, 48, 48)), 12);
}

TEST(Render, LeavesOutWhatIsNotFinite) {
  Stage stage;
  stage.square.positions[2].y() = std::numeric_limits<double>::quiet_NaN();
  stage.ball.positions[40].x() = std::numeric_limits<double>::infinity();
  const Image image = render(stage.scene(), front, small());
  EXPECT_GT(std::set<std::uint8_t>(image.rgb.begin(), image.rgb.end()).size(), 40u);
  for (Vec3& p : stage.square.positions) p.setConstant(std::numeric_limits<double>::quiet_NaN());
  for (Vec3& p : stage.ball.positions) p.setConstant(std::numeric_limits<double>::quiet_NaN());
  const auto [low, high] = bounds(stage.scene());
  EXPECT_EQ(low, Vec3(0, 0, 0));
  EXPECT_EQ(high, Vec3(0, 0, 0));
  EXPECT_NO_THROW(render(stage.scene(), front, small(16, 16, 1)));
}

TEST(Render, DrawsTheEmptySceneAsBackground) {
  const Image image = render({}, front, small(16, 24, 1));
  EXPECT_EQ(image.rgb.size(), 3u * 16 * 24);
  EXPECT_GT(*std::min_element(image.rgb.begin(), image.rgb.end()), 150);
}

TEST(Render, NamesWhatDoesNotFitTogether) {
  Stage stage;
  stage.square.triangles[1][2] = 99;
  try {
    render(stage.scene(), front, small());
    FAIL();
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(), "preview: cloth 0: triangle 1: expected corners in 0..3, got 99");
  }
  stage = Stage();
  stage.square.uv.pop_back();
  EXPECT_THROW(render(stage.scene(), front, small()), InputError);
  EXPECT_THROW(Renderer(small(0, 10)), InputError);
  EXPECT_THROW(Renderer(small(10, 100000)), InputError);
  EXPECT_THROW(Renderer(small(10, 10, 0)), InputError);
  RenderOptions options;
  options.grid_m = -1;
  EXPECT_THROW(Renderer{options}, InputError);
}

TEST(Render, TurntableSheetHoldsThreeViews) {
  const Stage stage;
  const Image sheet = turntable_sheet(stage.scene(), small(60, 80, 2), "T");
  EXPECT_GT(sheet.width, 180);
  EXPECT_LT(sheet.width, 240);
  EXPECT_GT(sheet.height, 80);
}

}  // namespace
}  // namespace toile::internal
