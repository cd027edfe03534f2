// preview/ray_scene.hpp: the triangles of a scene, ready to be hit by rays.
//
// Mind: coordinates are float and relative to the `origin` given to build(), so that a scene far from the world's origin keeps
// its precision.
#pragma once
#include "preview/cloth_look.hpp"
#include "preview/display_mesh.hpp"
#include "preview/preview.hpp"
#include "preview/vec3f.hpp"

#include <memory>
#include <vector>

namespace toile::internal {

struct RayMesh {
  std::vector<Vec3f> positions;               // one unused entry at the end: the ray tracer reads 16 bytes per vertex
  std::vector<std::array<Vec3f, 3>> normals;  // of each triangle's corners, weighted by area; zero where undefined
  std::span<const Triangle> triangles;
  std::span<const std::array<Vec2, 3>> uv;  // empty: none
  Vec3f right_side, wrong_side;             // linear RGB
  std::vector<std::array<Vec3f, 2>> sides;  // [triangle], instead of these two; empty: none
  bool cloth = false;
  std::vector<const ClothLook*> look;    // [simulated triangle]; empty: drawn as simulated, with a grid
  std::unique_ptr<DisplayMesh> display;  // what is drawn instead, then
  // [triangle] of a body's part that faces inwards, a room: seen from inside only, and light comes through it.  Empty: none.
  std::vector<char> room;
};

struct RayHit {
  float distance = 0;  // in units of the direction's length
  std::size_t mesh = 0, triangle = 0;
  float b1 = 0, b2 = 0;  // barycentric weights of corners 1 and 2
};

class RayScene {
 public:
  RayScene();
  ~RayScene();
  RayScene(const RayScene&) = delete;  // the ray tracer holds pointers to the meshes
  RayScene& operator=(const RayScene&) = delete;

  // Throws InputError when sizes or indices do not fit together.  Reads the scene's spans until the next build.
  void build(const PreviewScene& scene, const Vec3& origin, double display_edge_m);

  // The first triangle along the ray; the direction need not be normalised.
  bool nearest(const Vec3f& origin, const Vec3f& direction, RayHit& hit) const;
  bool occluded(const Vec3f& origin, const Vec3f& direction) const;

  const RayMesh& mesh(std::size_t i) const { return meshes_[i]; }

 private:
  struct Device;
  bool misses_box(const Vec3f& origin, const Vec3f& direction) const;

  std::unique_ptr<Device> device_;
  std::vector<RayMesh> meshes_;
  Vec3f low_ = Vec3f::Zero(), high_ = Vec3f::Zero();
  bool empty_ = true;
};

}  // namespace toile::internal
