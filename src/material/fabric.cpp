#include "material/fabric.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include "core/error.hpp"

namespace toile::internal {
namespace {

std::string number(double value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return std::string(text.data(), end);
}

}  // namespace

Fabric fused(const Fabric& cloth, const Fabric& interfacing, double apart_m) {
  const auto twist = [](const Fabric& one) {
    return one.bend_uv_N_m > 0 ? one.bend_uv_N_m
                               : 0.5 * (1 - one.bend_poisson) * 0.5 * (one.bend_u_N_m + one.bend_v_N_m);
  };
  const auto sandwich = [&](double k_1, double k_2) {
    return k_1 + k_2 > 0 ? apart_m * apart_m * k_1 * k_2 / (k_1 + k_2) : 0;
  };
  // k (e + e^3 / d^2) of both, side by side.
  const auto doubling = [](double k_1, double d_1, double k_2, double d_2) {
    const double cubic = (d_1 > 0 ? k_1 / (d_1 * d_1) : 0) + (d_2 > 0 ? k_2 / (d_2 * d_2) : 0);
    return cubic > 0 ? std::sqrt((k_1 + k_2) / cubic) : 0;
  };
  Fabric both = cloth;
  both.doubling_strain_u = doubling(cloth.stretch_u_N_per_m, cloth.doubling_strain_u, interfacing.stretch_u_N_per_m,
                                    interfacing.doubling_strain_u);
  both.doubling_strain_v = doubling(cloth.stretch_v_N_per_m, cloth.doubling_strain_v, interfacing.stretch_v_N_per_m,
                                    interfacing.doubling_strain_v);
  both.density_kg_per_m2 += interfacing.density_kg_per_m2;
  both.stretch_u_N_per_m += interfacing.stretch_u_N_per_m;
  both.stretch_v_N_per_m += interfacing.stretch_v_N_per_m;
  both.shear_N_per_m += interfacing.shear_N_per_m;
  both.bend_u_N_m += interfacing.bend_u_N_m + sandwich(cloth.stretch_u_N_per_m, interfacing.stretch_u_N_per_m);
  both.bend_v_N_m += interfacing.bend_v_N_m + sandwich(cloth.stretch_v_N_per_m, interfacing.stretch_v_N_per_m);
  both.bend_friction_N += interfacing.bend_friction_N;
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
  const auto check_doubling = [&](std::string_view key, double value) {
    check(key, value, true);
    if (value == 0 || value >= least_doubling_strain) return;
    throw InputError(where, std::string(place) + (place.empty() ? "" : "/") + std::string(key),
                     "0 or at least " + number(least_doubling_strain), number(value));
  };
  check("density_kg_per_m2", fabric.density_kg_per_m2, false);
  check("stretch_u_N_per_m", fabric.stretch_u_N_per_m, false);
  check("stretch_v_N_per_m", fabric.stretch_v_N_per_m, false);
  check_doubling("doubling_strain_u", fabric.doubling_strain_u);
  check_doubling("doubling_strain_v", fabric.doubling_strain_v);
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
  check("bend_friction_N", fabric.bend_friction_N, true);
  check("bend_friction_curvature_per_m", fabric.bend_friction_curvature_per_m, false);
  check("bend_set", fabric.bend_set, true);
  if (fabric.bend_set > 1)
    throw InputError(where, std::string(place) + (place.empty() ? "" : "/") + "bend_set", "at most 1",
                     number(fabric.bend_set));
  check("bend_set_s", fabric.bend_set_s, false);
  check("stretch_damping_s", fabric.stretch_damping_s, true);
  check("shear_damping_s", fabric.shear_damping_s, true);
  check("bend_damping_s", fabric.bend_damping_s, true);
  check("friction", fabric.friction, true);
  check("thickness_m", fabric.thickness_m, false);
}

}  // namespace toile::internal
