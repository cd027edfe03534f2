// sim/body_figure.hpp: bodies that a skeleton moves: their own of a glTF file, a rig beside the mesh, a mannequin's; by an animation or a recording.
#pragma once
#include "body/body_motion.hpp"
#include "io/mesh_file.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

struct SceneMesh;
struct SceneMotion;

// A file whose name ends like one that moves skeletons.
bool moves_a_skeleton(std::string_view path);

// The body's mesh with its targets applied.  `text` is its file, already seen; `seen` gets the bytes of the others.
SurfaceMesh shaped_surface(const SceneMesh& mesh, std::string_view text, const BytesSeen& seen);

struct FigureBody {
  CollisionBody standing;
  BodyMotion motion;
};
// Throw InputError, IoError.
FigureBody read_figure(const SceneMesh& mesh, std::string_view text, const SceneMotion& motion, const BytesSeen& seen);
// Of a recording; InputError for a file of animations.  What was mended in it is added to `notes`.
BodyMotion mannequin_motion(const Mannequin& mannequin, const SceneMotion& motion, const BytesSeen& seen,
                            std::vector<std::string>& notes);

// The files of the mesh's rig.
std::vector<std::string> rig_paths(const SceneMesh& mesh);
// How long such a motion takes, for an estimate; 0 for one that cannot be read.
double skeleton_motion_s(const SceneMotion& motion);

}  // namespace toile::internal
