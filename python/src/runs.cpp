// runs.cpp: run folders.
#include "module.hpp"
#include "working.hpp"

#include <toile/run.hpp>

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

namespace toile::python {

using namespace nb::literals;

namespace {

Verdict whole_scene(const std::string& path, const std::string& folder, int threads, double time_limit_s,
                    nb::object progress) {
  Listener listener;
  return listened(listener, std::move(progress), [&] {
    RunOptions options;
    options.threads = threads;
    options.time_limit_s = time_limit_s;
    options.cancelled = [&] { return listener.stop(); };
    options.progress = [&](const Progress& told) { listener.tell(told); };
    return run_scene(path, folder, options);
  });
}

}  // namespace

void bind_runs(nb::module_& module) {
  nb::class_<RunWriter>(module, "RunWriter")
      .def(
          "__init__",
          [](RunWriter* self, const std::string& folder, const Working& simulation, double fps) {
            new (self) RunWriter(folder, simulation.look(), fps);
          },
          "folder"_a, "simulation"_a, "fps"_a)
      .def(
          "add", [](RunWriter& self, const Working& simulation) { self.add(simulation.look()); }, "simulation"_a)
      .def_prop_ro("frames", &RunWriter::frames)
      .def("finish", &RunWriter::finish, nb::call_guard<nb::gil_scoped_release>());
  module.def("run_scene", &whole_scene, "path"_a, "folder"_a, "threads"_a, "time_limit_s"_a, "progress"_a.none());
  module.def(
      "export_run",
      [](const std::string& folder, const std::string& out, const std::string& to, const std::string& of, int frame,
         bool all) { return export_run(folder, out, {.to = to, .of = of, .frame = frame, .all = all}); },
      nb::call_guard<nb::gil_scoped_release>(), "folder"_a, "out"_a, "to"_a, "of"_a, "frame"_a, "all"_a);
  module.def(
      "preview",
      [](const std::string& folder, const std::string& style, std::optional<Point> close_up_m, bool turntable,
         bool film, const std::string& looks) {
        preview(folder,
                {.style = style, .close_up_m = close_up_m, .turntable = turntable, .film = film, .looks = looks});
      },
      nb::call_guard<nb::gil_scoped_release>(), "folder"_a, "style"_a, "close_up_m"_a.none(), "turntable"_a, "film"_a,
      "looks"_a);
}

}  // namespace toile::python
