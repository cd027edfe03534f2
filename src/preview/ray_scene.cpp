// preview/ray_scene.cpp: ray queries through Embree, which no other file knows (embree.hpp: its versions).
//
// Mind: the tree is built on one thread.  Built on several, the order of triangles in a leaf may differ from run to run, and
// with it the answer for a ray through an edge that two triangles share.
#include "preview/ray_scene.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "mesh/surface_parts.hpp"
#include "preview/display_mesh.hpp"
#include "preview/embree.hpp"

#include <cmath>
#include <limits>
#include <string>

namespace toile::internal {
namespace {

// Neutral clay.
const Vec3f body_colour(0.50f, 0.465f, 0.435f);

constexpr float crease_cosine = 0.7f;  // 46 degrees

// The wrong side of a fabric: paler in hue and darker, never black.
Vec3f wrong_side_of(const Vec3f& colour) {
  return 0.62f * mix(colour, Vec3f::Constant(luminance(colour)), 0.45f) + Vec3f::Constant(0.015f);
}

Vec3f unit_or_zero(const Vec3f& n) {
  const float length = n.norm();
  return length > 0 && std::isfinite(length) ? Vec3f(n / length) : Vec3f(Vec3f::Zero());
}

// Smooth over the faces around a vertex that do not lean by more than an angle: the corner of a box is no part of a ball, nor a pressed fold of a
// bend, where the mean of both sides may point anywhere.
std::vector<std::array<Vec3f, 3>> corner_normals(const std::vector<Vec3f>& positions,
                                                 std::span<const Triangle> triangles, float least_cosine) {
  std::vector<Vec3f> twice_area(triangles.size(), Vec3f::Zero());
  std::vector<std::vector<std::size_t>> around(positions.size());
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    const auto corner = [&](std::size_t c) { return positions[static_cast<std::size_t>(triangles[k][c])]; };
    const Vec3f n = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    if (!n.allFinite()) continue;
    twice_area[k] = n;
    for (const Index i : triangles[k]) around[static_cast<std::size_t>(i)].push_back(k);
  }
  std::vector<std::array<Vec3f, 3>> normals(triangles.size(), {Vec3f::Zero(), Vec3f::Zero(), Vec3f::Zero()});
  parallel_for(triangles.size(), 256, [&](std::size_t k) {
    const Vec3f own = unit_or_zero(twice_area[k]);
    for (std::size_t c = 0; c < 3; ++c) {
      Vec3f& sum = normals[k][c];
      for (const std::size_t other : around[static_cast<std::size_t>(triangles[k][c])]) {
        if (twice_area[other].dot(own) >= least_cosine * twice_area[other].norm()) sum += twice_area[other];
      }
      sum = unit_or_zero(sum);
    }
  });
  return normals;
}

// Empty when there is none.
std::vector<char> rooms_of(std::span<const Triangle> triangles, std::span<const Vec3> positions) {
  const SurfaceParts found = surface_parts(triangles, positions);
  std::vector<char> room(triangles.size(), 0);
  bool any = false;
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    const SurfacePart& part = found.parts[static_cast<std::size_t>(found.of[k])];
    room[k] = part.closed && part.volume_m3 < 0;
    any = any || room[k] != 0;
  }
  if (!any) room.clear();
  return room;
}

// A ray meets a room's wall from inside only.
void meet_rooms_from_inside(const RTCFilterFunctionNArguments* arguments) {
  const auto& mesh = *static_cast<const RayMesh*>(arguments->geometryUserPtr);
  const auto k = static_cast<std::size_t>(RTCHitN_primID(arguments->hit, arguments->N, 0));
  if (mesh.room[k] == 0) return;
  const auto corner = [&](std::size_t c) { return mesh.positions[static_cast<std::size_t>(mesh.triangles[k][c])]; };
  const Vec3f direction(RTCRayN_dir_x(arguments->ray, arguments->N, 0), RTCRayN_dir_y(arguments->ray, arguments->N, 0),
                        RTCRayN_dir_z(arguments->ray, arguments->N, 0));
  if ((corner(1) - corner(0)).cross(corner(2) - corner(0)).dot(direction) >= 0) arguments->valid[0] = 0;
}

// Nor does it cast a shadow.
void let_light_into_rooms(const RTCFilterFunctionNArguments* arguments) {
  const auto& mesh = *static_cast<const RayMesh*>(arguments->geometryUserPtr);
  if (mesh.room[static_cast<std::size_t>(RTCHitN_primID(arguments->hit, arguments->N, 0))] != 0)
    arguments->valid[0] = 0;
}

