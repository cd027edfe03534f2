// body.cpp: colliders.
#include "arrays.hpp"
#include "module.hpp"
#include "named.hpp"

#include <toile/body.hpp>
#include <toile/error.hpp>

#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace toile::python {

using namespace nb::literals;

namespace {

Body from_file(const std::string& path, std::string_view unit, const std::string& motion, double fps,
               const std::string& measurements, std::string_view up, const std::string& clip, const std::string& bones,
               const std::string& rig, const std::string& weights,
               const std::vector<std::pair<std::string, double>>& targets) {
  std::vector<BodyTarget> changes;
  for (const auto& [file, share] : targets) changes.push_back({file, share});
  return Body::from_file(path, {.unit = named("unit", unit, length_units),
                                .motion = motion,
                                .fps = fps,
                                .measurements = measurements,
                                .up = named("up", up, up_axes),
                                .clip = clip,
                                .bones = bones,
                                .rig = rig,
                                .weights = weights,
                                .targets = std::move(changes)});
}

Body from_frames(const FramesIn& frames_m, const FacesIn& body_faces, double fps) {
  const std::size_t frames = frames_m.shape(0), vertices = frames_m.shape(1);
  const auto all = elements<Point>(frames_m, frames * vertices);
  const nb::gil_scoped_release others_may_run;
  return Body::from_frames(all, vertices, faces(body_faces), fps);
}

}  // namespace

void bind_body(nb::module_& module) {
  nb::class_<Body>(module, "Body")
      .def(nb::init<const Body&>(), "other"_a)
      .def_static("none", &Body::none)
      .def_static("mannequin", &Body::mannequin, nb::call_guard<nb::gil_scoped_release>(), "who"_a, "motion"_a)
      .def_static("motion_names", &Body::motion_names)
      .def_static("from_file", &from_file, nb::call_guard<nb::gil_scoped_release>(), "path"_a, "unit"_a, "motion"_a,
                  "fps"_a, "measurements"_a, "up"_a, "clip"_a, "bones"_a, "rig"_a, "weights"_a, "targets"_a)
      .def_static(
          "from_arrays",
          [](const PointsIn& vertices_m, const FacesIn& body_faces) {
            const nb::gil_scoped_release others_may_run;
            return Body::from_arrays(points(vertices_m), faces(body_faces));
          },
          "vertices_m"_a, "faces"_a)
      .def_static("from_frames", &from_frames, "frames_m"_a, "faces"_a, "fps"_a)
      .def_static(
          "cylinder",
          [](double radius_m, double height_m, const Point& top_m) {
            return Body::cylinder({.radius_m = radius_m, .height_m = height_m, .top_m = top_m});
          },
          "radius_m"_a, "height_m"_a, "top_m"_a)
      .def_static("sphere", &Body::sphere, "radius_m"_a, "edge_m"_a)
      .def_static("capsule", &Body::capsule, "radius_m"_a, "from_m"_a, "to_m"_a, "edge_m"_a)
      .def_static("box", &Body::box, "size_m"_a)
      .def_static(
          "revolved",
          [](const std::vector<std::array<double, 2>>& profile_m, double edge_m) {
            return Body::revolved(profile_m, edge_m);
          },
          "profile_m"_a, "edge_m"_a)
      .def(
          "place",
          [](Body& self, const Point& translation_m, const Point& rotation_deg) {
            self.place(translation_m, rotation_deg);
          },
          "translation_m"_a, "rotation_deg"_a)
      .def(
          "set_moves",
          [](Body& self, const std::vector<std::tuple<double, Point, Point, double>>& keys) {
            std::vector<BodyKey> path;
            for (const auto& [t_s, shift_m, rotation_deg, scale] : keys)
              path.push_back({t_s, shift_m, rotation_deg, scale});
            self.set_moves(path);
          },
          "keys"_a)
      .def(
          "set_inside_out", [](Body& self, bool inside_out) { self.set_inside_out(inside_out); }, "inside_out"_a)
      .def(
          "set_friction", [](Body& self, double friction) { self.set_friction(friction); }, "friction"_a)
      .def(
          "set_offset", [](Body& self, double offset_m) { self.set_offset(offset_m); }, "offset_m"_a);
}

}  // namespace toile::python
