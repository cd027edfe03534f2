// sim/report.hpp: the report of a run: report.json.                                                  docs/reports.md
//
// Keys are stable: add, never rename.  Times and memory differ between two runs of one command; everything else is the
// same to the bit.
#pragma once
#include "io/json_text.hpp"
#include "step/layer_gap.hpp"
#include "verify/verdict.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace toile::internal {

class JsonText;

struct PhaseReport {  // of the sewing, or of everything after it
  int frames = 0;     // simulated: one less than the samples of the cache
  double seconds = 0, eval = 0, cg = 0, cloth_cloth = 0, cloth_solid = 0, body = 0;  // wall time, s
  double filter = 0;                                                                 // of cloth_cloth
  long steps = 0, steps_rejected = 0, passes = 0, cg_iterations = 0;
  int cg_max = 0;
  long met = 0,
       refused = 0;  // steps in which the safe filter met impacts; steps rejected for impacts it could not prevent
  long corrected = 0,
       truncated = 0;  // particles that the safe filter moved, summed over steps; those with clipped motion
  long pierced = 0;    // impacts of cloth with the body that it could not prevent, summed over steps
  int pinched = 0;     // particles held between parts of the body, most of all steps
  long touching = 0, contact_rows = 0;  // in the last step of each frame, summed over frames
  double step_min_s = 0, step_max_s = 0;
  double simulated_s = 0;
  template <class Archive>
  void remember(Archive& archive) {
    archive(frames, seconds, eval, cg, cloth_cloth, cloth_solid, body, filter, steps, steps_rejected, passes,
            cg_iterations, cg_max, met, refused, corrected, truncated, pierced, pinched, touching, contact_rows,
            step_min_s, step_max_s, simulated_s);
  }
};

struct StartupReport {  // wall time before the first step, s
  double total = 0;
  double scene = 0;      // from the program's start until the scene is read
  double cloth = 0;      // reading patterns and meshing
  double body = 0;       // its mesh, motion and tree
  double placement = 0;  // of the panels, and which seams lie behind the body
  double crossings = 0;  // finding and untangling them
  template <class Archive>
  void remember(Archive& archive) {
    archive(total, scene, cloth, body, placement, crossings);
  }
};

struct StartReport {  // cloth that passed through itself or the body before the first frame; edges
  int cloth_cloth = 0, cloth_body = 0;
  int cloth_cloth_left = 0, cloth_body_left = 0;
  int trials = 0;
  double largest_move_mm = 0;
  template <class Archive>
  void remember(Archive& archive) {
    archive(cloth_cloth, cloth_body, cloth_cloth_left, cloth_body_left, trials, largest_move_mm);
  }
};

// A seam that sewing left open, or a part of it.
struct OpenSeam {
  std::string name;
  double gap_m = 0;                            // the widest, when sewing ended,
  Vec3 where{0, 0, 0};                         // and where
  std::vector<std::array<Index, 2>> vertices;  // of cloth.obj: pairs to be joined
  template <class Archive>
  void remember(Archive& archive) {
    archive(name, gap_m, where, vertices);
  }
};

// A file that the run read (core/hash.hpp), its path as seen from the folder of the run.
struct InputFile {
  std::string path, checksum;
};

// A file of the run as written (core/hash.hpp): an OBJ has one checksum, a cache one for its header and for each frame.
struct WrittenFile {
  std::string name, checksum;
  std::vector<std::string> frames;  // of a cache
};

struct Report {
  std::string command, name;
  std::string input_hash, state_hash;
  std::string ended;  // "still", "time", "seam_blocked", "step_collapsed", "time_limit", "interrupted" ...
  int threads = 1;
  int vertices = 0, triangles = 0, panels = 0, seams = 0;
  int body_vertices = 0, body_triangles = 0;
  double fps = 30;
  int frames = 0;  // samples of cloth.pc2
  double seconds_total = 0;
  StartupReport startup;
  PhaseReport sewing, drape;    // drape: everything after the weld, the motion too
  PhaseReport motion;           // from the first frame in which the body moves
  int motion_first_frame = -1;  // the last sample of cloth.pc2 before the body moves; -1: no motion
  std::string motion_name;
  Vec3 shift_m{0, 0, 0};  // of the flat panels before sewing
  StartReport start;
  std::vector<OpenSeam> open_seams;
  std::vector<std::string> warnings;
  std::vector<std::pair<std::string, std::array<double, 2>>> rest_stretch;  // panel, b along the two axes of vt
  struct PanelFabric {
    std::string garment, panel, fabric;
  };
  std::vector<PanelFabric> fabrics;
  VerifyReport audit;
  LayerGap layer_gap;  // last frame
  Verdict verdict;
  double peak_memory_mb = 0;
  std::vector<InputFile> inputs;
  std::vector<WrittenFile> files;

  // The values of a resumed run when it was left that do not follow from the scene.
  template <class Archive>
  void remember(Archive& archive) {
    archive(seconds_total, startup, sewing, drape, motion, motion_first_frame, shift_m, start, open_seams, warnings);
  }
};

std::string to_json(const Report& report, int indent = 2);
// Its members that a reader of an unfinished run needs: fps, body_vertices, rest_stretch ...
void add_facts(JsonText& json, const Report& report);

// The part common to report.json and `toile verify --json`: verdict, reasons, qualifications and their details, as members of an object.
void add_judgement(JsonText& text, const Verdict& verdict);
// The key "slip", likewise; and as a line of text, empty where no body moved.
void add_slip(JsonText& text, const SlipStatistics& slip);
std::string slip_line(const SlipStatistics& slip);
// "pass", "pass, with reservations: moved_by_untangling", "fail"; and a line for each reason and qualification.
std::string judgement_line(const Verdict& verdict);
std::string judgement_details(const Verdict& verdict);

// The program's version, from the build.
std::string_view toile_version();

}  // namespace toile::internal
