#include "sim/run_writer.hpp"

#include "core/error.hpp"
#include "io/obj.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

namespace toile {
namespace {

// Equal vt of one panel are one vt: a seam has one per panel, everything else one per particle.
ObjMesh cloth_obj(const ClothMesh& mesh, std::span<const Index> garment_of_panel, std::span<const std::string> garments,
                  std::span<const Vec3> x) {
  ObjMesh obj;
  obj.positions.assign(x.begin(), x.end());
  obj.triangles = mesh.triangles;
  obj.group = mesh.panel;
  obj.group_names = mesh.panel_names;
  for (const Index panel : mesh.panel) obj.object.push_back(garment_of_panel[static_cast<std::size_t>(panel)]);
  obj.object_names.assign(garments.begin(), garments.end());
  const ClothMesh drawn = drawn_mesh(mesh);
  std::map<std::tuple<Index, Index, double, double>, Index> known;  // panel, particle, vt
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<Index, 3> corner{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2& vt = drawn.uv[t][k];
      const auto next = static_cast<Index>(obj.texcoords.size());
      const auto [place, added] = known.try_emplace({mesh.panel[t], mesh.triangles[t][k], vt.x(), vt.y()}, next);
      if (added) obj.texcoords.push_back(vt);
      corner[k] = place->second;
    }
    obj.texcoord.push_back(corner);
  }
  return obj;
}

}  // namespace

ClothMesh drawn_mesh(const ClothMesh& mesh) {
  ClothMesh drawn = mesh;
  for (auto& corners : drawn.uv)
    for (Vec2& uv : corners) uv = Vec2(0.0 - uv.y(), uv.x());  // 0 - v: no -0 in the file
  return drawn;
}

RunWriter::RunWriter(std::string directory) : directory_(std::move(directory)) {
  make_directories(directory_);
  // The report first: from here on the directory is no finished run.
  for (const char* name : {"report.json", "cloth.obj", "cloth.pc2", "body.obj", "body.pc2", "sewing.obj", "sewing.pc2",
                           "preview.png", "preview.mp4", "frames.png", "offenders.obj"}) {
    std::error_code error;
    std::filesystem::remove(path(name), error);
    if (error) throw IoError(path(name), "cannot remove what an earlier run left: " + error.message());
  }
  const AtomicFile probe(path("report.json"));  // not committed: leaves nothing, but fails now if it must fail
}

std::string RunWriter::path(const char* name) const { return (std::filesystem::path(directory_) / name).string(); }

void RunWriter::begin_sewing(const ClothMesh& mesh, std::string_view garment, std::span<const Vec3> x) {
  const std::vector<Index> one(mesh.panel_names.size(), 0);
  const std::string name(garment);
  write_obj(path("sewing.obj"), cloth_obj(mesh, one, {&name, 1}, x));
  sewing_ = std::make_unique<Pc2Writer>(path("sewing.pc2"), mesh.particle_count, 0, 1);
  sewing_frame(x);
}

void RunWriter::sewing_frame(std::span<const Vec3> x) { sewing_->append(x); }

void RunWriter::begin_cloth(const ClothMesh& mesh, std::span<const Index> garment_of_panel,
                            std::span<const std::string> garments, std::span<const Vec3> x,
                            std::span<const Triangle> body, std::span<const Vec3> body_x) {
  write_obj(path("cloth.obj"), cloth_obj(mesh, garment_of_panel, garments, x));
  cloth_ = std::make_unique<Pc2Writer>(path("cloth.pc2"), mesh.particle_count, 0, 1);
  if (!body.empty()) {
    ObjMesh obj;
    obj.positions.assign(body_x.begin(), body_x.end());
    obj.triangles.assign(body.begin(), body.end());
    obj.object.assign(body.size(), 0);
    obj.object_names = {"body"};
    write_obj(path("body.obj"), obj);
    body_ = std::make_unique<Pc2Writer>(path("body.pc2"), static_cast<Index>(body_x.size()), 0, 1);
  }
  cloth_frame(x, body_x);
}

void RunWriter::cloth_frame(std::span<const Vec3> x, std::span<const Vec3> body_x) {
  cloth_->append(x);
  if (body_) body_->append(body_x);
}

void RunWriter::finish(std::string_view report_json) {
  for (const auto& writer : {&sewing_, &body_, &cloth_})
    if (*writer) (*writer)->commit();
  AtomicFile report(path("report.json"));
  report.write(report_json);
  report.write("\n");
  report.commit();
}

}  // namespace toile
