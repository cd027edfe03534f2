// module.hpp: the parts of the module, each in a file of its own.
#pragma once
#include <nanobind/nanobind.h>

namespace toile::python {

void bind_errors(nanobind::module_& module);
void bind_fabric(nanobind::module_& module);
void bind_cloth(nanobind::module_& module);
void bind_body(nanobind::module_& module);
void bind_reports(nanobind::module_& module);
void bind_simulation(nanobind::module_& module);
void bind_verdicts(nanobind::module_& module);
void bind_runs(nanobind::module_& module);
void bind_pictures(nanobind::module_& module);

}  // namespace toile::python
