// toile/cloth.hpp: a garment or a piece of cloth, before the simulation.
#pragma once
#include "toile/export.hpp"
#include "toile/fabric.hpp"
#include "toile/types.hpp"

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace toile {

struct PatternOptions {
  double edge_m = 0.01;  // of its triangles
  // Widths, where the file says nothing: of a hem on open edges, of a tape on those with a label (waists, collars, armholes), and of the allowances on
  // sewn edges; 0: none.
  double hem_m = 0, tape_m = 0.01, allowance_m = 0;
  bool topstitched = false;  // these allowances are stitched down; needs an allowance_m
};
struct GridOptions {
  double width_m = 1, height_m = 1, edge_m = 0.02;
};

// Where the rest shape of a mesh comes from: its texture coordinates (vt), or its positions at the start.
enum class RestShape { automatic, drawing, start };  // automatic: the drawing, if it is in metres

struct MeshFileOptions {
  LengthUnit unit = LengthUnit::m;
  RestShape rest_shape = RestShape::automatic;
};

// Cloth from arrays, of n vertices and f faces.
struct ClothArrays {
  std::span<const Point> vertices_m = {};  // [n] where it starts
  std::span<const Face> faces = {};        // [f]
  // [f] The rest shape.  Empty: the shape at the start, with the warp as upright as each face allows.
  std::span<const CornerUvs> uv_m = {};
  std::span<const std::int32_t> panel = {};       // [f] a number below panel_names.size(); empty: one panel
  std::span<const std::string> panel_names = {};  // empty: the cloth's name
};

// A value: a copy is independent.
class TOILE_EXPORT Cloth {
 public:
  // The panels of a sewing pattern (GarmentCode's JSON), which Simulation::dress sews around the body.
  static Cloth from_pattern(const std::string& path, const PatternOptions& options = {});
  // A garment that is a mesh already (OBJ, PLY, STL, glTF): worn where it lies, not sewn.  Its groups are its panels; vertices that the file had to
  // split along a texture seam are one particle.  Repairs of the
  // file are in Simulation::warnings.
  static Cloth from_file(const std::string& path, const MeshFileOptions& options = {});
  // Upright in the plane z = 0, facing +z, centred at the origin.
  static Cloth grid(const GridOptions& options = {});
  // Copies.  Throws InputError for faces that are out of range, degenerate, or not a surface, and for numbers that are not finite.
  static Cloth from_arrays(const ClothArrays& arrays);

  Cloth(const Cloth&);
  Cloth(Cloth&&) noexcept;
  Cloth& operator=(const Cloth&);
  Cloth& operator=(Cloth&&) noexcept;
  ~Cloth();

  // Each of these returns the cloth, so that calls can be chained.
  Cloth& set_name(std::string_view name);
  Cloth& set_fabric(const Fabric& fabric);  // of all panels without one of their own
  Cloth& set_panel_fabric(std::string_view panel, const Fabric& fabric);
  // b_u, b_v of warp and weft, factors on the panel's rest length: below 1 it is elastic.
  Cloth& set_panel_rest_stretch(std::string_view panel, double u, double v);
  // A pressure towards its right side, outwards where the cloth is worn or closed: balloons, cushions.  It acts once all garments are on; after a
  // sewing it is ramped up with gravity, in half a second.
  Cloth& set_panel_pressure(std::string_view panel, double Pa);
  // x -> R x + t with R = Rz Ry Rx, about the origin.
  Cloth& place(const Point& translation_m, const Point& rotation_deg = {0, 0, 0});

  struct TOILE_HIDDEN Parts;
  const Parts& parts() const { return *parts_; }  // for the library itself

 private:
  explicit Cloth(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace toile
