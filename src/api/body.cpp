#include "toile/body.hpp"

#include "api/parts.hpp"
#include "body/mannequin.hpp"
#include "body/motion.hpp"

#include <algorithm>
#include <utility>

namespace toile {
namespace {

bool is_motion(const std::string& name) {
  const auto names = internal::motion_names();
  return std::find(names.begin(), names.end(), name) != names.end();
}

internal::SceneMotion motion_of(const std::string& given, double fps) {
  internal::SceneMotion motion;
  if (is_motion(given)) {
    motion.name = given;
  } else {
    motion.path = given;
    motion.fps = fps;
  }
  return motion;
}

}  // namespace

Body::Body(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Body::Body(const Body& other) : parts_(std::make_unique<Parts>(*other.parts_)) {}
Body::Body(Body&&) noexcept = default;
Body& Body::operator=(const Body& other) {
  if (this != &other) parts_ = std::make_unique<Parts>(*other.parts_);
  return *this;
}
Body& Body::operator=(Body&&) noexcept = default;
Body::~Body() = default;

Body Body::none() { return Body(std::make_unique<Parts>()); }

std::vector<std::string> Body::motion_names() {
  const auto names = internal::motion_names();
  return {names.begin(), names.end()};
}

Body Body::mannequin(std::string_view who, const std::string& motion) {
  return translated([&] {
    auto parts = std::make_unique<Parts>();
    parts->body.shape = internal::SceneMannequin{internal::mannequin_kind(who)};
    if (!motion.empty()) parts->body.motion = motion_of(motion, internal::SceneMotion{}.fps);
    return Body(std::move(parts));
  });
}

Body Body::from_file(const std::string& path, const BodyFileOptions& options) {
  return translated([&] {
    auto parts = std::make_unique<Parts>();
    internal::SceneMesh mesh;
    mesh.path = path;
    mesh.unit = static_cast<internal::LengthUnit>(options.unit);
    mesh.measurements = options.measurements;
    mesh.up = static_cast<internal::UpAxis>(options.up);
    mesh.rig = options.rig;
    mesh.weights = options.weights;
    for (const BodyTarget& target : options.targets) mesh.targets.push_back({target.file, target.share});
    parts->body.shape = std::move(mesh);
    require_above_zero("fps", options.fps);
    if (!options.motion.empty()) {
      internal::SceneMotion motion = motion_of(options.motion, options.fps);
      motion.clip = options.clip;
      motion.bones = options.bones;
      parts->body.motion = std::move(motion);
    }
    return Body(std::move(parts));
  });
}

Body Body::from_arrays(std::span<const Point> vertices_m, std::span<const Face> faces) {
  return from_frames(vertices_m, vertices_m.size(), faces, internal::SceneArrays::Frames{}.fps);
}

Body Body::from_frames(std::span<const Point> frames_m, std::size_t vertices, std::span<const Face> faces, double fps) {
  return translated([&] {
    if (vertices == 0 || frames_m.empty() || frames_m.size() % vertices != 0)
      throw internal::InputError("", "frames_m", "whole frames of " + std::to_string(vertices) + " vertices",
                                 std::to_string(frames_m.size()) + " points");
    require_above_zero("fps", fps);
    auto arrays = std::make_shared<internal::SceneArrays::Frames>();
    arrays->x = engine_vectors(frames_m);
    arrays->vertices = vertices;
    arrays->triangles.assign(faces.begin(), faces.end());
    arrays->fps = fps;
    auto parts = std::make_unique<Parts>();
    parts->body.shape = internal::SceneArrays{std::move(arrays)};
    return Body(std::move(parts));
  });
}

Body Body::cylinder(const CylinderOptions& options) {
  return translated([&] {
    require_above_zero("radius_m", options.radius_m);
    require_above_zero("height_m", options.height_m);
    require_finite("top_m", options.top_m);
    auto parts = std::make_unique<Parts>();
    parts->body.shape = internal::SceneCylinder{options.radius_m, options.height_m, engine_vector(options.top_m)};
    return Body(std::move(parts));
  });
}

Body Body::sphere(double radius_m, double edge_m) {
  return translated([&] {
    require_above_zero("radius_m", radius_m);
    require_above_zero("edge_m", edge_m);
    auto parts = std::make_unique<Parts>();
    parts->body.shape = internal::SceneSphere{radius_m};
    parts->body.edge_m = edge_m;
    return Body(std::move(parts));
  });
}

Body Body::box(const Point& size_m) {
  return translated([&] {
    for (const double side : size_m) require_above_zero("size_m", side);
    auto parts = std::make_unique<Parts>();
    parts->body.shape = internal::SceneBox{engine_vector(size_m)};
    return Body(std::move(parts));
  });
}

Body Body::capsule(double radius_m, const Point& from_m, const Point& to_m, double edge_m) {
  return translated([&] {
    require_above_zero("radius_m", radius_m);
    require_finite("from_m", from_m);
    require_finite("to_m", to_m);
    require_above_zero("edge_m", edge_m);
    auto parts = std::make_unique<Parts>();
    parts->body.shape = internal::SceneCapsule{radius_m, engine_vector(from_m), engine_vector(to_m)};
    parts->body.edge_m = edge_m;
    return Body(std::move(parts));
  });
}

Body Body::revolved(std::span<const std::array<double, 2>> profile_m, double edge_m) {
  return translated([&] {
    require_above_zero("edge_m", edge_m);
    internal::SceneRevolved shape;
    for (const auto& [distance, height] : profile_m) {
      require_finite("profile_m", {distance, height, 0});
      shape.profile_m.emplace_back(distance, height);
    }
    auto parts = std::make_unique<Parts>();
    parts->body.shape = std::move(shape);
    parts->body.edge_m = edge_m;
    return Body(std::move(parts));
  });
}

Body& Body::set_friction(double friction) {
  translated([&] { require_at_least_zero("friction", friction); });
  parts_->body.contact.friction = friction;
  return *this;
}

Body& Body::set_offset(double offset_m) {
  translated([&] { require_at_least_zero("offset_m", offset_m); });
  parts_->body.contact.offset_m = offset_m;
  return *this;
}

Body& Body::place(const Point& translation_m, const Point& rotation_deg) {
  translated([&] {
    require_finite("translation_m", translation_m);
    require_finite("rotation_deg", rotation_deg);
  });
  parts_->body.translation_m = engine_vector(translation_m);
  parts_->body.rotation_deg = engine_vector(rotation_deg);
  parts_->body.moves.centre() = parts_->body.translation_m;
  return *this;
}

Body& Body::set_moves(std::span<const BodyKey> keys) {
  translated([&] {
    std::vector<internal::RigidKey> path;
    for (const BodyKey& key : keys) {
      require_at_least_zero("t_s", key.t_s);
      require_finite("shift_m", key.shift_m);
      require_finite("rotation_deg", key.rotation_deg);
      require_above_zero("scale", key.scale);
      if (!path.empty() && key.t_s <= path.back().t_s)
        throw internal::InputError("", "t_s", "times that ascend", std::to_string(key.t_s));
      path.push_back({key.t_s, engine_vector(key.shift_m), engine_vector(key.rotation_deg), key.scale});
    }
    parts_->body.moves = internal::RigidPath(std::move(path), parts_->body.translation_m);
  });
  return *this;
}

Body& Body::set_inside_out(bool inside_out) {
  parts_->body.inside_out = inside_out;
  return *this;
}

}  // namespace toile
