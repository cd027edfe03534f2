// toile/body.hpp: colliders: a person, or another closed surface, that may move.
//
// Garments are dressed on one body of a simulation, the worn body.  All others are solids: they stand, or move, beside it.
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

// A change of a mesh's shape, MakeHuman's: a file, and how much of it.
struct BodyTarget {
  std::string file;
  double share = 1;
};
struct BodyFileOptions {
  LengthUnit unit = LengthUnit::automatic;
  std::string motion =
      {};  // a .pc2, a .mdd, a folder of numbered mesh files, or the name of a motion for upright meshes; of a body with a skeleton a
           // glTF or a BVH file; empty: it stands
  double fps = 30;                // of the files of the motion
  std::string measurements = {};  // a YAML file; empty: the one beside the mesh, if there is one
  UpAxis up = UpAxis::automatic;  // of the mesh; of a solid, automatic is y
  std::string clip = {};  // of a glTF motion: the name of an animation, or its number from 0; empty: the only one
  std::string bones =
      {};  // of a BVH motion: a JSON file that says which joints are which part of a person; empty: by their names
  std::string rig = {},
              weights = {};  // of a mesh without a skeleton: a rig of MakeHuman's; weights empty: those beside it
  std::vector<BodyTarget> targets = {};  // applied before anything else
};
struct CylinderOptions {  // upright, with rounded rims
  double radius_m = 0.2, height_m = 0.5;
  Point top_m{0, 0, 0};  // the middle of its top
};

// A key of a solid's motion: its shift, rotation (R = Rz Ry Rx) and scale relative to its own place.  All are interpolated linearly between
// keys.
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
  // A closed mesh (OBJ, PLY, STL, glTF).  For the worn body only the person in the file is used, for a solid everything, open sheets too.
  static Body from_file(const std::string& path, const BodyFileOptions& options = {});
  // A closed mesh in metres, counter-clockwise from outside.  It stands, or goes where Simulation::set_collider says.  Copies.
  static Body from_arrays(std::span<const Point> vertices_m, std::span<const Face> faces);
  // The same in motion: `frames_m` holds the frames one after the other, `vertices` points each, `fps` of them in a second; it starts at the first.
  static Body from_frames(std::span<const Point> frames_m, std::size_t vertices, std::span<const Face> faces,
                          double fps);
  static Body cylinder(const CylinderOptions& options = {});
  // Around the origin; edges of its triangles are at most edge_m long.
  static Body sphere(double radius_m, double edge_m = 0.02);
  static Body box(const Point& size_m);
  // A rod with round ends, centred at from_m and to_m.
  static Body capsule(double radius_m, const Point& from_m, const Point& to_m, double edge_m = 0.02);
  // A surface of revolution about y.  Its profile, points (distance from the axis, height), runs from the axis to the axis, or is closed.
  static Body revolved(std::span<const std::array<double, 2>> profile_m, double edge_m = 0.02);

  Body(const Body&);
  Body(Body&&) noexcept;
  Body& operator=(const Body&);
  Body& operator=(Body&&) noexcept;
  ~Body();

  // Friction of cloth on it.  Default: for a solid, the worn body's; for the worn body, or where there is none, the fabric's.
  Body& set_friction(double friction);
  // The distance at which cloth rests on it.  Default: for a solid, the worn body's; for the worn body it follows from the edge length of the cloth.
  Body& set_offset(double offset_m);
  // Solids only.  Where it stands: rotated first, then shifted.
  Body& place(const Point& translation_m, const Point& rotation_deg = {0, 0, 0});
  Body& set_moves(std::span<const BodyKey> keys);  // in ascending order of time; t = 0 is the first advance()
  Body& set_inside_out(bool inside_out = true);    // a room

  struct TOILE_HIDDEN Parts;
  const Parts& parts() const { return *parts_; }  // for the library itself

 private:
  explicit Body(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace toile
