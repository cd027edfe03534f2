// io/bone_parts.hpp: a file that says which joints are which part of a person, where their names do not tell.
//
//   {"body": {"hips": "Bone.001", "left thigh": "Bone.004", "spine": ["Bone.002", "Bone.003"]}, "motion": {"head": "Kopf", "left hand": null}}
//
// "body" names nodes of the body's skeleton, "motion" of the recording's; both may be missing.  null: there is none.
#pragma once
#include "rig/bone_names.hpp"

#include <string_view>

namespace toile::internal {

// A skeleton and what its names say, to be corrected.
struct NamedSkeleton {
  const Figure* figure;
  PersonBones* bones;
};
// Throws InputError with line and pointer for a part or a joint that is not there.
void read_bone_parts(std::string_view text, std::string_view file, const NamedSkeleton& body,
                     const NamedSkeleton& motion);

}  // namespace toile::internal
