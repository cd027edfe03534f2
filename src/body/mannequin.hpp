// body/mannequin.hpp: a human body made by our own code: an implicit surface over a skeleton of joints.
//
// Closed, about 10,000 vertices, A-pose, facing +z (so +x is her left), feet on y = 0, metres.  Deterministic: the
// same bits everywhere, and symmetric in x to the last bit.  Skin weights are kept so that the moving mannequin can
// come later without a new body.
//                                                                                                     docs/mannequin.md
#pragma once
#include "core/types.hpp"

#include <array>
#include <string>
#include <vector>

namespace toile {

struct Joint {
  std::string name;   // "hips", "spine", "chest", "neck", "head", "shoulder_left", ...
  Index parent = -1;  // an earlier joint; -1 for the root
  Vec3 position_m;    // in the A-pose
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
  // What a pattern is drawn against, m, taken from the mesh; girths are of a tape that does not follow hollows.
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

// Takes about a second; call it once.
Mannequin make_mannequin();

}  // namespace toile
