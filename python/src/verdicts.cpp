// verdicts.cpp: verdicts of the judge and findings of the linter.
#include "module.hpp"

#include <toile/verify.hpp>

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

namespace toile::python {

namespace nb = nanobind;
using namespace nb::literals;

void bind_verdicts(nb::module_& module) {
  nb::class_<Reason>(module, "Reason", "Why something is not as it should be.")
      .def_ro("code", &Reason::code, "One word of docs/reason-codes.md.")
      .def_ro("detail", &Reason::detail, "What was measured, and where.")
      .def("__repr__", [](const Reason& self) { return self.code + ": " + self.detail; });

  nb::class_<Crossings>(module, "Crossings", "Edges that pass through a triangle, by exact tests on float32 positions.")
      .def_ro("cloth_body_edges", &Crossings::cloth_body_edges)
      .def_ro("cloth_cloth_edges", &Crossings::cloth_cloth_edges)
      .def("__repr__", [](const Crossings& self) {
        return "Crossings(cloth_body_edges=" + std::to_string(self.cloth_body_edges) +
               ", cloth_cloth_edges=" + std::to_string(self.cloth_cloth_edges) + ")";
      });

  nb::class_<Verdict>(module, "Verdict", "What an independent judge says of a run.  True where it passes.")
      .def_ro("passed", &Verdict::pass, "Closed, at rest, not overstretched, nothing passing through anything.")
      .def("__bool__", [](const Verdict& self) { return self.pass; })
      .def_ro("reasons", &Verdict::reasons, "Why it does not pass; empty when and only when it does.")
      .def_ro("qualifications", &Verdict::qualifications, "Reservations that take nothing from a pass.")
      .def_ro("frames", &Verdict::frames, "How many there are.")
      .def_ro("last", &Verdict::last, "Crossings of the last frame.")
      .def_ro("most", &Verdict::most, "Crossings of the frame that has most.")
      .def_ro("stretch_p99", &Verdict::stretch_p99, "Of the last frame; 0.05 is 5 % longer than cut.")
      .def_ro("stretch_max", &Verdict::stretch_max, "Of the last frame.")
      .def_ro("still_mm_per_s_p99", &Verdict::still_mm_per_s_p99, "Speed in the last second, mm/s.")
      .def("explain", &Verdict::explain, "A line for each of all this.")
      .def("__repr__", [](const Verdict& self) { return "<Verdict: " + self.explain() + ">"; });
  module.def("verify", &verify, nb::call_guard<nb::gil_scoped_release>(), "folder"_a);

  nb::class_<Finding>(module, "Finding", "What is wrong with a pattern, or probably not meant.")
      .def_ro("code", &Finding::code, "One word of docs/reason-codes.md.")
      .def_ro("severity", &Finding::severity, "'error': it cannot be used; 'warning': probably not meant; 'note'.")
      .def_ro("where", &Finding::where, "File, line and column.")
      .def_ro("place", &Finding::place, "Panel and edge.")
      .def_ro("expected", &Finding::expected, "What should be there.")
      .def_ro("got", &Finding::got, "What is there.")
      .def_ro("repair", &Finding::repair, "What would mend it, or why nothing does.")
      .def_ro("mended", &Finding::mended, "It is mended in CheckReport.mended_text.")
      .def("__repr__", [](const Finding& self) {
        return "<Finding " + self.severity + " " + self.code + " at " + self.where + ", " + self.place + ">";
      });
  nb::class_<CheckReport>(module, "CheckReport", "What check_pattern() finds.  True where the pattern can be used.")
      .def_ro("findings", &CheckReport::findings, "In the order of the file.")
      .def_ro("usable", &CheckReport::usable, "As it is, or mended.")
      .def("__bool__", [](const CheckReport& self) { return self.usable; })
      .def_ro("mended_text", &CheckReport::mended_text,
              "The pattern with all that could be mended; empty when nothing was.")
      .def("explain", &CheckReport::explain, "A line for each finding.")
      .def("__repr__", [](const CheckReport& self) { return "<CheckReport: " + self.explain() + ">"; });
  module.def("check_pattern", &check_pattern, nb::call_guard<nb::gil_scoped_release>(), "path"_a);
}

}  // namespace toile::python
