#include "sim/start_run.hpp"

#include "contact/distance.hpp"
#include "core/error.hpp"
#include "core/hash.hpp"
#include "garment/garment_mesh.hpp"
#include "io/file.hpp"
#include "io/json.hpp"
#include "io/obj.hpp"
#include "io/pc2.hpp"
#include "sim/run_writer.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <optional>

namespace toile::internal {
namespace {

constexpr double farthest_drawing_m =
    0.02;  // a point of the drawing may lie outside the other mesh by a curve's sagitta
constexpr double farthest_body_m = 1e-3;

Vec3 in_plane(const Vec2& p) { return {p.x(), p.y(), 0}; }

// Finds the triangle of a point of the drawing in one panel of the run.
class PanelDrawing {
 public:
  PanelDrawing(const SurfaceMesh& run, Index group) : run_(&run) {
    for (std::size_t t = 0; t < run.triangles.size(); ++t) {
      if (run.group[t] != group) continue;
      triangles_.push_back(t);
      for (const Index k : run.texcoord[t]) {
        low_ = low_.cwiseMin(run.texcoords[at(k)]);
        high_ = high_.cwiseMax(run.texcoords[at(k)]);
      }
    }
    const double count = std::sqrt(static_cast<double>(triangles_.size()));
    columns_ = std::max(1L, std::lround(count));
    cells_.resize(at(static_cast<Index>(columns_ * columns_)));
    for (const std::size_t t : triangles_) {
      Vec2 a = corner(t, 0), b = a;
      for (std::size_t k = 1; k < 3; ++k) {
        a = a.cwiseMin(corner(t, k));
        b = b.cwiseMax(corner(t, k));
      }
      for (long j = cell(a, 1); j <= cell(b, 1); ++j)
        for (long i = cell(a, 0); i <= cell(b, 0); ++i) cells_[static_cast<std::size_t>(j * columns_ + i)].push_back(t);
    }
  }

  struct Place {
    std::size_t triangle = 0;
    Vec3 barycentric{1, 0, 0};  // outside 0 ... 1 beyond the panel's outline
    double distance_m = std::numeric_limits<double>::infinity();
  };
  Place find(const Vec2& p) const {
    Place place;
    for (const std::size_t t : cells_[static_cast<std::size_t>(cell(p, 1) * columns_ + cell(p, 0))])
      try_triangle(t, p, place);
    if (place.distance_m > 0)
      for (const std::size_t t : triangles_) try_triangle(t, p, place);
    const Vec2 a = corner(place.triangle, 0), ab = corner(place.triangle, 1) - a, ac = corner(place.triangle, 2) - a,
               ap = p - a;
    const double d = ab.x() * ac.y() - ab.y() * ac.x();
    const double v = (ap.x() * ac.y() - ap.y() * ac.x()) / d, w = (ab.x() * ap.y() - ab.y() * ap.x()) / d;
    place.barycentric = Vec3(1 - v - w, v, w);
    return place;
  }

 private:
  Vec2 corner(std::size_t t, std::size_t k) const { return run_->texcoords[at(run_->texcoord[t][k])]; }
  long cell(const Vec2& p, Eigen::Index axis) const {
    const double extent = high_[axis] - low_[axis];
    const double share = extent > 0 ? (p[axis] - low_[axis]) / extent : 0;
    return std::clamp(static_cast<long>(share * static_cast<double>(columns_)), 0L, columns_ - 1);
  }
  void try_triangle(std::size_t t, const Vec2& p, Place& best) const {
    const double distance = std::sqrt(
        closest_vertex_triangle(in_plane(p), in_plane(corner(t, 0)), in_plane(corner(t, 1)), in_plane(corner(t, 2)))
            .distance2);
    if (!(distance < best.distance_m)) return;
    best.triangle = t;
    best.distance_m = distance;
  }

