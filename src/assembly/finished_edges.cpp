#include "assembly/finished_edges.hpp"

#include "assembly/plate_moments.hpp"
#include "assembly/topstitched_bands.hpp"
#include "material/edge_finish.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <utility>

namespace toile::internal {
namespace {

constexpr double cosine_of_corner = -0.7071067811865476;  // a line that turns by more than 45 degrees is two

struct Side {  // of a triangle: from its corner k to the next
  std::size_t triangle = 0, k = 0;
  auto operator<=>(const Side&) const = default;
};

struct Line {  // along a side
  double length_m = 0, bend_N_m2 = 0;
};

// exp(i angle) of a triangle at its corner.
std::complex<double> corner_angle(const std::array<Vec2, 3>& uv, std::size_t corner) {
  const Vec2 a = uv[(corner + 1) % 3] - uv[corner], b = uv[(corner + 2) % 3] - uv[corner];
  const std::complex<double> turn(a.dot(b), a.x() * b.y() - a.y() * b.x());
  return turn / std::abs(turn);
}

class Lines {
 public:
  explicit Lines(const ClothModel& model)
      : mesh_(&model.mesh), topology_(&model.topology), hinges_(hinges_of_sides(model.topology)) {
    for (std::size_t t = 0; t < mesh_->triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        side_.emplace(std::pair(mesh_->triangles[t][k], mesh_->triangles[t][(k + 1) % 3]), Side{t, k});
  }

  const Side* side_of(Index a, Index b) const {
    for (const auto& edge : {std::pair(a, b), std::pair(b, a)})
      if (const auto found = side_.find(edge); found != side_.end()) return &found->second;
    return nullptr;
  }

  void add(const Side& side, double length_m, double bend_N_m2) {
    Line& line = line_[side];
    line.length_m = length_m;
    line.bend_N_m2 += bend_N_m2;
  }

  std::vector<LineBend> bends() const {
    std::vector<LineBend> all;
    for (const auto& [side, line] : line_)
      if (LineBend bend = bend_at_end(side, line); !bend.hinges.empty()) all.push_back(std::move(bend));
    return all;
  }

 private:
  // Through the fan at the side's end, to the edge with which the line goes on.
  LineBend bend_at_end(const Side& first, const Line& line) const {
    struct Crossed {
      Index hinge;
      std::complex<double> at;  // exp(i phi_h)
    };
    std::vector<Crossed> crossed;
    std::complex<double> turned(1, 0);
    Side arriving = first;  // the side that ends at the particle
    while (true) {
      const Side leaving{arriving.triangle, (arriving.k + 1) % 3};
      turned *= corner_angle(mesh_->uv[leaving.triangle], leaving.k);
      if (turned.real() < cosine_of_corner) {
        if (const auto next = line_.find(leaving); next != line_.end()) {
          LineBend bend;
          bend.panel = {mesh_->panel[first.triangle], mesh_->panel[leaving.triangle]};
          bend.stiffness_N_m = 2 / (line.length_m / line.bend_N_m2 + next->second.length_m / next->second.bend_N_m2);
          // exp(i Phi/2), Phi being near pi.
          const double half_cosine = std::copysign(std::sqrt(0.5 * std::max(0.0, 1 + turned.real())), turned.imag()),
                       half_sine = std::sqrt(0.5 * (1 - turned.real()));
          for (const Crossed& one : crossed)
            bend.hinges.push_back({one.hinge, half_cosine * one.at.real() + half_sine * one.at.imag()});
          return bend;
        }
      } else if (turned.imag() < 0) {
        return {};  // past straight on
      }
      const Index hinge = hinges_[leaving.triangle][leaving.k];
      if (hinge < 0) return {};
      crossed.push_back({hinge, turned});
      const auto& [one, other] = topology_->hinges[at(hinge)].triangle;
      arriving.triangle = static_cast<std::size_t>(one) == leaving.triangle ? at(other) : at(one);
      const std::array<Index, 3>& sides = hinges_[arriving.triangle];
      arriving.k = sides[0] == hinge ? 0 : sides[1] == hinge ? 1 : 2;
    }
  }

  const ClothMesh* mesh_;
  const Topology* topology_;
  std::vector<std::array<Index, 3>> hinges_;      // [triangle][side]
  std::map<std::pair<Index, Index>, Side> side_;  // from, to
  std::map<Side, Line> line_;
};

}  // namespace

void finish_edges(ClothModel& model, std::span<const Fabric> fabrics, bool plates) {
  const ClothMesh& mesh = model.mesh;
  if (mesh.finished.empty()) return;
  Lines lines(model);
  TopstitchedBands bands(model);
  for (const FinishedEdge& edge : mesh.finished) {
    const Side* side = lines.side_of(edge.a, edge.b);
    if (side == nullptr) continue;
    const auto [t, k] = *side;
    const std::size_t next = (k + 1) % 3;
    const Vec2 along = mesh.uv[t][next] - mesh.uv[t][k];
    Fabric fabric = fabric_of(mesh, fabrics, t);
    if (!plates) fabric.bend_friction_N = 0;  // nothing remembers where threads have slipped
    const LineStiffness line =
        line_stiffness(fabric, along, {edge.hem_m, edge.tape_m, edge.allowance_m, edge.topstitched});
    model.threads.push_back({mesh.triangles[t][k], mesh.triangles[t][next], static_cast<Index>(t),
                             static_cast<std::uint8_t>(k), line.stretch_N});
    for (const Index end : {edge.a, edge.b}) model.mass_kg[at(end)] += 0.5 * line.mass_kg_per_m * along.norm();
    lines.add(*side, along.norm(), line.bend_N_m2);
    if (plates && edge.topstitched && edge.allowance_m > 0) bands.add(fabric, t, k, edge.allowance_m);
  }
  model.line_bends = lines.bends();
  bands.apply(fabrics, model);
}

}  // namespace toile::internal
