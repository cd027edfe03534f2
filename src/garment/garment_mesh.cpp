#include "garment/garment_mesh.hpp"

#include "assembly/block_pattern.hpp"
#include "core/disjoint_sets.hpp"
#include "core/elementary.hpp"
#include "core/error.hpp"
#include "garment/gathers.hpp"
#include "garment/panel_mesh.hpp"
#include "garment/pattern_check.hpp"
#include "garment/pleats.hpp"
#include "garment/seam_fit.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace toile::internal {
namespace {

std::string side_name(const Pattern& pattern, const StitchSide& side) {
  const Panel& panel = pattern.panels[at(side.panel)];
  return printable(panel.name) + "." + std::to_string(panel.file_number(side.edge));
}

struct MeshedPanel {
  std::vector<std::vector<Index>> edge_particles;  // [edge] first to last corner, in the edge's direction
  Index first_particle = 0, end_particle = 0;
};

// Appends a panel to the garment.
MeshedPanel add_panel(GarmentMesh& garment, const Panel& panel, Index panel_index, const PanelMesh& mesh) {
  const Index first = garment.mesh.particle_count;
  MeshedPanel meshed{mesh.edge_points};
  for (auto& particles : meshed.edge_particles) {
    for (Index& particle : particles) particle += first;
  }
  const PlanarMesh& planar = mesh.folded.mesh;
  const auto pattern_uv = [&](Index i) {
    return mesh.mirrored ? Vec2(planar.points[at(i)].y(), planar.points[at(i)].x())
                         : Vec2(planar.points[at(i)].y(), -planar.points[at(i)].x());
  };
  for (Triangle t : planar.triangles) {
    if (mesh.mirrored) std::swap(t[1], t[2]);
    garment.mesh.uv.push_back({pattern_uv(t[0]), pattern_uv(t[1]), pattern_uv(t[2])});
    garment.mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    garment.mesh.panel.push_back(panel_index);
  }
  for (std::size_t i = 0; i < planar.points.size(); ++i) {
    garment.x.push_back(panel.place(planar.points[i]));
    garment.on_panel_edge.push_back(i < mesh.outline_points);
  }
  garment.mesh.particle_count += static_cast<Index>(planar.points.size());
  garment.mesh.panel_names.push_back(panel.name);
  garment.panel_labels.push_back(panel.label);
  garment.mesh.panel_cloth.push_back({panel.fabric, panel.rest_stretch, panel.interfacing});
  for (std::size_t f = 0; f < panel.folds.size(); ++f) {
    for (const auto& [a, b] : mesh.folded.line[f])
      garment.mesh.folds.push_back({first + a, first + b, panel.folds[f].angle_rad});
  }
  for (std::size_t e = 0; e < panel.edges.size(); ++e) {
    const EdgeFinish& finish = panel.edges[e].finish;
    const std::vector<Index>& line = meshed.edge_particles[e];
    for (std::size_t k = 0; !finish.none() && k + 1 < line.size(); ++k)
      garment.mesh.finished.push_back(
          {line[k], line[k + 1], finish.hem_m, finish.tape_m, finish.allowance_m, finish.topstitched});
  }
  meshed.first_particle = first;
  meshed.end_particle = garment.mesh.particle_count;
  return meshed;
}

// `a`, `b`: particles of both sides, as paired.  They lie as drawn: placed, not moved.
void add_gather(const Seam& seam, const std::vector<Index>& a, const std::vector<Index>& b, const Vec3s& x,
                std::vector<Gather>& gathers) {
  const bool a_is_longer = seam.length_a_m > seam.length_b_m;
  const double longer = a_is_longer ? seam.length_a_m : seam.length_b_m;
  const double shorter = a_is_longer ? seam.length_b_m : seam.length_a_m;
  if (!(longer > gathered_ratio * shorter)) return;
  const std::vector<Index>& to = a_is_longer ? b : a;
  Gather gather{a_is_longer ? a : b, {}, longer / shorter};
  for (std::size_t k = 0; k + 1 < to.size(); ++k) gather.piece_m.push_back((x[at(to[k + 1])] - x[at(to[k])]).norm());
  gathers.push_back(std::move(gather));
}

// Pairs the samples of a stitch and refuses one that is sewn the wrong way round.
void add_seam(GarmentMesh& garment, const Pattern& pattern, const Stitch& stitch,
              const std::vector<MeshedPanel>& meshed, std::vector<Gather>& gathers) {
  std::vector<Index> a = meshed[at(stitch.a.panel)].edge_particles[at(stitch.a.edge)];
  std::vector<Index> b = meshed[at(stitch.b.panel)].edge_particles[at(stitch.b.edge)];
  if (!stitch.right_wrong) std::reverse(b.begin(), b.end());
  const Panel &panel_a = pattern.panels[at(stitch.a.panel)], &panel_b = pattern.panels[at(stitch.b.panel)];
  Seam seam{side_name(pattern, stitch.a) + " - " + side_name(pattern, stitch.b),
            edge_length_m(panel_a, panel_a.edges[at(stitch.a.edge)]),
            edge_length_m(panel_b, panel_b.edges[at(stitch.b.edge)])};
  const std::optional<SeamEnds> ends = seam_ends(pattern, stitch);
  if (ends && ends->twisted()) {
    throw InputError(
        "", "seam " + seam.name, "matching ends near each other where the panels are placed",
        "a twisted seam: its ends lie nearer to the opposite ends (check \"right_wrong\" and the panels' loops)");
  }
  const auto index = static_cast<Index>(garment.seams.size());
  const double length = 0.5 * (seam.length_a_m + seam.length_b_m), piece = length / static_cast<double>(a.size() - 1);
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (a[k] == b[k]) continue;
    const bool end = k == 0 || k + 1 == a.size();
    garment.pairs.push_back({a[k], b[k], end ? 0.5 * piece : piece, index});
  }
  if (stitch.angle_rad != 0) {  // no hinge before the weld
    for (std::size_t k = 0; k + 1 < a.size(); ++k) garment.mesh.folds.push_back({a[k], a[k + 1], stitch.angle_rad});
  }
  add_gather(seam, a, b, garment.x, gathers);
  garment.seams.push_back(std::move(seam));
}

