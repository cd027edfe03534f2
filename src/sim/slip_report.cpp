// sim/slip_report.cpp: how far a garment moved against its body, for a report (sim/report.hpp).
#include "core/error.hpp"
#include "sim/report.hpp"

#include <fmt/printf.h>

#include <cmath>

namespace toile::internal {

void add_slip(JsonText& text, const SlipStatistics& slip) {
  text.key("slip");
  if (slip.first_frame < 0) {
    text.null();
    return;
  }
  const auto add = [&](const Slip& s) {
    text.member("vertices", s.vertices);
    text.member("last_cm", 100 * s.last_m);
    text.member("worst_cm", 100 * s.worst_m);
    text.member("worst_frame", s.worst_frame);
  };
  const auto add_part = [&](std::string_view key, const Slip& s) {
    text.key(key);
    if (s.vertices == 0) {
      text.null();
      return;
    }
    text.begin_object();
    add(s);
    text.end_object();
  };
  text.begin_object();
  text.member("first_frame", slip.first_frame);
  add_part("waist_drop", slip.waist);
  add_part("shoulder_slip", slip.shoulders);
  text.key("loops");
  text.begin_array();
  for (const LoopSlip& loop : slip.loops) {
    text.begin_object();
    text.member("panels", loop.name);
    text.member("height_m", loop.height_m);
    text.key("girth_m");
    loop.girth_m > 0 ? text.value(loop.girth_m) : text.null();
    text.member("holds", loop.holds);
    add(loop.drop);
    text.end_object();
  }
  text.end_array();
  text.end_object();
}

std::string slip_line(const SlipStatistics& slip) {
  if (slip.first_frame < 0) return "";
  std::string line;
  const auto add = [&](const std::string& what, const Slip& s) {
    if (s.vertices == 0) return;
    const auto cm = [](double m) { return std::round(1000 * m) / 10 + 0.0; };  // no -0
    line += (line.empty() ? "  against the moving body: " : "; ") + what +
            fmt::sprintf(" %.1f cm (at worst %.1f)", cm(s.last_m), cm(s.worst_m));
  };
  add("waist dropped", slip.waist);
  add("shoulders slipped", slip.shoulders);
  for (const LoopSlip& loop : slip.loops)
    if (loop.holds)
      add((loop.girth_m > 0 ? "the edge of " : "what lies highest of ") + printable(loop.name) + " dropped", loop.drop);
  return line.empty() ? "" : line + '\n';
}

}  // namespace toile::internal
