// pictures.cpp: still images as bytes.
#include "module.hpp"
#include "working.hpp"

#include <toile/run.hpp>

#include <nanobind/stl/string.h>

namespace toile::python {

using namespace nb::literals;

namespace {

nb::bytes bytes_of(const std::string& png) { return nb::bytes(png.data(), png.size()); }

}  // namespace

void bind_pictures(nb::module_& module) {
  module.def(
      "picture_of_simulation",
      [](Working& simulation, int width, int height, double azimuth_deg, double elevation_deg, int samples) {
        const PictureOptions options{width, height, azimuth_deg, elevation_deg, samples};
        return bytes_of(simulation.work([&](Simulation& s) { return picture(s, options); }));
      },
      "simulation"_a, "width"_a, "height"_a, "azimuth_deg"_a, "elevation_deg"_a, "samples"_a);
  module.def(
      "picture_of_run",
      [](const std::string& folder, int width, int height, double azimuth_deg, double elevation_deg, int samples) {
        const PictureOptions options{width, height, azimuth_deg, elevation_deg, samples};
        const std::string png = [&] {
          const nb::gil_scoped_release others_may_run;
          return picture(folder, options);
        }();
        return bytes_of(png);
      },
      "folder"_a, "width"_a, "height"_a, "azimuth_deg"_a, "elevation_deg"_a, "samples"_a);
}

}  // namespace toile::python