void turn_over(GarmentMesh& garment, Index panel, const MeshedPanel& meshed) {
  for (std::size_t t = 0; t < garment.mesh.triangles.size(); ++t) {
    if (garment.mesh.panel[t] != panel) continue;
    std::swap(garment.mesh.triangles[t][1], garment.mesh.triangles[t][2]);
    std::swap(garment.mesh.uv[t][1], garment.mesh.uv[t][2]);
    for (Vec2& uv : garment.mesh.uv[t]) uv.y() = -uv.y();
  }
  // A ridge on the drawn side is a valley on the other.
  for (FoldedEdge& fold : garment.mesh.folds) {
    if (fold.a >= meshed.first_particle && fold.a < meshed.end_particle) fold.angle_rad *= -1;
  }
  for (FinishedEdge& edge : garment.mesh.finished) {
    if (edge.a >= meshed.first_particle && edge.a < meshed.end_particle) std::swap(edge.a, edge.b);
  }
}

// Panels joined right to wrong must be turned over for the surface to have one right side.
void orient_panels(GarmentMesh& garment, const Pattern& pattern, const std::vector<MeshedPanel>& meshed) {
  const PanelSides sides = panel_sides(pattern);
  if (sides.conflict >= 0) {
    throw InputError("", "seam " + garment.seams[at(sides.conflict)].name, "seams that give the garment one right side",
                     "a twisted seam: following the other seams, its two panels face opposite ways");
  }
  for (std::size_t p = 0; p < sides.side.size(); ++p) {
    if (sides.side[p] < 0) turn_over(garment, static_cast<Index>(p), meshed[p]);
  }
}

void merge_pairs(GarmentMesh& garment) {
  DisjointSets merged(at(garment.mesh.particle_count));
  for (const SeamPair& pair : garment.pairs) merged.join(pair.a, pair.b);
  garment.merged = merged.representatives();
}

