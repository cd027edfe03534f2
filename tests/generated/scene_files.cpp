#include "generated/scene_files.hpp"

#include "generated/json_words.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

namespace toile::internal::generated {
namespace {

using Point = std::array<double, 3>;

constexpr int rings = 6, sectors = 8;
constexpr double height_m = 1.2;

std::vector<Point> egg(double width_m, double depth_m, double lean_m, double scale) {
  std::vector<Point> x = {{0, 0, 0}};
  for (int r = 1; r <= rings; ++r) {
    const double polar = std::numbers::pi * r / (rings + 1), y = 0.5 * height_m * (1 - std::cos(polar));
    for (int s = 0; s < sectors; ++s) {
      const double turn = 2 * std::numbers::pi * s / sectors;
      x.push_back(
          {0.5 * width_m * std::sin(polar) * std::sin(turn), y, 0.5 * depth_m * std::sin(polar) * std::cos(turn)});
    }
  }
  x.push_back({0, height_m, 0});
  for (Point& p : x) {
    p[0] += lean_m * p[1] / height_m;
    for (double& c : p) c *= scale;
  }
  return x;
}

std::string obj(const std::vector<Point>& x) {
  std::string text;
  for (const Point& p : x) text += "v " + number(p[0]) + ' ' + number(p[1]) + ' ' + number(p[2]) + '\n';
  const auto ring = [](int r, int s) { return 2 + (r - 1) * sectors + s % sectors; };  // counted from 1
  const auto face = [&](int a, int b, int c) {
    text += "f " + std::to_string(a) + ' ' + std::to_string(b) + ' ' + std::to_string(c) + '\n';
  };
  const int top = 2 + rings * sectors;
  for (int s = 0; s < sectors; ++s) {
    face(1, ring(1, s + 1), ring(1, s));
    for (int r = 1; r < rings; ++r) {
      face(ring(r, s), ring(r, s + 1), ring(r + 1, s + 1));
      face(ring(r, s), ring(r + 1, s + 1), ring(r + 1, s));
    }
    face(ring(rings, s), ring(rings, s + 1), top);
  }
  return text;
}

struct EggForm {
  double width_m, depth_m, scale;
};
EggForm form_of(const Draw& draw, bool in_cm) {
  return {draw.between("body width", 0.3, 0.45), draw.between("body depth", 0.2, 0.35), in_cm ? 100.0 : 1.0};
}

template <class Number>
void append(std::string& bytes, Number value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

std::string pc2(const std::vector<std::vector<Point>>& frames) {
  std::string bytes("POINTCACHE2\0", 12);
  append(bytes, std::int32_t{1});
  append(bytes, static_cast<std::int32_t>(frames.front().size()));
  append(bytes, 0.0F);
  append(bytes, 1.0F);
  append(bytes, static_cast<std::int32_t>(frames.size()));
  for (const auto& frame : frames)
    for (const Point& p : frame)
      for (const double c : p) append(bytes, static_cast<float>(c));
  return bytes;
}

}  // namespace

TextFile body_file(const Draw& draw, bool in_cm) {
  const EggForm form = form_of(draw, in_cm);
  return {"body.obj", obj(egg(form.width_m, form.depth_m, 0, form.scale))};
}

std::vector<TextFile> motion_files(const Draw& draw, bool in_cm, bool as_obj) {
  const EggForm form = form_of(draw, in_cm);
  const bool from_pose = draw.whole("motion begins in the pose", 0, 1) == 1;
  std::vector<std::vector<Point>> frames;
  for (int k = 0; k < motion_samples; ++k)
    frames.push_back(
        egg(form.width_m, form.depth_m, draw.between("lean", 0.01, 0.05) * (from_pose ? k : k + 1), form.scale));
  if (!as_obj) return {{"motion.pc2", pc2(frames)}};
  std::vector<TextFile> files;
  for (std::size_t k = 0; k < frames.size(); ++k)
    files.push_back({"motion/frame_" + std::to_string(k) + ".obj", obj(frames[k])});
  return files;
}

TextFile solid_file(double scale) {
  std::vector<Point> x = egg(0.5, 0.4, 0, scale);
  for (Point& p : x) p[1] -= 0.5 * scale * height_m;  // around the origin
  return {"solid.obj", obj(x)};
}

TextFile pattern_file(const Draw& draw, std::string_view drawing, bool outer, bool counted) {
  const double z_cm = outer ? 36 : draw.between("panels apart", 24, 30), half_cm = outer ? 44 : 35;
  const double height_cm = counted ? 40 : draw.between("skirt length", 30, 45), top_cm = outer ? 88 : 92;
  const double narrow_cm = half_cm - (counted ? 2 : draw.between("skirt taper", 0, 4));
  const auto corner = [](double x, double y) { return list({number(x), number(y)}); };
  const auto panel = [&](bool back) {
    Object made;
    made.set("translation", vector(0, top_cm, back ? -z_cm : z_cm)).set("rotation", vector(0, 0, 0));
    // The front runs counter-clockwise, the back clockwise: its outer side faces -z.
    const std::string low_left = corner(-half_cm, -height_cm), low_right = corner(half_cm, -height_cm),
                      high_right = corner(narrow_cm, 0), high_left = corner(-narrow_cm, 0);
    made.set("vertices", back ? list({low_left, high_left, high_right, low_right})
                              : list({low_left, low_right, high_right, high_left}));
    std::vector<std::string> edges;
    for (int k = 0; k < 4; ++k) {
      Object edge;
      edge.set("endpoints", list({number(k), number((k + 1) % 4)}));
      if (k == (back ? 1 : 2)) edge.set("label", word("lower_interface"));
      edges.push_back(edge.text());
    }
    made.set("edges", list(edges));
    return made.text();
  };
  const auto side = [](const char* name, int edge) {
    return Object().set("panel", word(name)).set("edge", number(edge)).text();
  };
  Object pattern;
  pattern.set("panels", Object().set("front", panel(false)).set("back", panel(true)).text());
  pattern.set("stitches", list({list({side("front", 1), side("back", 2)}), list({side("front", 3), side("back", 0)})}));
  Object file;
  file.set("pattern", pattern.text());
  file.set("properties", Object().set("units_in_meter", "100").set("curvature_coords", word("relative")).text());
  if (drawing == "fold") {
    const std::string fold = Object().set("endpoints", "[0, 2]").set("angle_deg", "60").text();
    file.set("toile",
             Object().set("panels", Object().set("front", Object().set("folds", list({fold})).text()).text()).text());
  } else if (drawing == "elastic") {
    const std::string back = Object().set("rest_stretch_v", "0.9").set("fabric", word("knit")).text();
    file.set("toile", Object().set("panels", Object().set("back", back).text()).text());
  } else if (drawing == "pressed seam") {
    const std::string seam = Object().set("stitch", "0").set("angle_deg", "-90").text();
    file.set("toile", Object().set("stitches", list({seam})).text());
  }
  return {outer ? "outer.json" : "pattern.json", file.text() + '\n'};
}

}  // namespace toile::internal::generated
