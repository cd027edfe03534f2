#include "toile/fabric.hpp"

#include "api/parts.hpp"
#include "material/fabric.hpp"

namespace toile {
namespace {

// Every number of a fabric, in the library's struct and in the engine's.
template <class From, class To>
To converted(const From& from) {
  To to;
  to.name = from.name;
  to.density_kg_per_m2 = from.density_kg_per_m2;
  to.stretch_u_N_per_m = from.stretch_u_N_per_m;
  to.stretch_v_N_per_m = from.stretch_v_N_per_m;
  to.doubling_strain_u = from.doubling_strain_u;
  to.doubling_strain_v = from.doubling_strain_v;
  to.shear_N_per_m = from.shear_N_per_m;
  to.compression_ratio = from.compression_ratio;
  to.strain_limit = from.strain_limit;
  to.bend_u_N_m = from.bend_u_N_m;
  to.bend_v_N_m = from.bend_v_N_m;
  to.bend_poisson = from.bend_poisson;
  to.bend_uv_N_m = from.bend_uv_N_m;
  to.bend_friction_N = from.bend_friction_N;
  to.bend_friction_curvature_per_m = from.bend_friction_curvature_per_m;
  to.bend_set = from.bend_set;
  to.bend_set_s = from.bend_set_s;
  to.stretch_damping_s = from.stretch_damping_s;
  to.shear_damping_s = from.shear_damping_s;
  to.bend_damping_s = from.bend_damping_s;
  to.friction = from.friction;
  to.thickness_m = from.thickness_m;
  return to;
}
static_assert(sizeof(Fabric) == sizeof(internal::Fabric), "a number that converted() does not know?");

}  // namespace

internal::Fabric engine_fabric(const Fabric& fabric) {
  internal::Fabric engine = converted<Fabric, internal::Fabric>(fabric);
  internal::check_fabric(engine, "", "fabric");
  return engine;
}

Fabric fabric(std::string_view name) {
  return translated([&] { return converted<internal::Fabric, Fabric>(internal::fabric_preset(name, "", "fabric")); });
}

std::vector<std::string> fabric_names() {
  std::vector<std::string> names;
  for (const internal::Fabric& preset : internal::fabric_presets()) names.push_back(preset.name);
  return names;
}

}  // namespace toile
