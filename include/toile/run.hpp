// toile/run.hpp: runs as folders: what the program writes, from a simulation or from a scene, and pictures of it.    docs/reports.md
#pragma once
#include "toile/export.hpp"
#include "toile/simulation.hpp"
#include "toile/verify.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace toile {

// Writes frames of a simulation as files that other programs read: cloth.obj, cloth.pc2, body.obj, body.pc2 and report.json.
class TOILE_EXPORT RunWriter {
 public:
  // Makes the folder, or replaces a run of Toile's there, and writes frame 0: the simulation as it is now.  `fps` is how many frames a second has.
  // Throws IoError for files there that are not Toile's, and when another process writes there.
  RunWriter(const std::string& folder, const Simulation& simulation, double fps = 30);
  RunWriter(RunWriter&&) noexcept;
  RunWriter& operator=(RunWriter&&) noexcept;
  // Not finished: the folder says so, and is no pass.
  ~RunWriter();

  // The next frame.  Throws InputError for a simulation with other vertices.
  void add(const Simulation& simulation);
  int frames() const;
  // Writes the report; nothing can be added then.
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

// A scene file from beginning to end, into a folder.  A run that is cancelled can be resumed by the program.
TOILE_EXPORT Verdict run_scene(const std::string& path, const std::string& folder, const RunOptions& options = {});

struct ExportOptions {
  std::string to = {};       // "obj", "ply" or "gltf"; empty: by the ending of `out`
  std::string of = "cloth";  // or "body"
  int frame = -1;            // -1: the last
  bool all = false;          // every frame, in numbered files of the folder `out`
};

// Frames of a run's folder as files for other programs, into `out`; what was written.  Panels keep their names, vertices of a seam are split where the
// format has one uv for each.  Throws InputError for a frame or a body that there is not, IoError for a file of the run that would be written over.
TOILE_EXPORT std::vector<std::string> export_run(const std::string& folder, const std::string& out,
                                                 const ExportOptions& options = {});

// preview.png and preview.mp4 of a run's folder.  Throws Error(usage) when the library was built without pictures.
TOILE_EXPORT void preview(const std::string& folder);

// A still in memory.
struct PictureOptions {
  int width = 480, height = 480;  // pixels
  // Where it is seen from: 0 is the front (+z), 90 its left side (+x), 180 the back; from how far above.
  double azimuth_deg = 25, elevation_deg = 10;
  int samples = 8;  // paths per pixel: 8 do, 24 are smooth
};

// The bytes of a PNG: cloth, body and solids on the ground, the cloth filling the picture.  The same bits for any number of threads.  Throws
// Error(usage) when the library was built without pictures, InputError for a size that cannot be drawn.
TOILE_EXPORT std::string picture(const Simulation& simulation, const PictureOptions& options = {});
// The same of the last frame in a run's folder, finished or not.  Throws IoError where there is no run.
TOILE_EXPORT std::string picture(const std::string& folder, const PictureOptions& options = {});

}  // namespace toile
