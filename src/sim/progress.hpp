// sim/progress.hpp: the progress of a simulation, and the reason codes of its own.                   docs/reason-codes.md
#pragma once
#include <string_view>

namespace toile::internal {

struct Progress {
  std::string_view phase;    // "meshing", "placing", "sewing", "untangling", "fitting", "draping" ...
  double share = 0;          // of the phase, 0 ... 1
  double seconds_left = -1;  // of the phase; -1: unknown
};

namespace reason {
inline constexpr std::string_view seam_blocked = "seam_blocked";
inline constexpr std::string_view step_collapsed = "step_collapsed";
inline constexpr std::string_view interrupted = "interrupted";
inline constexpr std::string_view time_limit = "time_limit";
inline constexpr std::string_view not_settled = "not_settled";
inline constexpr std::string_view never_touched = "never_touched";
inline constexpr std::string_view fell_off = "fell_off";
}  // namespace reason

}  // namespace toile::internal
