// reports.cpp: reports of a simulation, and its state.
#include "module.hpp"

#include <toile/simulation.hpp>

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <filesystem>

namespace toile::python {

namespace nb = nanobind;
using namespace nb::literals;

namespace {

// The report of an advance() in two parts, as if it were one.
StepReport then(const StepReport& first, const StepReport& next) {
  StepReport both = next;
  both.steps += first.steps;
  both.rejected += first.rejected;
  both.cg_iterations += first.cg_iterations;
  if (first.steps > 0) {
    both.step_min_s = next.steps > 0 ? std::min(first.step_min_s, next.step_min_s) : first.step_min_s;
    both.step_max_s = std::max(first.step_max_s, next.step_max_s);
  }
  return both;
}

std::string text_of(const nb::bytes& bytes) { return {bytes.c_str(), bytes.size()}; }
nb::bytes bytes_of(const State& state) { return nb::bytes(state.bytes().data(), state.bytes().size()); }

}  // namespace

void bind_reports(nb::module_& module) {
  nb::class_<DressReport>(module, "DressReport",
                          "What Simulation.dress() came to.  True where it is worn as it should be.")
      .def_prop_ro("ok", &DressReport::ok, "No reasons against it.")
      .def("__bool__", &DressReport::ok)
      .def_ro("ended", &DressReport::ended, "'still', 'time', 'seam_blocked', 'step_collapsed', 'time_limit' ...")
      .def_ro("reasons", &DressReport::reasons, "Why it is not worn as it should be; empty: it is.")
      .def_ro("warnings", &DressReport::warnings)
      .def_ro("simulated_s", &DressReport::simulated_s, "Simulated time, s.")
      .def("explain", &DressReport::explain, "One line for each reason and warning.")
      .def("__repr__", [](const DressReport& self) { return "<DressReport: " + self.explain() + ">"; });

  nb::class_<StepReport>(module, "StepReport", "What one advance() came to.  True where it reached its end.")
      .def_prop_ro("ok", &StepReport::ok, "It reached its end.")
      .def("__bool__", &StepReport::ok)
      .def_ro("reached", &StepReport::reached, "False: the cloth stays where the last good step left it.")
      .def_ro("cancelled", &StepReport::cancelled, "It was told to end early; advance() goes on from there.")
      .def_ro("steps", &StepReport::steps, "Steps taken.")
      .def_ro("rejected", &StepReport::rejected, "Steps taken back, to be tried again shorter.")
      .def_ro("step_min_s", &StepReport::step_min_s, "The shortest step, s.")
      .def_ro("step_max_s", &StepReport::step_max_s, "The longest step, s.")
      .def_ro("cg_iterations", &StepReport::cg_iterations, "Iterations of conjugate gradients, all steps together.")
      .def_ro("diagnosis", &StepReport::diagnosis,
              "Of a step that could not be made however short: which triangles, and why.")
      .def("explain", &StepReport::explain, "In one sentence.")
      .def("then", &then, "next"_a, "Both as one, where `next` went on from here.")
      .def("__repr__", [](const StepReport& self) { return "<StepReport: " + self.explain() + ">"; });

  nb::class_<State>(module, "State",
                    "All that decides how a simulation goes on, between two frames (Simulation.state).\n\n"
                    "Bytes that can be kept, sent and pickled; they are checked when they are used.")
      .def(
          "__init__", [](State* self, const nb::bytes& data) { new (self) State(text_of(data)); }, "data"_a)
      .def("to_bytes", &bytes_of, "What State() makes it of again.")
      .def_static(
          "load", [](const std::filesystem::path& path) { return State::load(path.string()); }, "path"_a,
          "Of a file that save() wrote.  IoError where it cannot be read.")
      .def(
          "save", [](const State& self, const std::filesystem::path& path) { self.save(path.string()); }, "path"_a,
          "IoError where it cannot be written.")
      .def("__eq__",
           [](const State& self, const nb::object& other) {
             return nb::isinstance<State>(other) && self.bytes() == nb::cast<const State&>(other).bytes();
           })
      .def("__hash__", [](const State& self) { return nb::hash(bytes_of(self)); })
      .def("__repr__", [](const State& self) { return "<State of " + std::to_string(self.bytes().size()) + " bytes>"; })
      .def("__getstate__", &bytes_of)
      .def("__setstate__", [](State& self, const nb::bytes& bytes) { new (&self) State(text_of(bytes)); });
}

}  // namespace toile::python
