// body/mannequin.hpp: human bodies made by our own code: an implicit surface over a skeleton of joints.
//
// Closed, A-pose, facing +z (so +x is the left), feet on y = 0, metres.  Deterministic: the same bits everywhere, and
// symmetric in x to the last bit.  pose.hpp moves them.
//                                                                                                     docs/mannequin.md
#pragma once
#include "core/types.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

struct Joint {
  std::string name;   // "hips", "spine", "chest", "neck", "head", "shoulder_left", ...
  Index parent = -1;  // an earlier joint; -1 for the root
  Vec3 position_m;    // in the A-pose
  Vec3 end_m;         // of its bone: the first child, or the crown, the finger tips, the tips of the toes
  double radius_m = 0, end_radius_m = 0;  // of the flesh around the bone at both ends, about
};

struct SkinWeights {  // up to four joints per vertex, weights sum to 1, largest first, unused weight 0
  std::array<Index, 4> joint{0, 0, 0, 0};
  std::array<double, 4> weight{0, 0, 0, 0};
};

struct Mannequin {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;  // counter-clockwise from outside
  std::vector<SkinWeights> skin;    // per vertex
  std::vector<Joint> joints;
  // The measurements that a pattern is drafted to, m, taken from the mesh; girths are of a tape, which does not follow hollows.
  // The waist stands at height - head_length - waist_line, both measured vertically.
  struct Measurements {
    double height;             // sole to crown
    double head_length;        // crown to the nape, where the neck's back turns into the shoulders'
    double waist_line;         // nape to waist
    double shoulder_width;     // between the acromions
    double bust, waist, hips;  // girths: largest at the breast, smallest above the hips, largest below the waist
    double arm_length;         // acromion to wrist
    double neck_girth;         // smallest, level
    double wrist;              // girth, across the arm
  } measurements_m;
};

enum class MannequinKind {
  woman,   // 1.72 m, 10,054 vertices: our own patterns are drawn for her
  dancer,  // the woman's shape with longer edges, 7,630 vertices within 3 %
  man,     // 1.80 m, 9,941 vertices within 3 %
};

// "woman", "dancer", "man".  Throws InputError with the nearest of them.
MannequinKind mannequin_kind(std::string_view name);
std::string_view to_string(MannequinKind kind);

// Takes about a second; call it once.
Mannequin make_mannequin(MannequinKind kind = MannequinKind::woman);

}  // namespace toile::internal
