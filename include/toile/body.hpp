// toile/body.hpp: what cloth collides with: a person, or another closed surface, that may move.
#pragma once
#include "toile/export.hpp"
#include "toile/types.hpp"

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

// A value: a copy is independent.
class TOILE_EXPORT Body {
 public:
  static Body none();
  // "woman", "man" or "dancer"; `motion` is one of motion_names(), or a file as above; empty: it stands.
  static Body mannequin(std::string_view who, const std::string& motion = {});
  static std::vector<std::string> motion_names();
  // A closed mesh (OBJ, PLY, glTF).
  static Body from_file(const std::string& path, const BodyFileOptions& options = {});
  // A closed mesh in metres, counter-clockwise from outside.  It stands, or goes where Simulation::set_body says.  Copies.
  static Body from_arrays(std::span<const Point> vertices_m, std::span<const Face> faces);
  // The same in motion: `frames_m` holds one set of `vertices` points after the other, `fps` of them in a second; the first is how it stands.
  static Body from_frames(std::span<const Point> frames_m, std::size_t vertices, std::span<const Face> faces,
                          double fps);
  static Body cylinder(const CylinderOptions& options = {});

  Body(const Body&);
  Body(Body&&) noexcept;
  Body& operator=(const Body&);
  Body& operator=(Body&&) noexcept;
  ~Body();

  Body& set_friction(double friction);  // otherwise the fabric's
  Body& set_offset(double offset_m);    // how far above it cloth rests; otherwise by the length of the cloth's edges

  struct TOILE_HIDDEN Parts;
  const Parts& parts() const { return *parts_; }  // for the library itself

 private:
  explicit Body(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace toile
