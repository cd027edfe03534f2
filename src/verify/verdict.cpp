// verify/verdict.cpp: see the header.
#include "verify/verdict.hpp"

#include "core/error.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

std::string percent(double fraction) { return fmt::sprintf("%.3g %%", 100 * fraction); }

std::string number(double value) { return fmt::sprintf("%.3g", value); }

std::string first_one(const std::vector<Crossing>& crossings) {
  if (crossings.empty()) return "";
  const Crossing& c = crossings.front();
  return "; the first is the edge of " + std::string(c.edge_of_body ? "body" : "cloth") + " vertices " +
         std::to_string(c.edge[0]) + ", " + std::to_string(c.edge[1]) + " near (" + number(c.position.x()) + ", " +
         number(c.position.y()) + ", " + number(c.position.z()) + ") m";
}

std::string edges(int found, int limit, const std::vector<Crossing>& crossings, const char* through) {
  return std::to_string(found) + " edges pass through " + through + " in the last frame, limit " +
         std::to_string(limit) + first_one(crossings);
}

std::string first_of(const std::vector<std::string>& all) {
  return all.size() == 1 ? all.front() : all.front() + "; and " + std::to_string(all.size() - 1) + " more";
}

// Written so that NaN is an excess.
bool within(double value, double limit) { return value <= limit; }

// The cloth that is too long: its place, its length as cut and as worn, and the girth of the body within it.
std::string misfit(const StretchStatistics& s, const Limits& limits) {
  std::string text;
  if (s.ring.cut_m < s.body_girth_m)
    text = fmt::sprintf("too narrow by %.1f cm: ", 100 * (s.body_girth_m - s.ring.cut_m));
  if (s.ring.cut_m > 0)
    text += fmt::sprintf(s.ring.closed ? "the garment is %.1f cm round and worn at %.1f cm"
                                       : "the cloth is %.1f cm long from hem to hem and worn at %.1f cm",
                         100 * s.ring.cut_m, 100 * s.ring.worn_m) +
            (s.body_girth_m > 0 ? fmt::sprintf(", around %.1f cm of body,", 100 * s.body_girth_m) : "") + " near (" +
            number(s.gauge_worst_m.x()) + ", " + number(s.gauge_worst_m.y()) + ", " + number(s.gauge_worst_m.z()) +
            ") m, where it is stretched most; ";
  return text + fmt::sprintf("over %.3g mm of cloth p99 ", 1e3 * gauge_m) + percent(s.gauge_p99) + ", limit " +
         percent(limits.stretch_p99) + "; max " + percent(s.gauge_max) + ", limit " + percent(limits.stretch_max);
}

// The edges or shoulders that held a garment and have slid; empty if none has.
std::string slid(const SlipStatistics& slip, const Limits& limits) {
  std::string text;
  const auto add = [&](const std::string& what, const Slip& s, double limit_m) {
    text +=
        (text.empty() ? "" : "; ") + what +
        fmt::sprintf(" %.1f cm against the body since it began to move, limit %.1f cm; most was %.1f cm, in frame %d",
                     100 * s.last_m, 100 * limit_m, 100 * s.worst_m, s.worst_frame);
  };
  for (const LoopSlip& loop : slip.loops)
    if (loop.holds && !within(loop.drop.last_m, limits.slip_m))
      add(loop.girth_m > 0 ? fmt::sprintf("the edge of %s, %.0f cm round at %.2f m, dropped", printable(loop.name),
                                          100 * loop.girth_m, loop.height_m)
                           : fmt::sprintf("what of %s lay highest on the body, at %.2f m, dropped",
                                          printable(loop.name), loop.height_m),
          loop.drop, limits.slip_m);
  if (!within(slip.shoulders.last_m, limits.shoulder_slip_m))
    add("what lay on a shoulder moved", slip.shoulders, limits.shoulder_slip_m);
  return text;
}

}  // namespace

bool is_measured_reason(std::string_view code) {
  return code == reason::static_equilibrium || code == reason::cloth_body_intersection ||
         code == reason::cloth_self_intersection || code == reason::not_finite || code == reason::stretch ||
         code == reason::slid_off;
}

Verdict judge(const VerifyReport& report, const Limits& limits) {
  Verdict verdict;
  verdict.limits = limits;
  for (const Reason& reported : report.reported_qualifications)  // but not what is measured here
    if (reported.code != reason::pinched_cloth) verdict.qualifications.push_back(reported);
  const auto add = [&](std::string_view code, std::string detail) {
    const bool known =
        std::any_of(verdict.reasons.begin(), verdict.reasons.end(), [&](const Reason& r) { return r.code == code; });
    if (!known) verdict.reasons.push_back({std::string(code), std::move(detail)});
  };

  if (!report.changes.empty()) add(reason::data_changed, first_of(report.changes));
  if (!report.changed_inputs.empty())
    verdict.qualifications.push_back(
        {std::string(reason::inputs_changed),
         "since the run read it, something else stands in " + first_of(report.changed_inputs)});
  if (!report.interrupted.empty())
    add(reason::unfinished, report.interrupted);
  else if (report.frames == 0 || report.frames < report.frames_expected)
    add(reason::unfinished,
        std::to_string(report.frames) + " frames, expected " + std::to_string(std::max(report.frames_expected, 1)));
  for (const std::string& code : report.reported_reasons) add(code, "reported by the run");
  if (!report.finite)
    add(reason::not_finite,
        "frame " + std::to_string(report.first_bad_frame) + " has a position that is infinite or NaN");

  if (report.finite && report.frames > 0) {
    const int with_room = report.outside_pinches.last, pinched = report.cloth_body_edges.last - with_room;
    if (with_room > limits.cloth_body_edges)
      add(reason::cloth_body_intersection,
          edges(with_room, limits.cloth_body_edges, report.last_outside_pinches, "the other surface"));
    if (pinched > 0)
      verdict.qualifications.push_back(
          {std::string(reason::pinched_cloth), std::to_string(pinched) +
                                                   " edges pass between cloth and body in the last frame, where parts "
                                                   "of the body leave no room between them" +
                                                   (with_room > 0 ? "" : first_one(report.last_body_crossings))});
    if (report.cloth_cloth_edges.last > limits.cloth_cloth_edges)
      add(reason::cloth_self_intersection,
          edges(report.cloth_cloth_edges.last, limits.cloth_cloth_edges, report.last_cloth_crossings, "the cloth"));
    const StretchStatistics& s = report.stretch;
    if (!within(s.gauge_p99, limits.stretch_p99) || !within(s.gauge_max, limits.stretch_max))
      add(reason::stretch, misfit(s, limits));
    if (std::string text = slid(report.slip, limits); !text.empty()) add(reason::slid_off, std::move(text));
    if (limits.must_be_still && report.frames < 2)
      add(reason::static_equilibrium, "one frame does not show whether the cloth moves");
    else if (limits.must_be_still && !within(report.still_mm_per_s_p99, limits.still_mm_per_s))
      add(reason::static_equilibrium, "p99 speed " + number(report.still_mm_per_s_p99) +
                                          " mm/s in the last second, limit " + number(limits.still_mm_per_s) + " mm/s");
  }
  verdict.pass = verdict.reasons.empty();
  return verdict;
}

}  // namespace toile::internal
