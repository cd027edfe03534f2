// sim/collider_person.hpp: a body that wears cloth, or stands beside it: a mannequin, a mesh file, arrays in memory; and its motion.
#pragma once
#include "body/body_motion.hpp"
#include "body/mannequin.hpp"
#include "io/mesh_file.hpp"
#include "sim/collider.hpp"
#include "sim/settings.hpp"

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace toile::internal {

struct SceneCollider;

struct SceneMotion {
  std::string name;                      // of the mannequin: walk, twist, dance ...; empty: from a file
  std::string path;                      // resolved: .pc2, .mdd, a folder of mesh files, glTF or BVH
  std::string clip;                      // of a file with animations: a name or a number; empty: the only one
  std::string bones;                     // resolved: which joints are which part of a person; empty: by their names
  double fps = SampleOptions{}.rate_hz;  // of the file
  double lead_in_s = SampleOptions{}.lead_in_s;  // from the body's own pose into the motion
};

struct SceneMannequin {
  static constexpr std::string_view key = "mannequin";
  MannequinKind who = MannequinKind::woman;
};
template <class V>
void describe_choice(V& v, SceneMannequin& mannequin, bool) {
  static constexpr std::array<std::pair<std::string_view, MannequinKind>, 4> kinds = {
      {{"woman", MannequinKind::woman},
       {"dancer", MannequinKind::dancer},
       {"man", MannequinKind::man},
       {"default", MannequinKind::woman}}};
  v.name({"mannequin", "one that is built in ([mannequin.md](mannequin.md))", "no"}, kinds, mannequin.who);
}

// A change of shape, as MakeHuman has them.
struct SceneTarget {
  std::string path;  // resolved
  double share = 1;
};
template <class V>
void describe(V& v, SceneTarget& target) {
  v.path({Setting{"file", "lines of a vertex and its shift"}.needs()}, target.path);
  v.number({"share", "how much of it"}, {-10, 10}, target.share);
}

struct SceneMesh {
  static constexpr std::string_view key = "mesh";
  std::string path;                         // resolved
  LengthUnit unit = LengthUnit::automatic;  // of a solid: metres
  std::string measurements;                 // path, resolved; empty: the mesh's name with .yaml, if there is one
  UpAxis up = UpAxis::automatic;            // of a solid, and beside cloth that is modelled on it: y
  std::string rig, weights;                 // paths, resolved; of a body whose own file has no skeleton
  std::vector<SceneTarget> targets;
};
template <class V>
void describe_choice(V& v, SceneMesh& mesh, bool worn) {
  v.path({"mesh",
          worn ? "a closed [mesh file](#mesh-files)"
               : "a [mesh file](#mesh-files), with all its parts; open ones are [sheets](#open-sheets)",
          "no"},
         mesh.path);
}
template <class V>
void describe_beside(V& v, SceneMesh& mesh, bool worn) {
  v.name({"unit", "of the mesh", worn ? "metres, or an error that asks" : "metres"}, length_units, mesh.unit);
  v.name({"up", "axis of the mesh that points up", worn ? "what is seen: [axes](#axes)" : "y"}, up_axes, mesh.up);
  if (worn)
    v.path({"measurements", "of the mesh, a YAML file: [howto/measurements.md](howto/measurements.md)",
            "the file of the mesh's name that ends in .yaml, if there is one"},
           mesh.measurements);
  if (!worn) return;
  v.path({"rig",
          "of a mesh without a skeleton of its own: a rig of MakeHuman's or MPFB's "
          "([motions.md](motions.md#makehuman))",
          "none"},
         mesh.rig);
  v.path({"weights", "of the rig: its skin weights", "weights.NAME.json beside rig.NAME.json"}, mesh.weights);
  v.list({"targets", "changes of the mesh's shape, before anything else: MakeHuman's targets", "none"}, mesh.targets);
}

// Only given in memory: a scene file has no key for it.  One frame or more.
struct SceneArrays {
  struct Frames {
    std::vector<Vec3> x;       // m; frame after frame, the first is the start
    std::size_t vertices = 0;  // of a frame
    std::vector<Triangle> triangles;
    double fps = 30;
  };
  std::shared_ptr<const Frames> frames;
};

// The body of a mesh that was read from a file, checked.  Throws InputError.
CollisionBody make_body(const SurfaceMesh& read, const SceneMesh& mesh);
// The body of a mesh file with this text, checked; `beside` receives the other files that it is made of.  Throws InputError, IoError.
CollisionBody read_body(const std::string& path, std::string_view text, LengthUnit unit, UpAxis up,
                        const BytesSeen& beside = {});
// The file of the measurements: the named one, or one beside the mesh; empty: none.
std::string measurements_path(const SceneMesh& mesh);

// Every sample of a motion is checked here, before anything runs.
// Throw IoError, InputError, also for measurements of another body.
Collider load(const SceneMannequin& mannequin, const SceneCollider& whole);
Collider load(const SceneMesh& mesh, const SceneCollider& whole);
Collider load(const SceneArrays& arrays, const SceneCollider& whole);
ColliderCost cost(const SceneMannequin& mannequin, const SceneCollider& whole);
ColliderCost cost(const SceneMesh& mesh, const SceneCollider& whole);
ColliderCost cost(const SceneArrays& arrays, const SceneCollider& whole);
// The cost of reading a mesh, by the size of its file.
ColliderCost cost_of_file(const std::string& path);

}  // namespace toile::internal
