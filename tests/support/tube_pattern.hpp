// tests/support/tube_pattern.hpp: two rectangles of 50 by 20 cm, 50 cm apart, sewn at both sides: a tube of 1 m around.
#pragma once

namespace toile::internal::test {

inline constexpr const char* tube_pattern_text = R"({"pattern": {"panels": {
    "front": {"translation": [0, 0, 25], "rotation": [0, 0, 0], "vertices": [[-25,0],[25,0],[25,20],[-25,20]],
      "edges": [{"endpoints": [0,1]}, {"endpoints": [1,2]}, {"endpoints": [2,3]}, {"endpoints": [3,0]}]},
    "back": {"translation": [0, 0, -25], "rotation": [0, 0, 0], "vertices": [[-25,0],[-25,20],[25,20],[25,0]],
      "edges": [{"endpoints": [0,1]}, {"endpoints": [1,2]}, {"endpoints": [2,3]}, {"endpoints": [3,0]}]}},
    "stitches": [[{"panel": "front", "edge": 1}, {"panel": "back", "edge": 2}], [{"panel": "front", "edge": 3}, {"panel": "back", "edge": 0}]]},
    "properties": {"units_in_meter": 100}})";

}  // namespace toile::internal::test