// Corners that become one particle although no seam joins them: they close with the first seam of their panel.
void add_join(GarmentMesh& garment, const Pattern& pattern, const CornerJoin& join,
              const std::vector<MeshedPanel>& meshed, double share_m) {
  const auto particle = [&](Index panel, Index corner) {
    const std::vector<PanelEdge>& edges = pattern.panels[at(panel)].edges;
    const auto leaving =
        std::find_if(edges.begin(), edges.end(), [&](const PanelEdge& edge) { return edge.start == corner; });
    return meshed[at(panel)].edge_particles[static_cast<std::size_t>(leaving - edges.begin())].front();
  };
  const Index a = particle(join.panel_a, join.corner_a), b = particle(join.panel_b, join.corner_b);
  const auto seam = std::find_if(garment.pairs.begin(), garment.pairs.end(),
                                 [&](const SeamPair& pair) { return pair.a == a || pair.b == a; });
  garment.pairs.push_back({a, b, share_m, seam == garment.pairs.end() ? 0 : seam->seam});
}

GarmentMesh join_panels(const PleatedPattern& pleated, std::span<const PanelMesh> panels, double resolution_m) {
  const Pattern& pattern = pleated.pattern;
  GarmentMesh garment;
  garment.name = pattern.name;
  garment.legacy_frame = pattern.legacy_frame;
  std::vector<MeshedPanel> meshed;
  std::vector<char> laid(pattern.panels.size(), 0);  // [panel]
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    meshed.push_back(add_panel(garment, pattern.panels[p], static_cast<Index>(p), panels[p]));
    for (std::size_t e = 0; e < pattern.panels[p].edges.size(); ++e) {
      const std::string& label = pattern.panels[p].edges[e].label;
      if (!label.empty()) garment.labels.push_back({label, meshed.back().edge_particles[e]});
    }
  }
  for (const CornerJoin& join : pleated.joins) {
    if (std::exchange(laid[at(join.panel_b)], 1) == 0) lay_pleats(garment.mesh, join.panel_b, garment.x);
  }
  std::vector<Gather> gathers;
  for (const Stitch& stitch : pattern.stitches) add_seam(garment, pattern, stitch, meshed, gathers);
  garment.pleated = !pleated.joins.empty();
  for (const CornerJoin& join : pleated.joins) add_join(garment, pattern, join, meshed, resolution_m);
  orient_panels(garment, pattern, meshed);
  gather(garment.mesh, gathers);

  merge_pairs(garment);
  return garment;
}

}  // namespace

void GarmentMesh::leave_open(std::span<const Index> open_pairs) {
  if (open_pairs.empty()) return;
  std::vector<char> open(pairs.size(), 0);
  for (const Index k : open_pairs) open[at(k)] = 1;
  std::vector<SeamPair> closed;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (!open[k]) closed.push_back(pairs[k]);
  pairs = std::move(closed);
  merge_pairs(*this);
}

std::vector<Index> GarmentMesh::panel_of_particle() const {
  std::vector<Index> panel(x.size(), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const Index i : mesh.triangles[t]) panel[at(i)] = mesh.panel[t];
  return panel;
}

GarmentMesh mesh_garment(const Pattern& pattern, double resolution_m) {
  const PleatedPattern pleated = resolve_pleats(pattern);
  PanelMesher panels(pleated.pattern, pleated.edges);
  return join_panels(pleated, panels.mesh(resolution_m, std::vector<double>(pattern.panels.size(), resolution_m)),
                     resolution_m);
}

int welded_count(const GarmentMesh& garment) {
  int count = 0;
  for (std::size_t i = 0; i < garment.merged.size(); ++i) count += at(garment.merged[i]) == i ? 1 : 0;
  return count;
}

