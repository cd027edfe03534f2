// sim/scene.hpp: everything that one simulation is told, and the JSON file that says it.          docs/scenes.md
//
// Every key has a default, so that {"cloth": [{"pattern": "p.json"}], "body": {"mesh": "b.obj"}} is a complete scene.
// The command `dress` fills the same struct from its options.
//
// The members' own values are the defaults of the keys, and those of what runs the defaults of the members; each key is described
// in one place, sim/settings_scene.hpp.
//
// What is easily got wrong: a key that is understood but not available yet is an error here, never ignored; a scene
// that runs has been obeyed in every word.
#pragma once
#include "assembly/air.hpp"
#include "dress/events.hpp"
#include "dress/label_springs.hpp"
#include "io/json_places.hpp"
#include "material/fabric.hpp"
#include "material/membrane.hpp"
#include "sim/colliders.hpp"
#include "solver/modified_pcg.hpp"
#include "step/drag.hpp"
#include "step/implicit_euler.hpp"

#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

struct ScenePanel : PanelInTime {  // what one panel has of its own
  std::string name;
  std::optional<Fabric> fabric;
  std::optional<double> rest_stretch_u,
      rest_stretch_v;  // b of the warp and the weft, < 1 pulls together; absent: the pattern's
};

struct ScenePin {
  Vec3 near_m{0, 0, 0};                         // the particle nearest to it at the start is held
  std::optional<std::array<Vec3, 2>> in_box_m;  // instead: all between two corners of a box at the start
  enum class Hold { fixed, path, moves, body };
  Hold hold = Hold::fixed;
  std::vector<VectorKey> path;  // ascending times; straight in between, at rest before and after
  RigidPath moves;  // instead: all that is held moves as one, from where it is when it is taken; times from there
  double from_s = 0, to_s = std::numeric_limits<double>::infinity();  // it is held in this time
};

// A hand that pulls the nearest particle by a damped spring to a place that may move.
struct SceneDrag {
  Vec3 near_m{0, 0, 0};
  std::vector<VectorKey> path;  // of the hand
  double stiffness_N_per_m = Drag{}.stiffness_N_per_m, damping_N_s_per_m = Drag{}.damping_N_s_per_m,
         max_force_N = Drag{}.max_force_N;
  double from_s = 0, to_s = 0;  // it holds the cloth in this time
};

struct SceneGrid {
  double width_m = 1, height_m = 1, edge_m = 0.02;
};

struct SceneTube {
  double radius_m = 0.2, length_m = 1, edge_m = 0.02;
};

struct SceneRibbon {
  double width_m = 0.1, edge_m = 0.02;
  std::vector<Vec3> path_m;  // its middle line goes through these points
  bool closed = false;       // from the last point back to the first
  Vec3 across{0, 0, 1};      // its breadth at the first point, made perpendicular to the line
};

// Cloth that is given in memory: a scene file has no word for it.
struct SceneClothArrays {
  Vec3s x;  // where it starts, m
  std::vector<Triangle> triangles;
  std::vector<std::array<Vec2, 3>> uv;   // [triangle][corner] as it was cut, m; empty: as it starts
  std::vector<Index> panel;              // [triangle]; empty: one panel
  std::vector<std::string> panel_names;  // empty: the cloth's name
};

// Where the shape at rest of a mesh comes from: its drawing (vt), or the mesh as it starts.
enum class RestShape { automatic, drawing, start };  // automatic: the drawing, if it is in metres

