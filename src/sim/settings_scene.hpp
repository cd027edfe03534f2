// sim/settings_scene.hpp: the keys of a scene.                                                     sim/settings.hpp
#pragma once
#include "sim/settings_body.hpp"

namespace toile::internal {

template <class V>
void describe(V& v, PairFriction& pair) {  // a row
  v.fabric_column("fabric", pair.first);
  v.fabric_column("fabric", pair.second);
  v.column("friction", Range{0, 100}, pair.friction);
}

// Rows [t_s, x, y, z] of a vector over time.
inline auto in_time(double most) {
  return [most](auto& row, VectorKey& key) {
    row.column("t_s", within_a_run, key.t_s);
    row.column("x", Range{-most, most}, key.x.x());
    row.column("y", Range{-most, most}, key.x.y());
    row.column("z", Range{-most, most}, key.x.z());
  };
}

template <class V>
void describe_world(V& v, Scene& scene) {
  v.vector({"gravity_m_per_s2", "its acceleration"}, {-1000, 1000}, scene.gravity_m_per_s2);
  v.vector({"wind_m_per_s", "of the air"}, {-100, 100}, scene.air.wind_m_per_s);
  v.rows({"gravity_path", "in time, m/s2, instead of the constant", "constant"}, Rows{1, true}, scene.gravity_path,
         in_time(1000));
  v.rows({"wind_path", "in time, m/s, likewise", "constant"}, Rows{1, true}, scene.wind_path, in_time(100));
  v.number({"air_density_kg_per_m3", "air resists and wind blows; 0: no air"}, {0, 1e3}, scene.air.density_kg_per_m3);
}

template <class V>
void describe_time(V& v, Scene& scene) {
  static constexpr std::array<std::pair<std::string_view, Integrator>, 2> integrators = {
      {{"backward_euler", Integrator::backward_euler}, {"bdf2", Integrator::bdf2}}};
  v.number({"fps", "frames per second"}, {1, most_fps}, scene.fps);
  v.number({"seconds", "how long, after the sewing; with a motion, how long the body moves",
            "5, or the length of a motion that ends"},
           {0, most_seconds, 1, true}, scene.seconds, scene.seconds_given);
  v.number({"drape_seconds", "the longest drape before a motion, and of a garment that another one goes over",
            "10; 0 for what is not sewn and moves by itself"},
           within_a_run, scene.drape_seconds);
  v.number({"step_max_ms", "the longest step",
            "16.7 for patterns, 33.3 while they come to rest; a frame for what is not sewn"},
           {0.01, 1000, 1e-3}, scene.step_max_s);
  v.name({"integrator", "[theory/step.md](theory/step.md#more-solves-and-bdf2)"}, integrators, scene.integrator);
  v.flag({"until_still", "stop at rest, and fail if still moving at the end", "true for patterns"}, scene.until_still);
}

template <class V>
void describe_solver(V& v, Scene& scene) {
  using Choice = std::optional<Preconditioner>;
  static constexpr std::array<std::pair<std::string_view, Choice>, 5> preconditioners = {
      {{"auto", std::nullopt},
       {"diagonal", Preconditioner::diagonal},
       {"block_jacobi", Preconditioner::block_jacobi},
       {"block_ssor", Preconditioner::block_ssor},
       {"block_ssor_coarse", Preconditioner::block_ssor_coarse}}};
  static constexpr std::array<std::pair<std::string_view, PcgProcedure>, 2> procedures = {
      {{"prefiltered", PcgProcedure::prefiltered}, {"paper_1998", PcgProcedure::paper_1998}}};
  static constexpr std::array<std::pair<std::string_view, DampingJacobian>, 2> jacobians = {
      {{"gauss_newton", DampingJacobian::gauss_newton}, {"paper", DampingJacobian::paper}}};
  static constexpr std::array<std::pair<std::string_view, BendElement>, 2> bend_elements = {
      {{"plate", BendElement::plate}, {"hinge", BendElement::hinge}}};
  v.name({"preconditioner", "\"diagonal\" is the paper's"}, preconditioners, scene.preconditioner);
  v.number({"tolerance", "of the linear solve ([what it keeps](theory/solver.md#what-the-tolerance-keeps))",
            "0.01; 0.001 without the coarse space, and for \"paper_1998\""},
           {1e-12, 0.5}, scene.tolerance);
  v.name({"procedure",
          "\"paper_1998\": the listing as printed, for comparison (`relinearisations` 0 besides makes the step the "
          "paper's)"},
         procedures, scene.procedure);
  v.whole({"newton_iterations", "linear solves per step"}, {1, 3}, scene.newton_iterations);
  v.whole({"relinearisations",
           "more solves, about the end that was found, before a step is refused because a thread stretches too much, "
           "and where "
           "turning made energy ([theory/step.md](theory/step.md#how-long-a-step-may-be)); the paper's 0"},
          {0, 10}, scene.relinearisations);
  v.name({"bend_element",
          "\"hinge\": every edge by itself, as in 1998 but weighted "
          "([theory/bend.md](theory/bend.md#hinges-by-themselves)); "
          "fabrics' `bend_poisson`, `bend_uv_N_m`, `bend_friction_N` and `bend_set` do not count"},
         bend_elements, scene.bend_element);
  v.flag({"paper_scaling", "conditions scaled by area and hinges without geometry, as printed in 1998"},
         scene.paper_scaling);
  v.name({"damping_jacobian", "\"paper\": with the term that can make it indefinite"}, jacobians,
         scene.damping_jacobian);
}

template <class V>
void describe_contact(V& v, Scene& scene) {
  v.number({"thickness_mm", "of cloth on cloth, in place of every fabric's own", "the fabric's"}, {0.1, 100, 1e-3},
           scene.contact_thickness_m);
  v.number({"friction", "of cloth on cloth, in place of every fabric's own", "the fabric's"}, {0, 100},
           scene.contact_friction);
  v.rows({"friction_between",
          "of layers of these two fabrics on each other, by the names of their presets (\"base\"), in either order; "
          "two of "
          "the same may be named",
          "the larger of the two fabrics'"},
         Rows{0}, scene.friction_between, [](auto& row, PairFriction& pair) { describe(row, pair); });
  v.flag({"self_contact", "false: layers of cloth pass through each other"}, scene.self_contact);
  v.flag(
      {"flypaper",
       "cloth between two parts of the body that come nearer to each other than two offsets is held and goes with both "
       "([theory/step.md](theory/step.md#flypaper))"},
      scene.flypaper);
  v.flag({"strict_start",
          "end with exit code 4 when the start already intersects, instead of [untangling](untangle.md) it"},
         scene.strict_start);
}

template <class V>
void describe_output(V& v, Scene& scene) {
  v.text(Setting{"dir", "where the files go, from where the program runs; `--out` wins", "out/NAME"}.without_effect(),
         scene.output_dir);
  v.flag(Setting{"preview", "pictures and a film; `--no-preview` wins", "false; true for `dress` and `demo`"}
             .without_effect(),
         scene.preview);
  v.wholes(
      Setting{"picture_frames", "frames of the motion (or of the cloth) that `frames.png` shows side by side", "none"}
          .without_effect(),
      {0, most_seconds * most_fps}, scene.picture_frames);
}

template <class V>
void describe(V& v, Scene& scene) {
  v.text(Setting{"name", "of the run", "the file's name"}.without_effect(), scene.name);
  v.list(Setting{"cloth", "garments, dressed in this order from the inside out, or grids, tubes and ribbons"}.needs(),
         scene.cloth, 1);
  v.object(Setting{"body", "what the cloth is worn by, or falls on", "none"}.or_null(), scene.body);
  v.list({"solids", "what cloth collides with beside the body, or instead of it, of at most 2 million triangles each",
          "none"},
         scene.solids);
  v.group({"world", "what acts on all cloth"}, [&](auto& of) { describe_world(of, scene); });
  v.group({"time", "frames, and how long"}, [&](auto& of) { describe_time(of, scene); });
  v.group({"solver", "how a step is solved"}, [&](auto& of) { describe_solver(of, scene); });
  v.group({"contact", "of cloth with cloth and with the body"}, [&](auto& of) { describe_contact(of, scene); });
  v.path(
      {"start", "directory of a run: begin as it had draped, without sewing ([command-line.md](command-line.md#start))",
       "from the panels"},
      scene.start);
  v.group({"output", "what is written besides"}, [&](auto& of) { describe_output(of, scene); });
}

}  // namespace toile::internal
