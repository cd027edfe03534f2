// sim/body_figures.hpp: a body in numbers: for the linter of patterns (garment/lint.hpp), and for where labelled edges belong.
#pragma once
#include "body/arms.hpp"
#include "garment/lint.hpp"
#include "io/body_measurements.hpp"

#include <optional>
#include <span>
#include <string>

namespace toile::internal {

// Of an upright person, measured on the surface; what is not found is 0.  A tape knows better where a waist is, and has what no surface shows:
// what `measured` has goes before.
BodyFigures body_figures(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                         const std::optional<BodyMeasurements>& measured = {});
// The pose is the mesh's: what a file says of it counts only where no arms were found.
void add_arms(BodyFigures& figures, const Arms& arms);
// A sentence when the file is about another pose than the mesh's; empty when not.
std::string odd_pose(const BodyMeasurements& measured, const BodyFigures& figures);

}  // namespace toile::internal
