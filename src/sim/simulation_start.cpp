// sim/simulation_start.cpp: crossings of the cloth before its first frame, and their untangling.
#include "core/error.hpp"
#include "dress/start_state.hpp"
#include "sim/simulation.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace toile::internal {
namespace {

constexpr double most_waiting_s = 1;

}  // namespace

void Simulation::bad_start(const std::string& name, const std::string& what) {
  if (scene_.strict_start) throw Error(ErrorKind::bad_start, printable(name) + ": bad start: " + what);
  report_.warnings.push_back("bad start: " + what);
}

// Cloth that passes through itself or the body is untangled before the first frame, as far as possible (dress/start_state.hpp).
// `sewn_now`: the crossings come from sewing, not from the user's input, to which alone --strict-start applies.
bool Simulation::free_start(bool sewn_now) {
  const Timed timed(startup(&StartupReport::crossings));
  const StartCrossings found = start_crossings(outfit_, body_triangles_, body_x_);
  if (found.all() == 0) return true;
  std::string what = std::to_string(found.cloth_cloth) + " edges of the cloth pass through it";
  if (body_) what += ", " + std::to_string(found.cloth_body) + " between cloth and body";
  if (scene_.strict_start && !sewn_now)
    throw Error(ErrorKind::bad_start, printable(outfit_.parts.front().name) + ": bad start: " + what);
  say("untangling", 0);
  const UntangledStart untangled = untangle_start(
      outfit_, body_triangles_, body_x_, held_now(sewn_now), [&] { return stopped(); }, sewn_now ? sewn_in_vain : 0);
  if (!untangled.moved_far.empty()) qualify(reason::moved_by_untangling, untangled.moved_far);
  const int weightless = sewn_now ? come_apart() : 0;
  // How far it came is not reproducible: a resumed run untangles from the beginning.
  if (stopped() && !cut_off("while untangling")) return false;
  const StartCrossings left = start_crossings(outfit_, body_triangles_, body_x_);
  StartReport& start = report_.start;  // of the last of several sewn garments; trials of all of them
  start = {found.cloth_cloth,
           found.cloth_body,
           left.cloth_cloth,
           left.cloth_body,
           start.trials + untangled.trials,
           std::max(start.largest_move_mm, untangled.largest_move_mm)};
  const std::string then = left.all() == 0 ? "none is left" : std::to_string(left.all()) + " are left";
  std::string tried = std::to_string(untangled.trials) + " trials of untangling ";
  if (weightless > 0)
    tried += "and " + std::to_string(weightless) + (weightless == 1 ? " frame" : " frames") + " without weight ";
  report_.warnings.push_back((sewn_now ? "as sewn: " : "bad start: ") + what + "; after " + tried + then);
  return true;
}

// Particles that untangling must not move: those of inner garments, or those pinned from the start.
std::vector<Index> Simulation::held_now(bool sewn_now) const {
  if (!sewn_now) return held_from_the_start(events_of(scene_, outfit_, cloth_));
  std::vector<Index> worn(static_cast<std::size_t>(new_garment_->worn_before));
  std::iota(worn.begin(), worn.end(), 0);
  return worn;
}

// Crossings that remain after trials from rest may come apart as the garment moves, its threads contracting to their rest length, before
// it has weight: first pushed gently, and where that is in vain from the same state with all force.  These frames are not written.  Threads
// do not buckle in them: what crosses is crumpled, and straightens by the push that its threads resist.  Returns the number of frames.
int Simulation::come_apart() {
  const auto crosses = [&] { return start_crossings(outfit_, {}, {}).all() > 0; };
  if (!crosses()) return 0;
  const int most = frames_in(most_waiting_s);
  const Outfit welded = outfit_;
  OutfitRunOptions options = run_options(scene_, step_, stop());
  options.model.threads_buckle = false;
  int frames = 0;
  for (const bool gently : {true, false}) {
    if (!gently) outfit_ = welded;
    OutfitRun apart(options, outfit_, body(), new_garment_.value_or(NewGarment{}));
    apart.begin(coming_apart(pace()));
    apart.push_tangles_gently(gently);
    bool goes_on = true;
    for (int k = 0; k < most && goes_on && crosses(); ++k) {
      const FrameReport frame = apart.frame();
      goes_on = !frame.interrupted && frame.ok;  // else the drape will report it
      frames += goes_on ? 1 : 0;
    }
    if (stopped() || !crosses()) break;
  }
  outfit_.state.v.assign(outfit_.state.v.size(), Vec3::Zero());
  return frames;
}

}  // namespace toile::internal
