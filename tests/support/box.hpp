// tests/support/box.hpp: the faces of a box whose corners come in the order of these bits: 0 = x, 1 = z, 2 = y.
#pragma once
#include "core/types.hpp"

#include <array>

namespace toile::internal::test {

inline constexpr std::array<Triangle, 12> box_triangles = {{{4, 6, 5},
                                                            {5, 6, 7},
                                                            {0, 1, 2},
                                                            {1, 3, 2},
                                                            {0, 4, 1},
                                                            {1, 4, 5},
                                                            {2, 3, 6},
                                                            {3, 7, 6},
                                                            {0, 2, 4},
                                                            {2, 6, 4},
                                                            {1, 5, 3},
                                                            {3, 5, 7}}};

}  // namespace toile::internal::test
