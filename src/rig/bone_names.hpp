// rig/bone_names.hpp: which node of a skeleton is which part of a person, by its name.
//
// Known are the names of CMU's recordings (LeftUpLeg), Mixamo (mixamorig:LeftUpLeg), MakeHuman (UpLeg_L, upperleg01.L, thigh_l), those of joints
// instead of bones (left_hip, as in AnimatedDrawings, and the mannequins' hip_left), and what is written like them.
//
// Mind: a skeleton named by joints calls the upper arm a shoulder, one named by bones the collar bone; it is the collar bone where there is an
// upper arm beside it.  Likewise a leg is a shank where there is a thigh.
#pragma once
#include "rig/figure.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

enum class BodyPart { hips, spine, neck, head, collar, upper_arm, forearm, hand, thigh, shank, foot, toes };
inline constexpr std::size_t body_part_count = 12;
std::string_view to_string(BodyPart part);

struct PersonBones {
  // [part][0: left or in the middle, 1: right]; -1: not found.  Of several that fit, the one nearest to the root.
  std::array<std::array<Index, 2>, body_part_count> node{};
  std::vector<Index> spine;  // from the hips up

  Index of(BodyPart part, std::size_t side = 0) const { return node[static_cast<std::size_t>(part)][side]; }
};

PersonBones person_bones(const Figure& figure);

// "hips", "left thigh", "spine": the names of parts in a file that says which nodes they are.
std::vector<std::string> part_words();
// Says which node a part is; of the spine all, from the hips up.  The word is one of part_words(), the nodes are the figure's.
void set_part(PersonBones& bones, std::string_view word, const std::vector<Index>& nodes);

}  // namespace toile::internal
