#include "dress/start_state.hpp"

#include "contact/crossing_finder.hpp"
#include "core/error.hpp"
#include "dress/untangle.hpp"
#include "mesh/check.hpp"

#include <fmt/printf.h>

#include <algorithm>

namespace toile::internal {
namespace {

bool is_closed(std::span<const Vec3> x, std::span<const Triangle> triangles) {
  try {
    check_closed("body", x, triangles);
  } catch (const InputError&) {
    return false;
  }
  return true;
}

// The mean edge of one part's triangles, in the pattern.
double mean_edge_m(const ClothMesh& mesh, const OutfitPart& part) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.panel[t] < part.first_panel || mesh.panel[t] >= part.first_panel + part.panels) continue;
    for (std::size_t k = 0; k < 3; ++k) sum += (mesh.uv[t][(k + 1) % 3] - mesh.uv[t][k]).norm();
    count += 3;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

std::string far_moves(const Outfit& outfit, std::span<const Vec3> before) {
  std::string text;
  std::size_t first = 0;
  for (const OutfitPart& part : outfit.parts) {
    double largest_m = 0;
    for (std::size_t i = first; i < first + at(part.particles); ++i)
      largest_m = std::max(largest_m, (outfit.state.x[i] - before[i]).norm());
    first += at(part.particles);
    const double edge_m = mean_edge_m(outfit.mesh, part);
    if (largest_m <= most_edges_moved * edge_m) continue;
    text += (text.empty() ? "" : "; ") + printable(part.name) +
            fmt::sprintf(": untangling moved it by up to %.1f mm, %.1f of its edges of %.1f mm", 1e3 * largest_m,
                         largest_m / edge_m, 1e3 * edge_m);
  }
  return text;
}

}  // namespace

StartCrossings start_crossings(const Outfit& outfit, std::span<const Triangle> body, std::span<const Vec3> body_x) {
  const FoundCrossings found = find_crossings(outfit.mesh.triangles, outfit.state.x, body, body_x);
  const auto all = std::span(found.all);
  return {count_crossing_edges(all.first(found.of_cloth)), count_crossing_edges(all.subspan(found.of_cloth))};
}

std::vector<Index> held_from_the_start(const Events& events) {
  std::vector<Index> held;
  for (const TimedPin& timed : events.pins)
    if (timed.from_s <= 0 && timed.to_s > 0) held.push_back(timed.pin.particle);
  std::sort(held.begin(), held.end());
  return held;
}

UntangledStart untangle_start(Outfit& outfit, std::span<const Triangle> body, std::span<const Vec3> body_x,
                              std::vector<Index> held, const std::function<bool()>& stop, int most_in_vain) {
  const bool with_body = !body.empty() && is_closed(body_x, body);
  const Vec3s before = outfit.state.x;
  UntangleOptions options;
  options.held = std::move(held);
  options.most_in_vain = most_in_vain;
  const UntangleReport report =
      untangle(outfit.mesh.triangles, outfit.state.x, with_body ? body : std::span<const Triangle>{},
               with_body ? body_x : std::span<const Vec3>{}, options, [&](int, int) { return !(stop && stop()); });
  return {report.iterations, 1e3 * report.largest_move, far_moves(outfit, before)};
}

}  // namespace toile::internal