CountedGarment mesh_garment_to_count(const Pattern& pattern, int particles) {
  constexpr int least = 20, most = 2'000'000, halvings = 20;
  constexpr double tolerance = 0.01;
  if (particles < least || particles > most)
    throw InputError("", "vertices", "a number from 20 to 2,000,000", std::to_string(particles));
  const PleatedPattern pleated = resolve_pleats(pattern);
  PanelMesher mesher(pleated.pattern, pleated.edges);
  CountedGarment best;
  int best_count = 0;
  const auto attempt = [&](double outline_m, std::span<const double> inner_m) {
    GarmentMesh garment = join_panels(pleated, mesher.mesh(outline_m, inner_m), outline_m);
    const int count = welded_count(garment);
    if (best_count == 0 || std::abs(count - particles) < std::abs(best_count - particles)) {
      best = {std::move(garment), outline_m};
      best_count = count;
    }
    return count;
  };
  const std::size_t panels = pattern.panels.size();
  // A lattice of edge e has a particle per e^2 sqrt(3)/2; seams and outlines add to that, by less than half as much again
  // unless the pattern is all outline.
  const double estimate = std::sqrt(summarize(pattern).area_m2 / (0.8660254037844386 * particles));
  double fine = 0.5 * estimate, coarse = 4 * estimate;
  for (int k = 0; k < halvings && best_count != particles; ++k) {
    const double middle = k == 0 ? estimate : std::sqrt(fine * coarse);
    (attempt(middle, std::vector<double>(panels, middle)) > particles ? fine : coarse) = middle;
  }
  for (const double outline_m : {fine, coarse}) {
    std::vector<double> inner_m(panels, coarse);
    for (std::size_t p = 0; p < panels && best_count != particles; ++p) {
      inner_m[p] = fine;
      attempt(outline_m, inner_m);
    }
  }
  if (std::abs(best_count - particles) > tolerance * particles)
    throw InputError("", "vertices", "a number of particles that this pattern can be cut into, within 1 %",
                     std::to_string(particles) + "; the nearest found is " + std::to_string(best_count));
  return best;
}

WeldedMesh weld(const GarmentMesh& garment) {
  WeldedMesh welded{garment.mesh, std::vector<Index>(garment.merged.size(), -1)};
  Index count = 0;
  for (std::size_t i = 0; i < garment.merged.size(); ++i) {
    const auto root = at(garment.merged[i]);
    welded.particle_of[i] = root == i ? count++ : welded.particle_of[root];
  }
  welded.mesh.particle_count = count;
  for (Triangle& t : welded.mesh.triangles) {
    for (Index& corner : t) corner = welded.particle_of[at(corner)];
  }
  const Topology topology = build_topology(count, welded.mesh.triangles);
  const BlockPattern pattern = pattern_of_cloth(count, welded.mesh.triangles, topology.hinges);
  // Components keep their order, so that the garments already worn stay before the new one; within one, the order is BlockPattern's.
  std::vector<Index> row_at(at(count)), place(at(count));
  std::iota(row_at.begin(), row_at.end(), 0);
  std::sort(row_at.begin(), row_at.end(), [&](Index i, Index j) {
    return std::pair(pattern.piece(i), pattern.place(i)) < std::pair(pattern.piece(j), pattern.place(j));
  });
  for (std::size_t p = 0; p < row_at.size(); ++p) place[at(row_at[p])] = static_cast<Index>(p);
  for (Index& particle : welded.particle_of) particle = place[at(particle)];
  for (Triangle& t : welded.mesh.triangles) {
    for (Index& corner : t) corner = place[at(corner)];
  }
  for (FoldedEdge& fold : welded.mesh.folds) {
    fold.a = welded.particle_of[at(fold.a)];
    fold.b = welded.particle_of[at(fold.b)];
  }
  for (FinishedEdge& edge : welded.mesh.finished) {
    edge.a = welded.particle_of[at(edge.a)];
    edge.b = welded.particle_of[at(edge.b)];
  }
  return welded;
}

MeshQuality mesh_quality(const ClothMesh& mesh) {
  MeshQuality quality;
  std::vector<double> angles;
  double sum = 0;
  quality.min_edge_m = 1e300;
  for (const auto& uv : mesh.uv) {
    double smallest = 180;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 e = uv[(k + 1) % 3] - uv[k], f = uv[(k + 2) % 3] - uv[k];
      smallest = std::min(smallest,
                          ieee_atan2(std::abs(e.x() * f.y() - e.y() * f.x()), e.dot(f)) * 180 / 3.14159265358979323846);
      sum += e.norm();
      quality.min_edge_m = std::min(quality.min_edge_m, e.norm());
      quality.max_edge_m = std::max(quality.max_edge_m, e.norm());
    }
    angles.push_back(smallest);
  }
  if (angles.empty()) return {};
  std::sort(angles.begin(), angles.end());
  quality.min_angle_deg = angles.front();
  quality.p1_angle_deg = angles[angles.size() / 100];
  quality.mean_edge_m = sum / (3 * static_cast<double>(mesh.uv.size()));
  return quality;
}

}  // namespace toile::internal
