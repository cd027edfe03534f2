// sim/scene.hpp: the complete input of a simulation, and its JSON file.                           docs/scenes.md
//
// Every key has a default, so that {"cloth": [{"pattern": "p.json"}], "body": {"mesh": "b.obj"}} is a complete scene.
// The command `dress` fills the same struct from its options.
//
// The members' initial values are the defaults of the keys, and are themselves those of the options they fill; each key is described
// in one place, sim/settings_scene.hpp.
//
// Easily got wrong: a key that is known but not available yet is an error, never ignored; a scene that runs is obeyed
// in every key.
#pragma once
#include "assembly/air.hpp"
#include "io/json_places.hpp"
#include "material/membrane.hpp"
#include "sim/cloths.hpp"
#include "sim/colliders.hpp"
#include "solver/modified_pcg.hpp"
#include "step/implicit_euler.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

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
  // Over time, ascending, linear in between; they replace the constants above.
  std::vector<VectorKey> gravity_path, wind_path;

  // For a garment that is dressed without a scene: most are still after three or four, a long skirt at 2.1 cm after 11.
  static constexpr double longest_dress_s = 20;
  double fps = 30, seconds = 5;      // of the motion, where the body moves; otherwise of the drape
  bool seconds_given = false;        // false: a motion that ends runs to its end
  double drape_seconds = 10;         // before the motion, and of inner garments: a limit
  std::optional<double> step_max_s;  // absent: 1/60 s for patterns, a frame for grids
  bool until_still = false;          // stop when at rest; `seconds` is then a limit, and motion at the end a failure

  std::optional<Preconditioner> preconditioner;  // absent: the best for the size
  std::optional<double> tolerance;               // absent: usual_tolerance of the two beside it
  PcgProcedure procedure = PcgOptions{}.procedure;
  double solver_tolerance() const;
  Integrator integrator = StepOptions{}.integrator;
  int newton_iterations = StepOptions{}.newton_iterations;
  int relinearisations = StepOptions{}.relinearisations;
  BendElement bend_element = ModelOptions{}.bend_element;
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
  JsonPlaces places;  // of its objects and of /output/dir, for errors found when they are loaded
};
// Throws InputError naming file, line, JSON pointer, expected and got.  Relative paths resolve against the folder of
// `file`, but for output.dir, which resolves against the folder where the program runs.
SceneFile read_scene(std::string_view text, const std::string& file);
// Without the places: later messages name no line.
Scene parse_scene(std::string_view text, const std::string& file);

// The TextSource that reads from the disk.
std::string read_text_file(const std::string& path);

}  // namespace toile::internal