  const SurfaceMesh* run_;
  std::vector<std::size_t> triangles_;
  Vec2 low_ = Vec2::Constant(std::numeric_limits<double>::infinity()), high_ = -low_;
  long columns_ = 1;
  std::vector<std::vector<std::size_t>> cells_;
};

// The frame of a run in which its cloth is draped: the last before the body moves, or the last one.
int draped_frame(const std::filesystem::path& run, int samples) {
  const std::string path = (run / "report.json").string();
  if (!std::filesystem::exists(path)) throw IoError(printable(path), "not there: no finished run to start from");
  const Json report = Json::parse(read_file(path, Json::text_limit), printable(path));
  const Json* motion = report.find("motion");
  if (motion == nullptr || !motion->is_object()) return samples - 1;
  const Json& first = motion->at("first_frame");
  const double frame = first.number();
  if (!(frame >= 0 && frame < samples))
    first.fail("a frame of cloth.pc2, below " + std::to_string(samples), first.describe());
  return static_cast<int>(frame);
}

Vec3s draped(const std::filesystem::path& run, const std::string& path, std::size_t points) {
  Pc2Reader reader(path);
  if (at(reader.points()) != points)
    throw InputError(printable(path), "points", std::to_string(points) + ", as in the OBJ beside it",
                     std::to_string(reader.points()));
  if (reader.samples() == 0) throw InputError(printable(path), "samples", "at least one", "none");
  Vec3s x;
  reader.read(draped_frame(run, reader.samples()), x);
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!x[i].allFinite())
      throw InputError(printable(path), "vertex " + std::to_string(i) + " of the draped frame", "finite coordinates",
                       "infinity or not a number");
  return x;
}

void check_body(const std::filesystem::path& run, std::span<const Vec3> body_x) {
  const std::string obj = (run / "body.obj").string(), pc2 = (run / "body.pc2").string();
  const bool has_body = std::filesystem::exists(obj);
  if (has_body != !body_x.empty())
    throw InputError(printable(obj), "body", body_x.empty() ? "none, as in this scene" : "the body of this scene",
                     has_body ? "a body" : "none");
  if (!has_body) return;
  const Vec3s end = draped(run, pc2, body_x.size());
  for (std::size_t i = 0; i < end.size(); ++i) {
    const double distance = (end[i] - body_x[i]).norm();
    if (distance > farthest_body_m)
      throw InputError(printable(pc2), "vertex " + std::to_string(i) + " of the draped frame",
                       "the pose in which this scene begins", fmt::sprintf("%.3g m away from it", distance));
  }
}

}  // namespace

std::uint64_t hash_of_start(const std::string& directory) {
  const std::filesystem::path run(directory);
  const std::string cache = (run / "cloth.pc2").string();
  draped_frame(run, std::numeric_limits<int>::max());  // a finished run, before anything large is read
  Hash hash;
  hash.add_text(read_file((run / "cloth.obj").string()));
  const Vec3s x = draped(run, cache, at(Pc2Reader(cache).points()));
  hash.add_counted(std::span<const Vec3>(x));
  return hash.value();
}

Outfit start_from(const std::string& directory, std::span<const LoadedCloth> cloth, std::span<const Vec3> body_x) {
  const std::filesystem::path run_directory(directory);
  const std::string obj = (run_directory / "cloth.obj").string(), pc2 = (run_directory / "cloth.pc2").string();
  draped_frame(run_directory, std::numeric_limits<int>::max());  // a finished run, before anything large is read
  const SurfaceMesh run = load_obj(obj);
  if (run.texcoord.empty() || run.group.empty())
    throw InputError(printable(obj), "mesh", "panels as groups, with vt", "none");
  const Vec3s x = draped(run_directory, pc2, run.positions.size());
  check_body(run_directory, body_x);

  Outfit outfit;
  for (const LoadedCloth& one : cloth) {
    GarmentMesh garment = as_worn(one);
    const WeldedMesh welded = weld(garment);
    garment.mesh = welded.mesh;
    garment.x.assign(at(welded.mesh.particle_count), Vec3::Zero());
    garment.merged.clear();
    for (Index i = 0; i < welded.mesh.particle_count; ++i) garment.merged.push_back(i);
    garment.pairs.clear();
    garment.labels.clear();

    std::vector<std::optional<PanelDrawing>> panels;
    for (const std::string& name : welded.mesh.panel_names) {
      const auto group = std::find(run.group_names.begin(), run.group_names.end(), printable(name));
      if (group == run.group_names.end())
        throw InputError(printable(obj), "panels", "a group \"" + printable(name) + '"', "none of this name");
      panels.emplace_back(PanelDrawing(run, static_cast<Index>(group - run.group_names.begin())));
    }
    const ClothMesh drawn = drawn_mesh(welded.mesh);
    std::vector<char> known(garment.x.size(), 0);
    for (std::size_t t = 0; t < drawn.triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i = at(drawn.triangles[t][k]);
        if (known[i] != 0) continue;  // a seam: its first panel says where it is
        known[i] = 1;
        const PanelDrawing::Place place = panels[at(drawn.panel[t])]->find(drawn.uv[t][k]);
        if (place.distance_m > farthest_drawing_m)
          throw InputError(printable(obj), "panel " + printable(drawn.panel_names[at(drawn.panel[t])]),
                           "the drawing of this scene's pattern",
                           fmt::sprintf("another: a point is %.3g m outside it", place.distance_m));
        for (std::size_t c = 0; c < 3; ++c)
          garment.x[i] += place.barycentric[static_cast<Eigen::Index>(c)] * x[at(run.triangles[place.triangle][c])];
      }
    }
    put_behind(outfit, garment, one.fabrics, one.rest_stretch);
  }
  return outfit;
}

}  // namespace toile::internal