void check_corners(const std::string& place, std::span<const Triangle> triangles, std::size_t positions) {
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (const Index v : triangles[i]) {
      if (v < 0 || static_cast<std::size_t>(v) >= positions) {
        throw InputError("", place + ": triangle " + std::to_string(i),
                         "corners in 0.." + std::to_string(static_cast<std::ptrdiff_t>(positions) - 1),
                         std::to_string(v));
      }
    }
  }
}

RayMesh ray_mesh(const std::string& place, std::span<const Triangle> triangles, std::span<const Vec3> positions,
                 const Vec3& origin, bool cloth) {
  RayMesh mesh;
  mesh.cloth = cloth;
  check_corners(place, triangles, positions.size());
  mesh.positions.reserve(positions.size() + 1);
  for (const Vec3& p : positions) mesh.positions.push_back((p - origin).cast<float>());
  mesh.positions.push_back(Vec3f::Zero());
  mesh.triangles = triangles;
  mesh.normals = corner_normals(mesh.positions, triangles, cloth ? static_cast<float>(pressed_cosine) : crease_cosine);
  if (!cloth) mesh.room = rooms_of(triangles, positions);
  return mesh;
}

void check_looks(const std::string& place, const PreviewCloth& cloth) {
  if (cloth.look.size() != cloth.triangles.size())
    throw InputError("", place, "a look for each of " + std::to_string(cloth.triangles.size()) + " triangles",
                     std::to_string(cloth.look.size()));
  for (const Index k : cloth.look)
    if (k < 0 || static_cast<std::size_t>(k) >= cloth.looks.size())
      throw InputError("", place, "looks below " + std::to_string(cloth.looks.size()), std::to_string(k));
}

RayMesh studio_mesh(const std::string& place, const PreviewCloth& cloth, const Vec3& origin, double display_edge_m) {
  check_looks(place, cloth);
  check_corners(place, cloth.triangles, cloth.positions.size());
  std::vector<const ClothLook*> look;
  for (const Index k : cloth.look) look.push_back(&cloth.looks[static_cast<std::size_t>(k)]);
  auto display = std::make_unique<DisplayMesh>(display_mesh(cloth, look, display_edge_m));
  RayMesh mesh = ray_mesh(place, display->triangles, display->positions, origin, true);
  mesh.uv = display->uv;
  mesh.look = std::move(look);
  mesh.display = std::move(display);
  return mesh;
}

}  // namespace

struct RayScene::Device {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  Device() : device(rtcNewDevice(nullptr)) {
    if (device) return;
    const RTCError error = rtcGetDeviceError(nullptr);
    if (error == RTC_ERROR_UNSUPPORTED_CPU)
      throw Error(ErrorKind::internal, "preview: the ray tracer (Embree) cannot start on this processor");
    throw Error(ErrorKind::resource_limit,
                "preview: not enough memory or threads for the ray tracer (Embree) to start: error " +
                    std::to_string(static_cast<int>(error)));
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  ~Device() {
    release();
    rtcReleaseDevice(device);
  }
  void release() {
    if (scene) rtcReleaseScene(scene);
    scene = nullptr;
  }
  void check() const {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_NONE) return;
    if (error == RTC_ERROR_OUT_OF_MEMORY) {
      throw Error(ErrorKind::resource_limit, "preview: not enough memory for the ray tracer");
    }
    throw Error(ErrorKind::internal, "preview: ray tracer error " + std::to_string(static_cast<int>(error)));
  }
};

bool can_draw() { return true; }
void require_pictures() {}

RayScene::RayScene() : device_(std::make_unique<Device>()) {}
RayScene::~RayScene() = default;

