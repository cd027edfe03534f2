// toile/verify.hpp: the verdict of an independent judge on simulated cloth, and checks of patterns before any simulation.
//
// The judge measures positions and shares no code with the solver and its contact.                        docs/reason-codes.md
#pragma once
#include "toile/export.hpp"

#include <string>
#include <vector>

namespace toile {

struct Reason {
  std::string code;    // one word of docs/reason-codes.md
  std::string detail;  // the measured value, and its place
};

struct Crossings {
  int cloth_body_edges = 0, cloth_cloth_edges = 0;  // edges that pass through a triangle, by exact tests
};

struct Verdict {
  bool pass = false;
  std::vector<Reason> reasons;         // empty when and only when it passes
  std::vector<Reason> qualifications;  // reservations that take nothing from a pass
  int frames = 0;
  Crossings last, most;                      // of the last frame; the most of any frame
  double stretch_p99 = 0, stretch_max = 0;   // of the last frame, as they are judged: 0.05 is 5 % longer than cut
  double still_mm_per_s_p99 = 0;             // of the last second
  TOILE_EXPORT std::string explain() const;  // one line for each of these
};

// Reads and measures every frame of a run folder.  Throws IoError and InputError for files that are missing or invalid.
TOILE_EXPORT Verdict verify(const std::string& folder);

struct Finding {
  std::string code;
  std::string severity;  // "error": it cannot be used; "warning": probably not meant; "note"
  std::string where;     // "p.json:12:5"
  std::string place;     // panel "front", edge 3, at (12.0, 40.3) cm
  std::string expected, got;
  std::string repair;  // how to mend it, or why it cannot be mended
  bool mended = false;
};
struct CheckReport {
  std::vector<Finding> findings;
  bool usable = false;      // as it is, or after mending
  std::string mended_text;  // the pattern with all that could be mended; empty when nothing was
  TOILE_EXPORT std::string explain() const;
};

// Checks a sewing pattern (GarmentCode's JSON) for errors and for input that is probably not meant; simulates nothing.  Throws IoError.
TOILE_EXPORT CheckReport check_pattern(const std::string& path);

}  // namespace toile
