// module.cpp: toile._toile, direct bindings of the C++ library.  The package that users import builds on it: toile/*.py.
#include "module.hpp"

#include <toile/version.hpp>

NB_MODULE(_toile, module) {
  using namespace toile::python;
  module.doc() = "The C++ library as it is (include/toile/*.hpp).  Use the package `toile`, which stands on it.";
  module.attr("version") = toile::version();
  bind_errors(module);
  bind_fabric(module);
  bind_cloth(module);
  bind_body(module);
  bind_verdicts(module);
  bind_reports(module);
  bind_simulation(module);
  bind_runs(module);
  bind_pictures(module);
}
