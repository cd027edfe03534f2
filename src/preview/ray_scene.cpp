// preview/ray_scene.cpp: ray queries through Embree, the only file that knows it.
//
// Mind: the tree is built on one thread.  Built on several, the order of triangles in a leaf may differ from run to run, and
// with it the answer for a ray through an edge that two triangles share.
#include "preview/ray_scene.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"

#include <embree3/rtcore.h>

#include <limits>
#include <string>

namespace toile {
namespace {

// Neutral clay.
const Vec3f body_colour(0.50f, 0.465f, 0.435f);

// The wrong side of a fabric: paler in hue and darker, never black.
Vec3f wrong_side_of(const Vec3f& colour) {
  return 0.62f * mix(colour, Vec3f::Constant(luminance(colour)), 0.45f) + Vec3f::Constant(0.015f);
}

std::vector<Vec3f> vertex_normals(const std::vector<Vec3f>& positions, std::span<const Triangle> triangles) {
  std::vector<Vec3f> normals(positions.size(), Vec3f::Zero());
  for (const Triangle& t : triangles) {
    const Vec3f& a = positions[static_cast<std::size_t>(t[0])];
    const Vec3f& b = positions[static_cast<std::size_t>(t[1])];
    const Vec3f& c = positions[static_cast<std::size_t>(t[2])];
    const Vec3f twice_area = (b - a).cross(c - a);
    if (!twice_area.allFinite()) continue;
    for (const Index i : t) normals[static_cast<std::size_t>(i)] += twice_area;
  }
  for (Vec3f& n : normals) {
    const float length = n.norm();
    n = length > 0 && std::isfinite(length) ? Vec3f(n / length) : Vec3f(Vec3f::Zero());
  }
  return normals;
}

RayMesh ray_mesh(const std::string& place, std::span<const Triangle> triangles, std::span<const Vec3> positions,
                 const Vec3& origin) {
  RayMesh mesh;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (const Index v : triangles[i]) {
      if (v < 0 || static_cast<std::size_t>(v) >= positions.size()) {
        throw InputError("", place + ": triangle " + std::to_string(i),
                         "corners in 0.." + std::to_string(static_cast<std::ptrdiff_t>(positions.size()) - 1),
                         std::to_string(v));
      }
    }
  }
  mesh.positions.reserve(positions.size() + 1);
  for (const Vec3& p : positions) mesh.positions.push_back((p - origin).cast<float>());
  mesh.positions.push_back(Vec3f::Zero());
  mesh.triangles = triangles;
  mesh.normals = vertex_normals(mesh.positions, triangles);
  return mesh;
}

}  // namespace

struct RayScene::Device {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  Device() : device(rtcNewDevice(nullptr)) {
    if (!device) throw Error(ExitCode::internal, "preview: the ray tracer (Embree) cannot start");
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
      throw Error(ExitCode::resource_limit, "preview: not enough memory for the ray tracer");
    }
    throw Error(ExitCode::internal, "preview: ray tracer error " + std::to_string(static_cast<int>(error)));
  }
};

RayScene::RayScene() : device_(std::make_unique<Device>()) {}
RayScene::~RayScene() = default;

void RayScene::build(const PreviewScene& scene, const Vec3& origin) {
  device_->release();
  meshes_.clear();
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const PreviewCloth& cloth = scene.cloths[c];
    const std::string place = "preview: cloth " + std::to_string(c);
    if (!cloth.uv.empty() && cloth.uv.size() != cloth.triangles.size()) {
      throw InputError("", place, "uv for each of " + std::to_string(cloth.triangles.size()) + " triangles or for none",
                       std::to_string(cloth.uv.size()));
    }
    RayMesh mesh = ray_mesh(place, cloth.triangles, cloth.positions, origin);
    mesh.uv = cloth.uv;
    mesh.right_side = cloth.colour.cast<float>().cwiseMax(0.0f).cwiseMin(1.0f);
    mesh.wrong_side = wrong_side_of(mesh.right_side);
    mesh.cloth = true;
    meshes_.push_back(std::move(mesh));
  }
  meshes_.push_back(ray_mesh("preview: body", scene.body_triangles, scene.body_positions, origin));
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

// Most rays of a picture leave the subject; a box test of our own spares them the call.
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
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
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
  rtcIntersect1(device_->scene, &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  hit = {ray.ray.tfar, ray.hit.geomID, ray.hit.primID, ray.hit.u, ray.hit.v};
  return true;
}

bool RayScene::occluded(const Vec3f& origin, const Vec3f& direction) const {
  if (misses_box(origin, direction)) return false;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
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
  rtcOccluded1(device_->scene, &context, &ray);
  return ray.tfar < 0;
}

}  // namespace toile
