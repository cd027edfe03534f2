// preview/preview.hpp: pictures of cloth on a body: path traced, soft light, ground.  Cloth is drawn for inspection, as simulated and with a
// visible grid along u and v, or as in a studio: smooth, thick, woven, hemmed and stitched (preview/cloth_look.hpp).
//
// Same scene, camera and options: the same bits, for any number of threads.  Positions are in metres, y up; colours are linear
// RGB in [0, 1] (sRGB primaries); pictures are 8-bit sRGB.
//
// Mind: the lights turn with the camera (key from its left, rim from behind), so a back view is lit as well as a front view,
// and two pictures of one scene from two sides do not show the same shadows.
#pragma once
#include "core/types.hpp"
#include "mesh/cloth_mesh.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace toile::internal {

// Whether this build draws.  Without Embree and libpng (TOILE_PREVIEW) it does not, and all functions that trace rays or write a PNG throw
// Error (usage), "built without pictures".
bool can_draw();
// Throws that error, unless this build draws.
void require_pictures();

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // row by row from the top, 3 * width * height bytes
};

struct ClothLook;

struct PreviewCloth {
  std::span<const Triangle> triangles;
  std::span<const std::array<Vec2, 3>> uv;  // m, drawn as a grid, one line per `grid_m`; empty: no grid
  std::span<const Vec3> positions;          // of the frame to draw
  Vec3 colour{0.35, 0.45, 0.62};            // linear RGB of the right side; the wrong side is drawn duller
  std::span<const Vec3> colours = {};       // [triangle], instead of `colour`; empty: none
  // As in a studio, if there are looks: instead of grid and colour.
  std::span<const ClothLook> looks = {};
  std::span<const Index> look = {};  // [triangle] of looks
};

// The spans must stay alive during the call that takes the scene, not longer.
struct PreviewScene {
  std::vector<PreviewCloth> cloths;
  std::span<const Triangle> body_triangles;  // may be empty
  std::span<const Vec3> body_positions;
  double ground_y_m = 0;
  std::vector<std::array<Vec3, 2>> red_segments;  // drawn on top as thin red tubes: crossings
};

// The smallest box {low, high} around cloths and body; points that are not finite are ignored.  {0, 0} for an empty scene.
// For a film, join the boxes of its frames, so that one camera holds them all.
std::array<Vec3, 2> bounds(const PreviewScene& scene);

struct Camera {
  Vec3 eye, target;
  double vertical_fov_deg = 28;
};

// A camera that frames the given box from a direction on the horizon: 0 = front (from +z), 90 = from the left side (+x),
// 180 = back; `elevation_deg` in [-90, 90] looks down when positive.  `aspect` = width / height.  All eight corners lie within
// the middle 92 % of the picture.  Throws InputError for numbers that are not finite or an aspect that is not positive.
Camera frame_subject(const Vec3& low, const Vec3& high, double azimuth_deg, double elevation_deg, double aspect);

// `count` cameras once around the box, the first from the front, all as far away as the farthest of them has to be.  Throws as frame_subject, and
// InputError for a negative count.
std::vector<Camera> turntable(const Vec3& low, const Vec3& high, double elevation_deg, double aspect, int count);

// The projection of `point` into a picture of that size: pixels from the left and from the top, and the distance along the viewing
// direction in metres, which is <= 0 behind the eye (then x and y are meaningless).
Vec3 project(const Camera& camera, int width, int height, const Vec3& point);

struct RenderOptions {
  int width = 640, height = 800;  // [1, 16384]
  int samples = 24;               // paths per pixel, [1, 65536]; 6 to 8 are enough for films, as the light is smoothed
  double grid_m = 0.02;           // lines at every grid_m, bolder at every fifth; 0: none
  bool denoise = true;            // smooths the light where the samples are noisy, never the cloth's grid or outline
  double display_edge_m = 0.004;  // to which cloth with a look is subdivided for smooth outlines
};

// Keeps the ray tracing device and its buffers between the pictures of a film.  Each picture depends only on its own scene,
// not on the ones before.  Not to be used from two threads at a time; the work inside runs on the caller's threads
// (core/parallel.hpp).  Throws InputError for sizes or indices that do not fit together, Error (resource limit) when the ray
// tracer runs out of memory.  Triangles with corners that are not finite are left out of the picture.
class Renderer {
 public:
  explicit Renderer(const RenderOptions& options);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  Image render(const PreviewScene& scene, const Camera& camera);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// One picture; the same as Renderer(options).render(scene, camera).
Image render(const PreviewScene& scene, const Camera& camera, const RenderOptions& options);

// Front, side and back of the scene in one row; the captions are "FRONT", "SIDE", "BACK" after `title` when it is given.
// `options.width` and `.height` are those of one view.
Image turntable_sheet(const PreviewScene& scene, const RenderOptions& options, const std::string& title = "");

// Pictures side by side, row by row, each with a caption in a small built-in bitmap font (capitals, digits, punctuation;
// anything else is drawn as a box; too long a caption is cut).  Throws InputError unless all pictures are of one size and
// there is one caption per picture and 1 <= columns.
Image contact_sheet(std::span<const Image> images, std::span<const std::string> captions, int columns);

// Throws IoError, and InputError for an image whose bytes do not fit its size.  Written through a temporary name: a half-written
// picture never appears.
void write_png(const std::string& path, const Image& image);

// Writes an H.264 MP4 through the program `ffmpeg`: calls picture(i) for i in [0, count), once each, in order.  Throws IoError
// with ffmpeg's last line when it fails, and says how to install it when it is not there; InputError when the pictures differ
// in size, are smaller than 2 x 2, or fps is not positive.  An odd last row or column is cut off, as H.264 wants even sizes.
// The film appears under its name when it is complete, never before; exceptions of picture(i) pass through.
// `stop`, if there is one, is polled while ffmpeg works on its last pictures; true throws Error(interrupted).
void write_mp4(const std::string& path, int count, double fps, const std::function<Image(int)>& picture,
               const std::function<bool()>& stop = {});

}  // namespace toile::internal
