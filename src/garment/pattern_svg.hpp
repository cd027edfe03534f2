// garment/pattern_svg.hpp: draws a pattern, with the linter's findings marked.
//
// One unit of the drawing is a centimetre.  Panels stand side by side as they are drawn, y up: curves are curves (Q, C, A), edges have their
// numbers in the file inside and their seam outside, in the colour of the other side of that seam; the arrow is the grain.
#pragma once
#include "garment/lint.hpp"

#include <span>
#include <string>

namespace toile::internal {

// `pattern` may be as broken as the linter accepts.  The same bytes for the same input, in every locale.
std::string draw_pattern(const Pattern& pattern, std::span<const LintFinding> findings);

}  // namespace toile::internal
