// simulation.cpp: the simulation of cloth on a body.
#include "arrays.hpp"
#include "module.hpp"
#include "working.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

namespace toile::python {

using namespace nb::literals;

namespace {

void make(Working* self, const std::vector<const Cloth*>& cloths, const Body& body,
          const std::vector<const Body*>& solids, const Point& gravity_m_per_s2, const Point& wind_m_per_s,
          double air_density_kg_per_m3, int threads) {
  std::vector<Cloth> copies;
  for (const Cloth* cloth : cloths) copies.push_back(*cloth);
  std::vector<Body> beside;
  for (const Body* solid : solids) beside.push_back(*solid);
  const nb::gil_scoped_release others_may_run;
  new (self) Working([&](SimulationOptions options) {
    options.gravity_m_per_s2 = gravity_m_per_s2;
    options.wind_m_per_s = wind_m_per_s;
    options.air_density_kg_per_m3 = air_density_kg_per_m3;
    options.threads = threads;
    return Simulation(copies, body, beside, options);
  });
}

Working from_scene(const std::string& path, int threads) {
  return Working([&](SimulationOptions options) {
    options.threads = threads;
    return Simulation::from_scene(path, options);
  });
}

int grab(Working& self, std::int32_t face, const std::array<double, 3>& barycentric, double stiffness_N_per_m,
         double damping_N_s_per_m, double max_force_N) {
  return self.touch().grab({.face = face,
                            .barycentric = barycentric,
                            .stiffness_N_per_m = stiffness_N_per_m,
                            .damping_N_s_per_m = damping_N_s_per_m,
                            .max_force_N = max_force_N});
}

}  // namespace

void bind_simulation(nb::module_& module) {
  const Simulation::Grip grip;
  const SimulationOptions defaults;
  module.attr("gravity_m_per_s2") = nb::tuple(nb::cast(defaults.gravity_m_per_s2));
  module.attr("air_density_kg_per_m3") = defaults.air_density_kg_per_m3;
  nb::class_<Working>(module, "Simulation")
      .def("__init__", &make, "cloths"_a, "body"_a, "solids"_a, "gravity_m_per_s2"_a, "wind_m_per_s"_a,
           "air_density_kg_per_m3"_a, "threads"_a)
      .def_static("from_scene", &from_scene, nb::call_guard<nb::gil_scoped_release>(), "path"_a, "threads"_a)
      .def(
          "dress",
          [](Working& self, double longest_s, double time_limit_s, nb::object progress) {
            return self.work([=](Simulation& s) { return s.dress(longest_s, time_limit_s); }, std::move(progress));
          },
          "longest_s"_a, "time_limit_s"_a, "progress"_a.none())
      .def(
          "run",
          [](Working& self, nb::object progress) {
            return self.work([](Simulation& s) { return s.run(); }, std::move(progress));
          },
          "progress"_a.none())
      .def(
          "advance", [](Working& self, double h_s) { return self.work([=](Simulation& s) { return s.advance(h_s); }); },
          "h_s"_a)
      .def("reset", [](Working& self) { self.work([](Simulation& s) { return s.reset(), true; }); })
      .def("cancel", &Working::cancel, "Ends the call that is at work, from any thread.")
      .def_prop_ro("time_s", [](const Working& self) { return self.look().time_s(); })

      .def("positions_m", [](const Working& self) { return copy_out<double>(self.look().positions_m(), {3}); })
      .def("velocities_m_per_s",
           [](const Working& self) { return copy_out<double>(self.look().velocities_m_per_s(), {3}); })
      .def("faces", [](const Working& self) { return copy_out<std::int32_t>(self.look().faces(), {3}); })
      .def("uv_m",
           [](const Working& self) {
             return copy_out<double>(self.look().uv_m(), {3, 2});
           })
      .def("panel", [](const Working& self) { return copy_out<std::int32_t>(self.look().panel(), {}); })
      .def("warnings", [](const Working& self) { return self.look().warnings(); })
      .def("panel_names", [](const Working& self) { return self.look().panel_names(); })
      .def("body_positions_m",
           [](const Working& self) { return copy_out<double>(self.look().body_positions_m(), {3}); })
      .def("collider_count", [](const Working& self) { return self.look().collider_count(); })
      .def(
          "collider_positions_m",
          [](const Working& self, int collider) {
            return copy_out<double>(self.look().collider_positions_m(collider), {3});
          },
          "collider"_a)
      .def("body_faces", [](const Working& self) { return copy_out<std::int32_t>(self.look().body_faces(), {3}); })

      .def(
          "pin", [](Working& self, const IndicesIn& particles) { self.touch().pin(indices(particles)); }, "particles"_a)
      .def(
          "move_pins",
          [](Working& self, const IndicesIn& particles, const PointsIn& to_m) {
            self.touch().move_pins(indices(particles), points(to_m));
          },
          "particles"_a, "to_m"_a)
      .def(
          "release", [](Working& self, const IndicesIn& particles) { self.touch().release(indices(particles)); },
          "particles"_a)
      .def("pinned", [](const Working& self) { return self.look().pinned(); })
      .def("grab", &grab, "face"_a, "barycentric"_a, "stiffness_N_per_m"_a = grip.stiffness_N_per_m,
           "damping_N_s_per_m"_a = grip.damping_N_s_per_m, "max_force_N"_a = grip.max_force_N)
      .def(
          "drag", [](Working& self, int hand, const Point& to_m) { self.touch().drag(hand, to_m); }, "hand"_a, "to_m"_a)
      .def(
          "let_go", [](Working& self, int hand) { self.touch().let_go(hand); }, "hand"_a)
      .def(
          "set_collider",
          [](Working& self, int collider, const PointsIn& vertices_m) {
            self.touch().set_collider(collider, points(vertices_m));
          },
          "collider"_a, "vertices_m"_a)
      .def(
          "attach", [](Working& self, const IndicesIn& particles) { self.touch().attach(indices(particles)); },
          "particles"_a)
      .def(
          "set_friction",
          [](Working& self, int collider, double friction) { self.touch().set_friction(collider, friction); },
          "collider"_a, "friction"_a)
      .def(
          "set_stiffness",
          [](Working& self, std::int32_t panel, double stretch, double shear, double bend) {
            self.touch().set_stiffness(panel, {.stretch = stretch, .shear = shear, .bend = bend});
          },
          "panel"_a, "stretch"_a, "shear"_a, "bend"_a)
      .def(
          "set_pressure", [](Working& self, std::int32_t panel, double Pa) { self.touch().set_pressure(panel, Pa); },
          "panel"_a, "Pa"_a)
      .def(
          "set_gravity", [](Working& self, const Point& m_per_s2) { self.touch().set_gravity(m_per_s2); }, "m_per_s2"_a)
      .def(
          "set_wind", [](Working& self, const Point& m_per_s) { self.touch().set_wind(m_per_s); }, "m_per_s"_a)

      .def("state", [](Working& self) { return self.work([](Simulation& s) { return s.state(); }); })
      .def(
          "set_state",
          [](Working& self, const State& state) { self.work([&](Simulation& s) { return s.set_state(state), true; }); },
          "state"_a)
      .def("state_hash", [](const Working& self) { return self.look().state_hash(); })
      .def("crossings", [](Working& self) { return self.work([](Simulation& s) { return s.crossings(); }); });
}

}  // namespace toile::python
