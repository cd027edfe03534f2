// sim/picture_run.hpp: a still and a film of a finished run, from its files.                         docs/command-line.md#preview
//
//   preview.png     front, side and back of the last frame; crossings in red
//   preview.mp4     the sewing, if there was one, then the drape, then the motion in real time: 4 s, or 12 s with a motion; in studio style at full length
//   frames.png      chosen frames side by side, when any are chosen
//   close-up.png    the last frame around a point, when one is given
//   turntable.mp4   once around the last frame, when asked for
#pragma once
#include "core/types.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace toile::internal {

class Looks;

enum class PictureStyle {
  technical,  // cloth as simulated, with a grid along its threads: to judge it
  studio,     // smooth, thick, woven, with seams and hems: to show it
};

struct PictureOptions {
  PictureStyle style = PictureStyle::technical;
  int sheet_width = 400, sheet_height = 560, sheet_samples = 12;  // of one view
  int film_width = 360, film_height = 480, film_samples = 6;
  double film_fps = 15;
  int most_film_frames = 60, most_motion_frames = 120;
  double film_edge_m = 0.01;           // RenderOptions::display_edge_m
  std::shared_ptr<const Looks> looks;  // colours and prints, preview/looks.hpp; none: those of the fabrics
  std::optional<Vec3> close_up_m;
  bool turntable = false, film = true;
  std::vector<int>
      frames;  // of frames.png, counted from the first frame of the motion, or of the cloth if there is none
};
// Three views, 1918 x 1080 together, and a film in 720 x 960 of the whole motion.
PictureOptions studio_pictures();

// Throws InputError for looks of panels, garments or fabrics that the run does not have.  `progress` gets the share done and may be empty; `stop` may be empty.  Throws IoError or InputError for files that are missing or wrong,
// and Error (usage) where Toile is built without pictures, before any file is read (preview/preview.hpp: can_draw).
// A run whose seams did not close has no cloth.obj: its last sewing frame is pictured.
void picture_run(const std::string& directory, const PictureOptions& options,
                 const std::function<void(double)>& progress, const std::function<bool()>& stop);

// The crossings of one frame in red, from three sides, as close as all of them fit.  Throws as picture_run.
void picture_crossings(const std::string& directory, int frame, const std::string& png);

}  // namespace toile::internal
