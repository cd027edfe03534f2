// cloth.cpp: garments and pieces of cloth before anything moves.
#include "arrays.hpp"
#include "module.hpp"
#include "named.hpp"

#include <toile/cloth.hpp>

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

namespace toile::python {

using namespace nb::literals;

namespace {

Cloth from_arrays(const PointsIn& vertices_m, const FacesIn& cloth_faces, const std::optional<CornerUvsIn>& uv_m,
                  const std::optional<IndicesIn>& panel, const std::vector<std::string>& panel_names) {
  ClothArrays arrays;
  arrays.vertices_m = points(vertices_m);
  arrays.faces = faces(cloth_faces);
  if (uv_m) arrays.uv_m = elements<CornerUvs>(*uv_m, uv_m->shape(0));
  if (panel) arrays.panel = indices(*panel);
  arrays.panel_names = panel_names;
  const nb::gil_scoped_release others_may_run;
  return Cloth::from_arrays(arrays);
}

constexpr Names<RestShape, 3> rest_shapes{
    {{"automatic", RestShape::automatic}, {"drawing", RestShape::drawing}, {"start", RestShape::start}}};

Cloth from_file(const std::string& path, std::string_view unit, std::string_view rest_shape) {
  return Cloth::from_file(
      path, {.unit = named("unit", unit, length_units), .rest_shape = named("rest_shape", rest_shape, rest_shapes)});
}

}  // namespace

void bind_cloth(nb::module_& module) {
  nb::class_<Cloth>(module, "Cloth")
      .def(nb::init<const Cloth&>(), "other"_a)
      .def_static(
          "from_pattern",
          [](const std::string& path, double edge_m, double hem_m, double tape_m, double allowance_m,
             bool topstitched) {
            return Cloth::from_pattern(path, {.edge_m = edge_m,
                                              .hem_m = hem_m,
                                              .tape_m = tape_m,
                                              .allowance_m = allowance_m,
                                              .topstitched = topstitched});
          },
          nb::call_guard<nb::gil_scoped_release>(), "path"_a, "edge_m"_a, "hem_m"_a, "tape_m"_a, "allowance_m"_a,
          "topstitched"_a)
      .def_static("from_file", &from_file, nb::call_guard<nb::gil_scoped_release>(), "path"_a, "unit"_a, "rest_shape"_a)
      .def_static(
          "grid",
          [](double width_m, double height_m, double edge_m) {
            return Cloth::grid({.width_m = width_m, .height_m = height_m, .edge_m = edge_m});
          },
          "width_m"_a, "height_m"_a, "edge_m"_a)
      .def_static("from_arrays", &from_arrays, "vertices_m"_a, "faces"_a, "uv_m"_a.none(), "panel"_a.none(),
                  "panel_names"_a)
      // Setters return nothing here: toile/_recipe.py returns the package's Cloth for chaining.
      .def(
          "set_name", [](Cloth& self, std::string_view name) { self.set_name(name); }, "name"_a)
      .def(
          "set_fabric", [](Cloth& self, const Fabric& fabric) { self.set_fabric(fabric); }, "fabric"_a)
      .def(
          "set_panel_fabric",
          [](Cloth& self, std::string_view panel, const Fabric& fabric) { self.set_panel_fabric(panel, fabric); },
          "panel"_a, "fabric"_a)
      .def(
          "set_panel_rest_stretch",
          [](Cloth& self, std::string_view panel, double u, double v) { self.set_panel_rest_stretch(panel, u, v); },
          "panel"_a, "u"_a, "v"_a)
      .def(
          "set_panel_pressure",
          [](Cloth& self, std::string_view panel, double Pa) { self.set_panel_pressure(panel, Pa); }, "panel"_a, "Pa"_a)
      .def(
          "place",
          [](Cloth& self, const Point& translation_m, const Point& rotation_deg) {
            self.place(translation_m, rotation_deg);
          },
          "translation_m"_a, "rotation_deg"_a);
}

}  // namespace toile::python
