// tests/generated/scene_space.hpp: the features of a scene, as users write it, and which of them cannot meet.
#pragma once
#include "generated/covering.hpp"

namespace toile::internal::generated {

const Space& scene_space();

}  // namespace toile::internal::generated
