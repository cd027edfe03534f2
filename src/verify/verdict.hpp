// verify/verdict.hpp: pass or fail, with a code for each reason.                                   docs/reason-codes.md
//
// pass = the run reached its end, everything is finite, the last frame has no crossings but those of cloth that the body pinches, the cloth
// outside elastic is stretched by at most the limits, it has not slid off a body that moved, and, where the run was to come to rest, it has.
//
// Easily got wrong: earlier frames may cross (a bad start that was untangled) and still pass.  Their counts are in the
// report, for stricter checks.
#pragma once
#include "verify/verify.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

struct Limits {
  int cloth_body_edges = 0, cloth_cloth_edges = 0;  // of the last frame; with the body where it leaves room
  double stretch_p99 = 0.08, stretch_max = 0.25;    // over a gauge, of the last frame, outside elastic
  bool must_be_still = false;                       // `dress` without motion
  double still_mm_per_s = 5;
  // Slip of the edge, or of the cloth on the shoulders, that holds a garment, relative to a body that has moved, in the last frame.
  double slip_m = 0.05, shoulder_slip_m = 0.08;
};

// Stable names, for scripts.  The first three are GarmentCode's.
namespace reason {
inline constexpr std::string_view static_equilibrium = "static_equilibrium";
inline constexpr std::string_view cloth_body_intersection = "cloth_body_intersection";
inline constexpr std::string_view cloth_self_intersection = "cloth_self_intersection";
inline constexpr std::string_view not_finite = "not_finite";
inline constexpr std::string_view stretch = "stretch";
inline constexpr std::string_view slid_off = "slid_off";
inline constexpr std::string_view unfinished = "unfinished";
inline constexpr std::string_view data_changed = "data_changed";
inline constexpr std::string_view moved_by_untangling = "moved_by_untangling";  // a qualification, like the next ones
inline constexpr std::string_view inputs_changed = "inputs_changed";
inline constexpr std::string_view pinched_cloth = "pinched_cloth";
}  // namespace reason

// Whether the judge decides this code by measuring the files, without trusting the report.  `unfinished` is not such a
// code: a run that stopped early and says so is unfinished, whatever its number of frames.
bool is_measured_reason(std::string_view code);

struct Verdict {
  bool pass = false;
  std::vector<Reason> reasons;         // empty when and only when pass; each code at most once
  std::vector<Reason> qualifications;  // reservations that take nothing from a pass; likewise
  Limits limits;                       // the limits that were applied
};

// A value that is not finite invalidates all later measurements: then the codes that need the last frame are left out.
Verdict judge(const VerifyReport& report, const Limits& limits = {});

}  // namespace toile::internal
