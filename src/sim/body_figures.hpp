// sim/body_figures.hpp: a body in numbers: for the linter of patterns (garment/lint.hpp), and for where labelled edges belong.
#pragma once
#include "body/arms.hpp"
#include "garment/lint.hpp"
#include "io/body_measurements.hpp"

#include <optional>
#include <span>
#include <string>

namespace toile::internal {

// The figures of an upright person, measured on the surface; 0 where none is found.  A tape finds the waist better, and has lengths that no
// surface shows: `measured` takes precedence.
BodyFigures body_figures(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                         const std::optional<BodyMeasurements>& measured = {});
// The pose is the mesh's: the file's counts only where no arms were found.
void add_arms(BodyFigures& figures, const Arms& arms);
// A sentence when the file's pose is not the mesh's; else empty.
std::string odd_pose(const BodyMeasurements& measured, const BodyFigures& figures);

}  // namespace toile::internal
