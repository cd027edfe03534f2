// toile/run.hpp: run folders, as the program writes them, from a simulation or a scene, and pictures of them.        docs/reports.md
#pragma once
#include "toile/export.hpp"
#include "toile/simulation.hpp"
#include "toile/verify.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace toile {

// Writes frames of a simulation as files that other programs read: cloth.obj, cloth.pc2, body.obj, body.pc2 and report.json.
class TOILE_EXPORT RunWriter {
 public:
  // Makes the folder, or replaces a run of Toile's there, and writes frame 0, the simulation's present state.  `fps`: frames per second.
  // Throws IoError for files there that are not Toile's, and when another process writes there.
  RunWriter(const std::string& folder, const Simulation& simulation, double fps = 30);
  RunWriter(RunWriter&&) noexcept;
  RunWriter& operator=(RunWriter&&) noexcept;
  // Without finish() the folder is marked as unfinished, which is no pass.
  ~RunWriter();

  // Writes the next frame.  Throws InputError for a simulation with another number of vertices.
  void add(const Simulation& simulation);
  int frames() const;
  // Writes the report; no frame can be added afterwards.
  Verdict finish();

 private:
  struct TOILE_HIDDEN Parts;
  std::unique_ptr<Parts> parts_;
};

struct RunOptions {
  int threads = 0;          // 0: one per core
  double time_limit_s = 0;  // wall time that dressing may take; 0: any
  std::function<bool()> cancelled = {};
  std::function<void(const Progress&)> progress = {};
};

// Runs a scene file from beginning to end, into a folder.  The program can resume a cancelled run.
TOILE_EXPORT Verdict run_scene(const std::string& path, const std::string& folder, const RunOptions& options = {});

struct ExportOptions {
  std::string to = {};       // "obj", "ply", "gltf", "usda", "pc2" or "mdd"; empty: by the file extension of `out`
  std::string of = "cloth";  // or "body", or of USD "both"
  int frame = -1;            // -1: the last, and of usda, pc2 and mdd all in one file
  bool all = false;  // every frame, in numbered files of the folder `out`, or in one file `out` that ends in .glb
};

// Writes frames of a run folder to `out`, as files for other programs; returns their paths.  Panels keep their names, vertices of a seam are split
// where the format has one uv per vertex.  Throws InputError for a missing frame or body, IoError instead of overwriting a file of the run.
TOILE_EXPORT std::vector<std::string> export_run(const std::string& folder, const std::string& out,
                                                 const ExportOptions& options = {});

struct PreviewOptions {
  // "technical": cloth as simulated, with a grid along its threads; "studio": smooth, thick, woven, sewn.
  std::string style = "technical";
  std::optional<Point> close_up_m = {};  // also close-up.png: 30 cm around this point, in the last frame
  bool turntable = false;                // also turntable.mp4: once around the last frame
  bool film = true;                      // preview.mp4
  std::string looks = {};  // a file of colours and prints, docs/howto/preview.md; empty: those of the fabrics
};

// Writes preview.png and preview.mp4 into a run folder.  Throws Error(usage) when the library was built without pictures, InputError for another
// style and for looks that are wrong or of panels, garments or fabrics that the run does not have.
TOILE_EXPORT void preview(const std::string& folder, const PreviewOptions& options = {});

// A still image in memory.
struct PictureOptions {
  int width = 480, height = 480;  // pixels
  // The view: azimuth 0 is from the front (+z), 90 from its left side (+x), 180 from the back; elevation is upwards.
  double azimuth_deg = 25, elevation_deg = 10;
  int samples = 8;  // paths per pixel: 8 are enough, 24 are smooth
};

// The bytes of a PNG: cloth, body and solids on the ground, framed on the cloth.  The same bits for any number of threads.  Throws
// Error(usage) when the library was built without pictures, InputError for a size that cannot be drawn.
TOILE_EXPORT std::string picture(const Simulation& simulation, const PictureOptions& options = {});
// The same of the last frame in a run folder, finished or not.  Throws IoError where there is no run.
TOILE_EXPORT std::string picture(const std::string& folder, const PictureOptions& options = {});

}  // namespace toile
