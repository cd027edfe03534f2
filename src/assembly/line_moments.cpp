#include "assembly/line_moments.hpp"

#include <cmath>

namespace toile::internal {
namespace {

double kink_rad(const LineBend& bend, std::span<const double> C) {
  double kink = 0;
  for (const LineBend::Part& part : bend.hinges) kink += part.share * C[at(part.hinge)];
  return kink;
}

}  // namespace

double line_stiffness_N_m(const ClothModel& model, const LineBend& bend) {
  if (model.stiffness_share.empty()) return bend.stiffness_N_m;
  const auto share = [&](Index panel) { return model.stiffness_share[at(panel)].bend; };
  return 0.5 * (share(bend.panel[0]) + share(bend.panel[1])) * bend.stiffness_N_m;
}

void add_line_moments(const ClothModel& model, std::span<const double> C, std::span<double> m) {
  for (const LineBend& bend : model.line_bends) {
    const double moment = line_stiffness_N_m(model, bend) * kink_rad(bend, C);
    for (const LineBend::Part& part : bend.hinges) m[at(part.hinge)] += part.share * moment;
  }
}

void add_line_bounds(ClothModel& model) {
  for (const LineBend& bend : model.line_bends) {
    double sum = 0;
    for (const LineBend::Part& part : bend.hinges) sum += std::abs(part.share);
    for (const LineBend::Part& part : bend.hinges)
      model.bend[at(part.hinge)].plate_N_m += line_stiffness_N_m(model, bend) * std::abs(part.share) * sum;
  }
}

}  // namespace toile::internal
