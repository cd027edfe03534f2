#include "sim/run_writer.hpp"

#include "core/hash.hpp"
#include "io/file.hpp"
#include "io/obj.hpp"

#include <filesystem>
#include <map>
#include <tuple>
#include <utility>

namespace toile::internal {
namespace {

// Equal vt of one panel are merged: a particle on a seam has one per panel, any other particle one.
SurfaceMesh cloth_obj(const ClothMesh& mesh, std::span<const Index> garment_of_panel,
                      std::span<const std::string> garments, std::span<const Vec3> x) {
  SurfaceMesh obj;
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

SurfaceMesh body_obj(std::span<const Triangle> triangles, std::span<const Vec3> x) {
  SurfaceMesh obj;
  obj.positions.assign(x.begin(), x.end());
  obj.triangles.assign(triangles.begin(), triangles.end());
  obj.object.assign(triangles.size(), 0);
  obj.object_names = {"body"};
  return obj;
}

}  // namespace

ClothMesh drawn_mesh(const ClothMesh& mesh) {
  ClothMesh drawn = mesh;
  for (auto& corners : drawn.uv)
    for (Vec2& uv : corners) uv = Vec2(0.0 - uv.y(), uv.x());  // 0 - v: no -0 in the file
  return drawn;
}

RunWriter::RunWriter(RunFolder& folder) : folder_(&folder) { folder_->begin(); }

RunWriter::RunWriter(RunFolder& folder, const WrittenFrames& frames, Index sewing_points, Index cloth_points,
                     Index body_points)
    : folder_(&folder) {
  remove_file(path("report.json"));  // the report of the stopped run
  if (frames.sewing > 0) sewing_ = Pc2Writer::resume(path("sewing.pc2"), sewing_points, frames.sewing);
  if (frames.cloth == 0) {  // frames after the saved state are simulated again
    for (const char* name : {"cloth.obj", "cloth.pc2", "body.obj", "body.pc2"}) remove_file(path(name));
    return;
  }
  cloth_ = Pc2Writer::resume(path("cloth.pc2"), cloth_points, frames.cloth);
  if (frames.has_body) body_ = Pc2Writer::resume(path("body.pc2"), body_points, frames.cloth);
}

WrittenFrames RunWriter::frames() const { return {sewing_frames(), cloth_frames(), body_ != nullptr}; }

void RunWriter::synchronize() const {
  for (const auto& writer : {&sewing_, &cloth_, &body_})
    if (*writer) (*writer)->synchronize();
}

void RunWriter::begin_sewing(const ClothMesh& mesh, std::string_view garment, std::span<const Vec3> x,
                             std::span<const Triangle> body, std::span<const Vec3> body_x) {
  if (!body.empty()) write_obj(path("sewing_body.obj"), body_obj(body, body_x));
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
  if (!body.empty()) {  // before the cloth: a cloth.pc2 implies a complete body
    write_obj(path("body.obj"), body_obj(body, body_x));
    body_ = std::make_unique<Pc2Writer>(path("body.pc2"), static_cast<Index>(body_x.size()), 0, 1);
  }
  write_obj(path("cloth.obj"), cloth_obj(mesh, garment_of_panel, garments, x));
  cloth_ = std::make_unique<Pc2Writer>(path("cloth.pc2"), mesh.particle_count, 0, 1);
  cloth_frame(x, body_x);
}

void RunWriter::cloth_frame(std::span<const Vec3> x, std::span<const Vec3> body_x) {
  if (body_) body_->append(body_x);
  cloth_->append(x);
}

void RunWriter::offenders(const SurfaceMesh& mesh) {
  remove_file(path("offenders.obj"));
  write_obj(path("offenders.obj"), mesh);
}

void RunWriter::finish(const std::function<std::string(const std::vector<WrittenFile>&)>& report_json, bool goes_on) {
  synchronize();
  std::vector<WrittenFile> files;
  const auto add_obj = [&](const char* name) {
    if (!std::filesystem::exists(path(name))) return;
    files.push_back({name, checksum_of_file(path(name)), {}});
  };
  const auto add_cache = [&](const char* name, const std::unique_ptr<Pc2Writer>& writer) {
    if (!writer) return;
    WrittenFile file{name, hex_of(writer->header_checksum()), {}};
    for (const std::uint64_t frame : writer->frame_checksums()) file.frames.push_back(hex_of(frame));
    files.push_back(std::move(file));
  };
  add_obj("sewing_body.obj");
  add_obj("sewing.obj");
  add_cache("sewing.pc2", sewing_);
  add_obj("cloth.obj");
  add_cache("cloth.pc2", cloth_);
  add_obj("body.obj");
  add_cache("body.pc2", body_);
  add_obj("offenders.obj");
  AtomicFile report(path("report.json"));
  report.write(sealed(report_json(files)));
  report.write("\n");
  report.commit();
  folder_->finish(goes_on);
}

}  // namespace toile::internal
