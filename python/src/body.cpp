// body.cpp: what cloth collides with.
#include "arrays.hpp"
#include "module.hpp"
#include "named.hpp"

#include <toile/body.hpp>
#include <toile/error.hpp>

#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <utility>

namespace toile::python {

using namespace nb::literals;

namespace {

Body from_file(const std::string& path, std::string_view unit, const std::string& motion, double fps,
               const std::string& measurements) {
  return Body::from_file(
      path, {.unit = named("unit", unit, length_units), .motion = motion, .fps = fps, .measurements = measurements});
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
                  "fps"_a, "measurements"_a)
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
      .def(
          "set_friction", [](Body& self, double friction) { self.set_friction(friction); }, "friction"_a)
      .def(
          "set_offset", [](Body& self, double offset_m) { self.set_offset(offset_m); }, "offset_m"_a);
}

}  // namespace toile::python
