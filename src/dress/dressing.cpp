#include "dress/dressing.hpp"

#include "dress/start_state.hpp"
#include "dress/tangles.hpp"
#include "garment/refine.hpp"

#include <fmt/printf.h>

#include <numeric>
#include <type_traits>

namespace toile::internal {
namespace {

// The garment's part, fabrics and elastic after those of the outfit; its mesh is added later.
void add_part(Outfit& outfit, const GarmentMesh& garment, std::span<const Fabric> fabrics,
              std::span<const Vec2> rest_stretch) {
  OutfitPart part;
  part.name = garment.name;
  part.first_panel = static_cast<Index>(outfit.mesh.panel_names.size());
  part.panels = static_cast<Index>(garment.mesh.panel_names.size());
  outfit.parts.push_back(std::move(part));
  outfit.fabrics.insert(outfit.fabrics.end(), fabrics.begin(), fabrics.end());
  outfit.rest_stretch.insert(outfit.rest_stretch.end(), rest_stretch.begin(), rest_stretch.end());
  outfit.seams += static_cast<int>(garment.seams.size());
}

// The welded mesh of the garments already worn and the new one.
void weld_on(Outfit& outfit, const WeldedMesh& welded) {
  const Index worn_before = outfit.mesh.particle_count;
  outfit.mesh = welded.mesh;
  outfit.parts.back().particles = welded.mesh.particle_count - worn_before;
}

}  // namespace

LabelSprings wear(Outfit& outfit, const GarmentMesh& garment, std::span<const Fabric> fabrics,
                  std::span<const Vec2> rest_stretch, std::span<const LabelHeight> heights) {
  outfit.state.x.resize(static_cast<std::size_t>(outfit.mesh.particle_count), Vec3::Zero());
  const GarmentMesh panels = over(outfit, garment);
  const WeldedMesh welded = weld(panels);
  add_part(outfit, garment, fabrics, rest_stretch);
  weld_on(outfit, welded);
  const auto particles = static_cast<std::size_t>(outfit.mesh.particle_count);
  outfit.state = {Vec3s(particles, Vec3::Zero()), Vec3s(particles, Vec3::Zero())};
  outfit.thickness_scale.assign(particles, 1);
  return LabelSprings(panels, heights).welded(welded.particle_of);
}

void carry_over(const Outfit& worn, const GarmentMesh& sewn, const Outfit& before, const GarmentMesh& refined,
                std::span<const std::array<Index, 2>> ends, Outfit& fine) {
  const std::vector<Index> from = weld(over(before, sewn)).particle_of, to = weld(over(before, refined)).particle_of;
  std::vector<std::array<Index, 2>> middles;
  for (const auto& [a, b] : ends) middles.push_back({a + before.mesh.particle_count, b + before.mesh.particle_count});
  const auto carry = [&](const auto& values, auto& to_fine) {
    std::decay_t<decltype(to_fine)> unwelded;
    for (const Index i : from) unwelded.push_back(values[at(i)]);
    interpolate(std::span<const std::array<Index, 2>>(middles), unwelded);
    for (std::size_t i = 0; i < to.size(); ++i) to_fine[at(to[i])] = unwelded[i];
  };
  carry(worn.state.x, fine.state.x);
  carry(worn.thickness_scale, fine.thickness_scale);
  fine.rest_stretch = worn.rest_stretch;
}

Dressing::Dressing(const Outfit& outfit, const GarmentMesh& garment, std::span<const Fabric> fabrics,
                   std::span<const Vec2> rest_stretch, BodySurface* body, const StepOptions& step,
                   SewingOptions options)
    : outfit_(outfit), options_(std::move(options)), panels_(over(outfit, garment)) {
  add_part(outfit_, garment, fabrics, rest_stretch);
  options_.held_particles = outfit.mesh.particle_count;
  sewing_.emplace(panels_, outfit_.fabrics, body, step, options_);

  std::vector<double> scale = sewing_->thickness_scale();
  tangled_ = switch_off_tangles(panels_.x, scale);
  if (tangled_) sewing_->set_thickness_scale(std::move(scale));
}

std::string Dressing::explain() const {
  constexpr std::size_t most = 5;
  if (sewing_->weld_obstacle()) {  // the gaps are small, and not the obstacle
    const Vec3 p = *sewing_->weld_obstacle();
    return fmt::sprintf(
        "every seam is closed to %.1f mm, but the weld would push cloth through cloth near (%.2f, %.2f, %.2f) m",
        1e3 * sewing_->widest_gap_m(), p.x(), p.y(), p.z());
  }
  std::string text;
  std::size_t open = 0;
  for (const SeamGap& gap : sewing_->gaps()) {
    if (gap.gap_m < options_.weld_gap_m) continue;
    if (++open > most) continue;
    const std::string why =
        gap.stretch > options_.taut
            ? fmt::sprintf("too small: the cloth beside it is stretched by %.0f %%", 100 * gap.stretch)
            : std::string("the body is in the way");
    text += (open == 1 ? "" : "; ") + ("seam " + panels_.seams[static_cast<std::size_t>(gap.seam)].name) +
            fmt::sprintf(" is open by %.1f cm near (%.2f, %.2f, %.2f) m, ", 1e2 * gap.gap_m, gap.where.x(),
                         gap.where.y(), gap.where.z()) +
            why;
  }
  if (open > most) text += "; and " + std::to_string(open - most) + " more seams";
  return text;
}

bool Dressing::take_apart(std::span<const Triangle> body, std::span<const Vec3> body_x,
                          const std::function<bool()>& stop) {
  const std::vector<Index> open = sewing_->open_pairs(options_.weld_share * sewing_->mean_edge_m());
  GarmentMesh joined = panels_;
  joined.leave_open(open);
  Outfit apart = worn(joined);
  std::vector<Index> held(static_cast<std::size_t>(options_.held_particles));
  std::iota(held.begin(), held.end(), 0);
  untangle_start(apart, body, body_x, std::move(held), stop, sewn_in_vain);
  if (stop && stop()) return false;
  const std::size_t in_the_way = open.size() + static_cast<std::size_t>(start_crossings(apart, body, body_x).all());
  if (in_the_way >= least_in_the_way_) return false;
  least_in_the_way_ = in_the_way;
  const std::vector<Index> particle_of = weld(joined).particle_of;
  Vec3s x(particle_of.size());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = apart.state.x[static_cast<std::size_t>(particle_of[i])];
  std::vector<double> scale(x.size(), 1);
  switch_off_tangles(x, scale);
  sewing_->go_on(std::move(x), std::move(scale));
  return true;
}

// Crossings of panels with each other or with the outfit.
bool Dressing::switch_off_tangles(const Vec3s& x, std::vector<double>& scale) const {
  const Topology topology = build_topology(panels_.mesh.particle_count, panels_.mesh.triangles);
  Tangles tangles(topology, panels_.mesh.triangles);
  tangles.find(x);
  if (tangles.any()) tangles.switch_off(scale);
  return tangles.any();
}

std::vector<Index> Dressing::leave_open() {
  std::vector<Index> open = sewing_->open_pairs(options_.weld_gap_m);
  panels_.leave_open(open);
  return open;
}

std::vector<Index> Dressing::particle_of() const { return weld(panels_).particle_of; }

Outfit Dressing::worn(const GarmentMesh& panels) const {
  Outfit worn = outfit_;
  const WeldedMesh welded = weld(panels);
  worn.state = weld_state(panels, welded, sewing_->model(), sewing_->state());
  worn.thickness_scale = weld_thickness(welded, sewing_->thickness_scale());
  weld_on(worn, welded);
  return worn;
}

LabelSprings Dressing::labels() const { return LabelSprings(panels_, options_.label_heights).welded(particle_of()); }

}  // namespace toile::internal
