#include "material/fabric.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include "core/error.hpp"

namespace toile::internal {
namespace {

// Where each number comes from: docs/theory/fabrics.md.  Cotton is the default member values of Fabric.
const std::array<Fabric, 5>& presets() {
  static const std::array<Fabric, 5> list = {
      Fabric{.name = "silk",
             .density_kg_per_m2 = 0.07,
             .stretch_u_N_per_m = 1200,
             .stretch_v_N_per_m = 1000,
             .shear_N_per_m = 40,
             .bend_u_N_m = 1.2e-6,
             .bend_v_N_m = 1e-6,
             .stretch_damping_s = 1e-3,
             .shear_damping_s = 1e-3,
             .bend_damping_s = 2e-3,
             .friction = 0.25,
             .thickness_m = 2e-3},
      Fabric{},
      Fabric{.name = "wool",
             .density_kg_per_m2 = 0.23,
             .stretch_u_N_per_m = 2000,
             .stretch_v_N_per_m = 1200,
             .shear_N_per_m = 40,
             .bend_u_N_m = 1.3e-5,
             .bend_v_N_m = 1e-5,
             .stretch_damping_s = 3e-3,
             .shear_damping_s = 3e-3,
             .bend_damping_s = 2e-3,
             .friction = 0.40,
             .thickness_m = 3e-3},
      Fabric{.name = "denim",
             .density_kg_per_m2 = 0.35,
             .stretch_u_N_per_m = 8000,
             .stretch_v_N_per_m = 6000,
             .shear_N_per_m = 150,
             .bend_u_N_m = 8e-5,
             .bend_v_N_m = 5e-5,
             .stretch_damping_s = 3e-3,
             .shear_damping_s = 3e-3,
             .bend_damping_s = 2e-3,
             .friction = 0.50,
             .thickness_m = 3e-3},
      Fabric{.name = "knit",
             .density_kg_per_m2 = 0.18,
             .stretch_u_N_per_m = 350,
             .stretch_v_N_per_m = 250,
             .shear_N_per_m = 90,
             .bend_u_N_m = 7e-6,
             .bend_v_N_m = 5e-6,
             .stretch_damping_s = 5e-3,
             .shear_damping_s = 5e-3,
             .bend_damping_s = 2e-3,
             .friction = 0.40,
             .thickness_m = 3e-3},
  };
  return list;
}

std::string number(double value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return std::string(text.data(), end);
}

}  // namespace

std::span<const Fabric> fabric_presets() { return presets(); }

const Fabric& fabric_preset(std::string_view name, std::string_view where, std::string_view place) {
  for (const Fabric& fabric : presets())
    if (fabric.name == name) return fabric;

  std::array<std::string_view, 5> names;
  std::string expected = "a fabric, one of ";
  for (std::size_t i = 0; i < names.size(); ++i) {
    names[i] = presets()[i].name;
    expected.append(i == 0 ? "" : ", ").append(names[i]);
  }
  expected.append("; nearest is \"").append(nearest_name(name, names.data(), names.size())).append("\"");
  throw InputError(where, place, expected, "\"" + printable(name) + "\"");
}

Fabric fused(const Fabric& cloth, const Fabric& interfacing, double apart_m) {
  const auto twist = [](const Fabric& one) {
    return one.bend_uv_N_m > 0 ? one.bend_uv_N_m
                               : 0.5 * (1 - one.bend_poisson) * 0.5 * (one.bend_u_N_m + one.bend_v_N_m);
  };
  const auto sandwich = [&](double k_1, double k_2) {
    return k_1 + k_2 > 0 ? apart_m * apart_m * k_1 * k_2 / (k_1 + k_2) : 0;
  };
  Fabric both = cloth;
  both.density_kg_per_m2 += interfacing.density_kg_per_m2;
  both.stretch_u_N_per_m += interfacing.stretch_u_N_per_m;
  both.stretch_v_N_per_m += interfacing.stretch_v_N_per_m;
  both.shear_N_per_m += interfacing.shear_N_per_m;
  both.bend_u_N_m += interfacing.bend_u_N_m + sandwich(cloth.stretch_u_N_per_m, interfacing.stretch_u_N_per_m);
  both.bend_v_N_m += interfacing.bend_v_N_m + sandwich(cloth.stretch_v_N_per_m, interfacing.stretch_v_N_per_m);
  both.bend_uv_N_m = twist(cloth) + twist(interfacing) + sandwich(cloth.shear_N_per_m, interfacing.shear_N_per_m);
  return both;
}

void check_fabric(const Fabric& fabric, std::string_view where, std::string_view place) {
  const auto check = [&](std::string_view key, double value, bool may_be_zero) {
    if (std::isfinite(value) && (may_be_zero ? value >= 0 : value > 0)) return;
    std::string at(place);
    if (!at.empty()) at += '/';
    at += key;
    throw InputError(where, at, may_be_zero ? "a number that is zero or more" : "a number above zero", number(value));
  };
  check("density_kg_per_m2", fabric.density_kg_per_m2, false);
  check("stretch_u_N_per_m", fabric.stretch_u_N_per_m, false);
  check("stretch_v_N_per_m", fabric.stretch_v_N_per_m, false);
  check("shear_N_per_m", fabric.shear_N_per_m, true);
  check("compression_ratio", fabric.compression_ratio, false);
  if (fabric.compression_ratio > 1)
    throw InputError(where, std::string(place) + (place.empty() ? "" : "/") + "compression_ratio", "at most 1",
                     number(fabric.compression_ratio));
  check("strain_limit", fabric.strain_limit, true);
  check("bend_u_N_m", fabric.bend_u_N_m, true);
  check("bend_v_N_m", fabric.bend_v_N_m, true);
  check("bend_poisson", fabric.bend_poisson, true);
  if (fabric.bend_poisson > 0.5)
    throw InputError(where, std::string(place) + (place.empty() ? "" : "/") + "bend_poisson", "at most 0.5",
                     number(fabric.bend_poisson));
  check("bend_uv_N_m", fabric.bend_uv_N_m, true);
  check("stretch_damping_s", fabric.stretch_damping_s, true);
  check("shear_damping_s", fabric.shear_damping_s, true);
  check("bend_damping_s", fabric.bend_damping_s, true);
  check("friction", fabric.friction, true);
  check("thickness_m", fabric.thickness_m, false);
}

}  // namespace toile::internal
