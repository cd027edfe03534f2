// preview/no_pictures.cpp: replaces ray_scene.cpp and png.cpp in builds without Embree and libpng.  Every request for a picture throws
// an error with the reason.
#include "core/error.hpp"
#include "preview/png.hpp"
#include "preview/ray_scene.hpp"

namespace toile::internal {

bool can_draw() { return false; }

void require_pictures() {
  throw Error(ErrorKind::usage,
              "built without pictures: Embree 3 or 4 and libpng were not there, or TOILE_PREVIEW was OFF, when this "
              "Toile was built");
}

std::string png_of(const Image&, const std::string&) {
  require_pictures();
  return {};
}
RgbaImage parse_png(std::string_view, const std::string&) {
  require_pictures();
  return {};
}
void write_png(const std::string&, const Image&) { require_pictures(); }

struct RayScene::Device {};

// No RayScene can be made, so its other functions are unreachable.
RayScene::RayScene() { require_pictures(); }
RayScene::~RayScene() = default;
void RayScene::build(const PreviewScene&, const Vec3&, double) { require_pictures(); }
bool RayScene::nearest(const Vec3f&, const Vec3f&, RayHit&) const {
  require_pictures();
  return false;
}
bool RayScene::occluded(const Vec3f&, const Vec3f&) const {
  require_pictures();
  return false;
}

}  // namespace toile::internal