struct SceneCloth {
  std::string name;
  std::string pattern;  // path, resolved; empty for the others below
  std::string mesh;     // path of a mesh, resolved; likewise
  LengthUnit mesh_unit = LengthUnit::m;
  RestShape rest_shape = RestShape::automatic;
  std::optional<SceneGrid> grid;
  std::optional<SceneTube> tube;
  std::optional<SceneRibbon> ribbon;
  std::shared_ptr<const SceneClothArrays> arrays;
  bool is_sewn() const { return !pattern.empty(); }
  // Empty for patterns, meshes and arrays.
  std::string_view shape_key() const { return grid ? "grid" : tube ? "tube" : ribbon ? "ribbon" : ""; }
  // Of its triangles: of the outlines of a pattern, or of its shape.
  double edge_m() const { return grid ? grid->edge_m : tube ? tube->edge_m : ribbon ? ribbon->edge_m : resolution_m; }
  void set_edge_m(double edge_m) {
    vertices.reset();
    resolution_m = edge_m;
    if (grid) grid->edge_m = edge_m;
    if (tube) tube->edge_m = edge_m;
    if (ribbon) ribbon->edge_m = edge_m;
  }
  double resolution_m = 0.01;
  std::optional<int> vertices;  // of the welded garment: then resolution_m does not count
  Fabric fabric;
  std::vector<ScenePanel> panels;
  Vec3 translation_m{0, 0, 0};
  Vec3 rotation_deg{0, 0, 0};  // R = Rz Ry Rx, as in patterns
  std::vector<ScenePin> pins;
  std::vector<SceneDrag> drags;
  std::vector<LabelHeight> label_heights;  // of edges with a label; the waist is measured when it is not given
};

struct Scene {
  std::string name = "scene";
  std::vector<SceneCloth> cloth;
  SceneCollider body = [] {
    SceneCollider worn;
    worn.worn = true;
    return worn;
  }();
  std::vector<SceneCollider> solids;
  Vec3 gravity_m_per_s2 = ModelOptions{}.gravity_m_per_s2;
  AirOptions air;
  // In time, ascending and straight in between; they take the place of the constants above.
  std::vector<VectorKey> gravity_path, wind_path;

  // Of a garment that is dressed without a scene: most are still after three or four, a long skirt at 2.1 cm after 11.
  static constexpr double longest_dress_s = 20;
  double fps = 30, seconds = 5;      // of the motion, where the body moves; otherwise of the drape
  bool seconds_given = false;        // false: a motion that ends runs to its end
  double drape_seconds = 10;         // before the motion, and of garments that others go over: a limit
  std::optional<double> step_max_s;  // absent: 1/60 s for patterns, a frame for grids
  bool until_still = false;          // stop when at rest; then `seconds` is a limit, and moving at the end a failure

  std::optional<Preconditioner> preconditioner;  // absent: the best for the size
  std::optional<double> tolerance;               // absent: usual_tolerance of the two beside it
  PcgProcedure procedure = PcgOptions{}.procedure;
  double solver_tolerance() const;
  Integrator integrator = StepOptions{}.integrator;
  int newton_iterations = StepOptions{}.newton_iterations;
  int relinearisations = StepOptions{}.relinearisations;
  bool paper_scaling = ModelOptions{}.paper_scaling;
  DampingJacobian damping_jacobian = ModelOptions{}.damping_jacobian;

  std::optional<double> contact_thickness_m, contact_friction;  // of all fabrics, when given
  std::vector<PairFriction> friction_between;
  bool self_contact = ContactRowOptions{}.cloth_cloth;
  bool flypaper = StepOptions{}.flypaper;
  bool strict_start = false;

  std::string start;       // directory of a run whose last frame is where this one begins; empty: from the panels
  std::string output_dir;  // empty: out/<name>
  std::optional<bool> preview;
  std::vector<int> picture_frames;  // of frames.png, sim/picture_run.hpp
};

struct SceneFile {
  Scene scene;
  JsonPlaces places;  // of its objects and of /output/dir, for what is found wrong with them when they are loaded
};
// Throws InputError naming file, line, JSON pointer, expected and got.  Relative paths resolve against the folder of
// `file`, but for output.dir, which resolves against the folder where the program runs.
SceneFile read_scene(std::string_view text, const std::string& file);
// Without the places: later messages name no line.
Scene parse_scene(std::string_view text, const std::string& file);

// Where the texts of scenes and patterns come from: the disk, or the files inside the program.
using TextSource = std::function<std::string(const std::string& path)>;
std::string read_text_file(const std::string& path);

}  // namespace toile::internal
