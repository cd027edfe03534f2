// assembly/line_moments.hpp: moments of the lines along finished edges, from the fold angles of their hinges.        finished_edges.hpp
//
//   m_h += K a_h sum a_k C_k        C_k: theta - theta_0 of hinge k, less what the cloth beside it remembers: the layers of a hem remember the same
#pragma once
#include "assembly/cloth_model.hpp"

#include <span>

namespace toile::internal {

// K with the panels' shares of stiffness.
double line_stiffness_N_m(const ClothModel& model, const LineBend& bend);

void add_line_moments(const ClothModel& model, std::span<const double> C_rad, std::span<double> m_N_m);

// Adds to BendRest::plate_N_m what a step's matrix takes for them: a diagonal that is no smaller in any motion, by Gershgorin's circles.
void add_line_bounds(ClothModel& model);

}  // namespace toile::internal
