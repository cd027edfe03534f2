// tests/generated/scene_parts.hpp: what the parts of a generated scene have in common: its features, where its cloth is, how long it runs.
#pragma once
#include "generated/draw.hpp"
#include "generated/json_words.hpp"
#include "generated/scene_space.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace toile::internal::generated {

struct Place {
  double x, y, z;
  std::string text() const { return vector(x, y, z); }
  Place operator+(const Place& b) const { return {x + b.x, y + b.y, z + b.z}; }
};

struct Variant {
  bool earlier = false;    // the run that another one starts from
  bool far_solid = false;  // besides what there is
  bool far_moves = false;
  bool defaults = false;  // written out
};

class SceneParts {
 public:
  SceneParts(const Choice& choice, const Draw& draw, const Variant& variant);

  bool is(std::string_view axis, std::string_view value) const { return scene_space().name_of(choice_, axis) == value; }
  bool is_sewn() const { return is("cloth", "pattern") || is("cloth", "two patterns"); }
  bool is_person() const { return is("body", "mannequin"); }
  bool has_mesh_body() const { return is("body", "mesh") || is("body", "mesh in cm"); }
  bool moves() const { return !is("motion", "none") || !is("solid moves", "no"); }
  double solid_mesh_scale() const { return is("solid place", "room") ? 16 : draw_.between("solid size", 0.15, 0.3); }

 protected:
  std::string name_of(std::string_view axis) const { return std::string(scene_space().name_of(choice_, axis)); }

  const Choice& choice_;
  const Draw& draw_;
  Variant variant_;
  double fps_ = 30, seconds_ = 0;
  Place centre_{0, 0, 0};  // of the cloth

 private:
  Place place_of_cloth() const;
};

// The values of the keys "cloth", and "body" (empty: none) and "solids".
class ClothPart : public SceneParts {
 public:
  using SceneParts::SceneParts;
  std::string cloths() const;

 private:
  std::string fabric() const;
  std::string ribbon(bool closed) const;
  void set_shape(Object& cloth) const;
  void place(Object& cloth) const;
  void set_panels(Object& cloth, const std::string& panel) const;
  std::string turning_moves() const;
  void set_pins(Object& cloth) const;
  void set_drags(Object& cloth) const;
};

class BodyPart : public SceneParts {
 public:
  using SceneParts::SceneParts;
  Object body() const;
  std::vector<std::string> solids() const;

 private:
  Object solid_of(std::string_view kind) const;
  void set_moves(Object& solid) const;
};

// Those of "world", "time", "solver" and "contact", which may be empty.
class NumberPart : public SceneParts {
 public:
  using SceneParts::SceneParts;
  Object world() const;
  Object time() const;
  Object solver() const;
  Object contact() const;

 private:
  std::string other_fabric() const;
};

}  // namespace toile::internal::generated
