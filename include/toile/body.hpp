// toile/body.hpp: what cloth collides with: a person, or another closed surface, that may move.
//
// Of a simulation one body is worn: garments are dressed on it.  All others are solids: they stand, or move, beside it.
#pragma once
#include "toile/export.hpp"
#include "toile/types.hpp"

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace toile {

struct BodyFileOptions {
  LengthUnit unit = LengthUnit::automatic;
  std::string motion =
      {};  // a .pc2, a folder of OBJ or PLY files, or the name of a motion for upright meshes; empty: it stands
  double fps = 30;                // of the files of the motion
  std::string measurements = {};  // a YAML file; empty: the one beside the mesh, if there is one
};
struct CylinderOptions {  // upright, with rounded rims
  double radius_m = 0.2, height_m = 0.5;
  Point top_m{0, 0, 0};  // the middle of its top
};

// Where a solid has gone since it began to move: shifted, turned (R = Rz Ry Rx) and scaled about its own place.  Every number goes straight from
// one key to the next.
struct BodyKey {
  double t_s = 0;
  Point shift_m{0, 0, 0}, rotation_deg{0, 0, 0};
  double scale = 1;
};

// A value: a copy is independent.
class TOILE_EXPORT Body {
 public:
  static Body none();
  // "woman", "man" or "dancer"; `motion` is one of motion_names(), or a file as above; empty: it stands.
  static Body mannequin(std::string_view who, const std::string& motion = {});
  static std::vector<std::string> motion_names();
  // A closed mesh (OBJ, PLY, glTF).  Of one that is worn the person is taken, of a solid everything.
  static Body from_file(const std::string& path, const BodyFileOptions& options = {});
  // A closed mesh in metres, counter-clockwise from outside.  It stands, or goes where Simulation::set_collider says.  Copies.
  static Body from_arrays(std::span<const Point> vertices_m, std::span<const Face> faces);
  // The same in motion: `frames_m` holds one set of `vertices` points after the other, `fps` of them in a second; the first is how it stands.
  static Body from_frames(std::span<const Point> frames_m, std::size_t vertices, std::span<const Face> faces,
                          double fps);
  static Body cylinder(const CylinderOptions& options = {});
  // Around the origin; edges of its triangles are at most edge_m long.
  static Body sphere(double radius_m, double edge_m = 0.02);
  static Body box(const Point& size_m);
  // A rod with round ends, whose middles these are.
  static Body capsule(double radius_m, const Point& from_m, const Point& to_m, double edge_m = 0.02);
  // What an outline of points (distance from the y axis, height) sweeps: from the axis to the axis, or a closed curve beside it.
  static Body revolved(std::span<const std::array<double, 2>> profile_m, double edge_m = 0.02);

  Body(const Body&);
  Body(Body&&) noexcept;
  Body& operator=(const Body&);
  Body& operator=(Body&&) noexcept;
  ~Body();

  // Of cloth on it.  Otherwise, of a solid, that of the body that is worn; of that one, or without one, the fabric's.
  Body& set_friction(double friction);
  // How far above it cloth rests.  Otherwise, of a solid, that of the body that is worn; of that one by the length of the cloth's edges.
  Body& set_offset(double offset_m);
  // Of solids.  Where it stands: turned first, then shifted.
  Body& place(const Point& translation_m, const Point& rotation_deg = {0, 0, 0});
  Body& set_moves(std::span<const BodyKey> keys);  // times ascend; from the first advance() on
  Body& set_inside_out(bool inside_out = true);    // a room

  struct TOILE_HIDDEN Parts;
  const Parts& parts() const { return *parts_; }  // for the library itself

 private:
  explicit Body(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace toile
