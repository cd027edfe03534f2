// tests/garment/pattern_text.hpp: small pattern files as text, for the tests of the reader.
#pragma once
#include "core/error.hpp"
#include "garment/pattern.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace toile::internal::pattern_text {

// A panel of 40 x 60 cm, counter-clockwise: edges 0 bottom, 1 right, 2 top, 3 left.
inline const std::string square_corners = "[[0, 0], [40, 0], [40, 60], [0, 60]]";
inline const std::string square_edges =
    R"([{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}])";

inline std::string panel(const std::string& corners = square_corners, const std::string& edges = square_edges,
                         const std::string& translation = "[0, 80, 20]", const std::string& rotation = "[0, 0, 0]") {
  return R"({"translation": )" + translation + R"(, "rotation": )" + rotation + R"(, "vertices": )" + corners +
         R"(, "edges": )" + edges + "}";
}

inline std::string file(const std::string& panels, const std::string& stitches = "[]",
                        const std::string& properties = R"({"units_in_meter": 100, "curvature_coords": "relative"})",
                        const std::string& more_of_pattern = "", const std::string& more = "") {
  return "{\"pattern\": {\n  \"panels\": " + panels + ",\n  \"stitches\": " + stitches + more_of_pattern +
         "},\n \"properties\": " + properties + more + "}";
}

inline std::string stitch(const std::string& panel_a, int edge_a, const std::string& panel_b, int edge_b,
                          const std::string& more = "") {
  return R"([{"panel": ")" + panel_a + R"(", "edge": )" + std::to_string(edge_a) + R"(}, {"panel": ")" + panel_b +
         R"(", "edge": )" + std::to_string(edge_b) + "}" + more + "]";
}

// Two squares sewn at both sides.
inline std::string two_squares(const std::string& stitches) {
  return file("{\"front\": " + panel() + ", \"back\": " + panel(square_corners, square_edges, "[0, 80, -20]") + "}",
              stitches);
}

// One panel called "front".
inline std::string one_panel(const std::string& corners, const std::string& edges) {
  return file("{\"front\": " + panel(corners, edges) + "}");
}

inline Pattern parse(const std::string& text) { return parse_pattern(text, "dir/p_specification.json"); }

// The message of the InputError that reading `text` throws.
inline std::string message_of(const std::string& text) {
  try {
    parse(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "(no error)";
}

inline void expect_error(const std::string& text, const std::vector<std::string>& parts) {
  const std::string message = message_of(text);
  EXPECT_EQ(message.rfind("dir/p_specification.json:", 0), 0U) << message;
  for (const std::string& part : parts) {
    EXPECT_NE(message.find(part), std::string::npos) << "misses: " << part << "\nin:     " << message;
  }
}

}  // namespace toile::internal::pattern_text