void RayScene::build(const PreviewScene& scene, const Vec3& origin, double display_edge_m) {
  device_->release();
  meshes_.clear();
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const PreviewCloth& cloth = scene.cloths[c];
    const std::string place = "preview: cloth " + std::to_string(c);
    if (!cloth.uv.empty() && cloth.uv.size() != cloth.triangles.size()) {
      throw InputError("", place, "uv for each of " + std::to_string(cloth.triangles.size()) + " triangles or for none",
                       std::to_string(cloth.uv.size()));
    }
    if (!cloth.colours.empty() && cloth.colours.size() != cloth.triangles.size()) {
      throw InputError("", place,
                       "a colour for each of " + std::to_string(cloth.triangles.size()) + " triangles or for none",
                       std::to_string(cloth.colours.size()));
    }
    if (cloth.looks.empty() || cloth.uv.empty()) {
      RayMesh mesh = ray_mesh(place, cloth.triangles, cloth.positions, origin, true);
      mesh.uv = cloth.uv;
      mesh.right_side = cloth.colour.cast<float>().cwiseMax(0.0f).cwiseMin(1.0f);
      mesh.wrong_side = wrong_side_of(mesh.right_side);
      for (const Vec3& colour : cloth.colours) {
        const Vec3f right_side = colour.cast<float>().cwiseMax(0.0f).cwiseMin(1.0f);
        mesh.sides.push_back({right_side, wrong_side_of(right_side)});
      }
      meshes_.push_back(std::move(mesh));
    } else {
      meshes_.push_back(studio_mesh(place, cloth, origin, display_edge_m));
    }
  }
  meshes_.push_back(ray_mesh("preview: body", scene.body_triangles, scene.body_positions, origin, false));
  meshes_.back().right_side = meshes_.back().wrong_side = body_colour;

  device_->scene = rtcNewScene(device_->device);
  // Robust: no ray slips through an edge between two triangles.
  rtcSetSceneFlags(device_->scene, RTC_SCENE_FLAG_ROBUST);
  for (std::size_t i = 0; i < meshes_.size(); ++i) {
    const RayMesh& mesh = meshes_[i];
    if (mesh.triangles.empty()) continue;
    RTCGeometry geometry = rtcNewGeometry(device_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions.data(), 0,
                               sizeof(Vec3f), mesh.positions.size() - 1);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                               sizeof(Triangle), mesh.triangles.size());
    if (!mesh.room.empty()) {
      rtcSetGeometryUserData(geometry, const_cast<RayMesh*>(&mesh));  // read only
      rtcSetGeometryIntersectFilterFunction(geometry, meet_rooms_from_inside);
      rtcSetGeometryOccludedFilterFunction(geometry, let_light_into_rooms);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(device_->scene, geometry, static_cast<unsigned>(i));
    rtcReleaseGeometry(geometry);
  }
  device_->check();
  with_threads(1, [&] { rtcCommitScene(device_->scene); });
  device_->check();

  RTCBounds box;
  rtcGetSceneBounds(device_->scene, &box);
  low_ = Vec3f(box.lower_x, box.lower_y, box.lower_z);
  high_ = Vec3f(box.upper_x, box.upper_y, box.upper_z);
  empty_ = !(low_.array() <= high_.array()).all();
}

// Most rays of a picture miss the subject; a box test of our own saves the call.
bool RayScene::misses_box(const Vec3f& origin, const Vec3f& direction) const {
  if (empty_) return true;
  float near = 0, far = std::numeric_limits<float>::infinity();
  for (int k = 0; k < 3; ++k) {
    // 0 * inf is not a number where a ray lies in a face of the box; the comparisons below then keep the ray.
    const float inverse = 1.0f / direction[k];
    const float a = (low_[k] - origin[k]) * inverse, b = (high_[k] - origin[k]) * inverse;
    const float enter = a < b ? a : b, leave = a < b ? b : a;
    if (enter > near) near = enter;
    if (leave < far) far = leave;
  }
  return near > far * 1.00001f + 1e-6f;
}

bool RayScene::nearest(const Vec3f& origin, const Vec3f& direction, RayHit& hit) const {
  if (misses_box(origin, direction)) return false;
  RTCRayHit ray;
  ray.ray = {origin.x(),
             origin.y(),
             origin.z(),
             0.0f,
             direction.x(),
             direction.y(),
             direction.z(),
             0.0f,
             std::numeric_limits<float>::infinity(),
             0xffffffffu,
             0,
             0};
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  intersect(device_->scene, ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  hit = {ray.ray.tfar, ray.hit.geomID, ray.hit.primID, ray.hit.u, ray.hit.v};
  return true;
}

bool RayScene::occluded(const Vec3f& origin, const Vec3f& direction) const {
  if (misses_box(origin, direction)) return false;
  RTCRay ray{origin.x(),
             origin.y(),
             origin.z(),
             0.0f,
             direction.x(),
             direction.y(),
             direction.z(),
             0.0f,
             std::numeric_limits<float>::infinity(),
             0xffffffffu,
             0,
             0};
  occlude(device_->scene, ray);
  return ray.tfar < 0;
}

}  // namespace toile::internal
