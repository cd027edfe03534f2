// fabric.cpp: material parameters.
#include "module.hpp"

#include <toile/fabric.hpp>

#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

namespace toile::python {

namespace nb = nanobind;
using namespace nb::literals;

namespace {

struct Field {
  const char* name;
  double Fabric::*value;
  const char* doc;
};
constexpr Field fields[] = {
    {"density_kg_per_m2", &Fabric::density_kg_per_m2, "Mass per area, kg/m²."},
    {"stretch_u_N_per_m", &Fabric::stretch_u_N_per_m, "Stiffness along the warp, N/m."},
    {"stretch_v_N_per_m", &Fabric::stretch_v_N_per_m, "Stiffness along the weft, N/m."},
    {"doubling_strain_u", &Fabric::doubling_strain_u,
     "Extension at which the warp pulls twice as hard as a straight line of its stiffness; 0: a straight line."},
    {"doubling_strain_v", &Fabric::doubling_strain_v, "The same of the weft."},
    {"shear_N_per_m", &Fabric::shear_N_per_m, "Stiffness against shear, N/m."},
    {"compression_ratio", &Fabric::compression_ratio,
     "Of the stretch stiffness, in threads shorter than at rest; in (0, 1]. Less where triangles are so large that the "
     "sheet "
     "buckles between their corners; 1: it does not."},
    {"strain_limit", &Fabric::strain_limit, "No thread gets longer than 1 + this of its length as cut; 0: no limit."},
    {"bend_u_N_m", &Fabric::bend_u_N_m, "Bending rigidity along the warp, N·m."},
    {"bend_v_N_m", &Fabric::bend_v_N_m, "Bending rigidity along the weft, N·m."},
    {"bend_poisson", &Fabric::bend_poisson,
     "How much cloth bent along one thread wants to bend the other way along the other; in [0, 0.5]."},
    {"bend_uv_N_m", &Fabric::bend_uv_N_m,
     "Rigidity against twist, N·m; 0: (1 - bend_poisson) / 2 times the mean of the other two."},
    {"bend_friction_N", &Fabric::bend_friction_N,
     "Moment per width that rubbing threads hold, N; half of KES-F's 2HB."},
    {"bend_friction_curvature_per_m", &Fabric::bend_friction_curvature_per_m, "Curvature at which it is reached, 1/m."},
    {"bend_set", &Fabric::bend_set, "Share of the bending rigidity that follows a bend; in [0, 1]."},
    {"bend_set_s", &Fabric::bend_set_s, "Time over which it follows, s."},
    {"stretch_damping_s", &Fabric::stretch_damping_s, "Damping / stiffness of stretch, s."},
    {"shear_damping_s", &Fabric::shear_damping_s, "Damping / stiffness of shear, s."},
    {"bend_damping_s", &Fabric::bend_damping_s, "Damping / stiffness of bending, s."},
    {"friction", &Fabric::friction, "Coefficient of friction, cloth on cloth and on the body."},
    {"thickness_m", &Fabric::thickness_m, "Between two layers that touch, m."},
};

// For editors and type checkers; a test compares it with the fields.
#define TOILE_FABRIC_FIELDS                                                                                 \
  "name: str = ..., density_kg_per_m2: float = ..., stretch_u_N_per_m: float = ..., "                       \
  "stretch_v_N_per_m: float = ..., doubling_strain_u: float = ..., doubling_strain_v: float = ..., "        \
  "shear_N_per_m: float = ..., compression_ratio: float = ..., strain_limit: float = ..., "                 \
  "bend_u_N_m: float = ..., bend_v_N_m: float = ..., bend_poisson: float = ..., bend_uv_N_m: float = ..., " \
  "bend_friction_N: float = ..., bend_friction_curvature_per_m: float = ..., bend_set: float = ..., "       \
  "bend_set_s: float = ..., stretch_damping_s: float = ..., shear_damping_s: float = ..., "                 \
  "bend_damping_s: float = ..., friction: float = ..., thickness_m: float = ..."

const Field& field(std::string_view name) {
  for (const Field& known : fields)
    if (known.name == name) return known;
  std::string names = "name";
  for (const Field& known : fields) names += std::string(", ") + known.name;
  throw nb::type_error(("Fabric has no field `" + std::string(name) + "`; it has " + names).c_str());
}

void change(Fabric& fabric, const nb::dict& changes) {
  for (const auto& [key, value] : changes) {
    const auto name = nb::cast<std::string>(key);
    try {
      if (name == "name")
        fabric.name = nb::cast<std::string>(value);
      else
        fabric.*field(name).value = nb::cast<double>(value);
    } catch (const nb::cast_error&) {
      throw nb::type_error(("Fabric: " + name + ": expected a " + (name == "name" ? "string" : "number")).c_str());
    }
  }
}

nb::dict fields_of(const Fabric& fabric) {
  nb::dict all;
  all["name"] = fabric.name;
  for (const Field& known : fields) all[known.name] = fabric.*known.value;
  return all;
}

}  // namespace

void bind_fabric(nb::module_& module) {
  nb::class_<Fabric> type(
      module, "Fabric",
      "What cloth is made of.  Source of the presets: docs/theory/fabrics.md.\n\n"
      "Stiffness is force per width, and bending moment per width per curvature: none of it depends on "
      "the mesh.\nA value: it does not change.  Fields that are not given are those of the default, a cotton.");
  type.def(
          "__init__",
          [](Fabric* self, const nb::kwargs& changes) {
            Fabric made;
            change(made, changes);
            new (self) Fabric(made);
          },
          nb::sig("def __init__(self, *, " TOILE_FABRIC_FIELDS ") -> None"))
      .def(
          "replace",
          [](const Fabric& self, const nb::kwargs& changes) {
            Fabric made = self;
            change(made, changes);
            return made;
          },
          nb::sig("def replace(self, *, " TOILE_FABRIC_FIELDS ") -> Fabric"),
          "The same with some fields changed: toile.fabric('silk').replace(density_kg_per_m2=0.07).  "
          "TypeError for a field that there is not.")
      .def("fields", &fields_of, nb::sig("def fields(self) -> dict[str, str | float]"), "All fields by name.")
      .def_ro("name", &Fabric::name, "For messages and reports.")
      .def("__eq__",
           [](const Fabric& self, const nb::object& other) {
             return nb::isinstance<Fabric>(other) && fields_of(self).equal(fields_of(nb::cast<const Fabric&>(other)));
           })
      .def("__hash__", [](const Fabric& self) { return nb::hash(nb::tuple(fields_of(self).values())); })
      .def("__repr__",
           [](const Fabric& self) {
             std::string text;
             for (const auto& [key, value] : fields_of(self))
               text += (text.empty() ? "" : ", ") + nb::cast<std::string>(key) + "=" + nb::repr(value).c_str();
             return "Fabric(" + text + ")";
           })
      .def("__getstate__", &fields_of)
      .def("__setstate__", [](Fabric& self, const nb::dict& state) {
        Fabric made;
        change(made, state);
        new (&self) Fabric(made);
      });
  for (const Field& known : fields) {
    const auto value = known.value;
    type.def_prop_ro(
        known.name, [value](const Fabric& self) { return self.*value; }, known.doc);
  }
  module.def("fabric", &fabric, "name"_a,
             "The preset of that name.  InputError, with the nearest name, for any that fabric_names() has not.");
  module.def("fabric_names", &fabric_names, "The presets: silk, cotton, ...");
}

}  // namespace toile::python
