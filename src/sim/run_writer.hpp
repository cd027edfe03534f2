// sim/run_writer.hpp: the files of a run, committed frame by frame.                                   docs/reports.md
//
//   sewing.obj, sewing.pc2   panels unwelded, while they are sewn
//   cloth.obj, cloth.pc2     the welded garment, frame 0 first
//   body.obj, body.pc2       one sample per frame of cloth.pc2
//   offenders.obj            the offenders of a collapsed step (sim/offenders.hpp)
//   report.json              last: a directory without it is not a finished run.  It lists the files, with a checksum of every frame
//
// Easily missed: files of an earlier run with these names are removed when the run begins, its report first, so that a run that
// dies leaves no folder that looks finished (io/run_folder.hpp).
//
// vt are the panel's own drawing coordinates: vt = (-v, u), because u = y of the drawing is the warp and v = -x the weft
// (garment/garment_mesh.hpp).  A reader that calls the first vt axis "u" sees the weft there.
#pragma once
#include "io/pc2.hpp"
#include "io/run_folder.hpp"
#include "io/surface_mesh.hpp"
#include "mesh/cloth_mesh.hpp"
#include "sim/report.hpp"

#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace toile::internal {

// The frames in the caches: where a resumed run goes on.
struct WrittenFrames {
  int sewing = 0, cloth = 0;
  bool has_body = false;
  template <class Archive>
  void remember(Archive& archive) {
    archive(sewing, cloth, has_body);
  }
};

class RunWriter {
 public:
  // Clears the folder of an earlier run.  The folder must outlive the writer.
  explicit RunWriter(RunFolder& folder);

  // `body`: the person around whom it is sewn; empty: as in begin_cloth.
  void begin_sewing(const ClothMesh& mesh, std::string_view garment, std::span<const Vec3> x,
                    std::span<const Triangle> body, std::span<const Vec3> body_x);
  void sewing_frame(std::span<const Vec3> x);
  // Writes `x` and `body_x` as frame 0.  Without a body its spans are empty and it gets no files.
  // `garment_of_panel`: [panel] an index of `garments`; each becomes an object of cloth.obj.
  void begin_cloth(const ClothMesh& mesh, std::span<const Index> garment_of_panel,
                   std::span<const std::string> garments, std::span<const Vec3> x, std::span<const Triangle> body,
                   std::span<const Vec3> body_x);
  void cloth_frame(std::span<const Vec3> x, std::span<const Vec3> body_x);
  void offenders(const SurfaceMesh& mesh);

  // Appends to the caches of an earlier run; frames after these are written anew.  Throws IoError, InputError when the caches have fewer.
  RunWriter(RunFolder& folder, const WrittenFrames& frames, Index sewing_points, Index cloth_points, Index body_points);
  WrittenFrames frames() const;
  // The frames are on the disk afterwards.  May be called while another thread appends.
  void synchronize() const;

  // "files" of the report, then the report.  `goes_on`: the run was stopped, and can be resumed.
  void finish(const std::function<std::string(const std::vector<WrittenFile>&)>& report_json, bool goes_on);

  int cloth_frames() const { return cloth_ ? cloth_->samples() : 0; }
  int sewing_frames() const { return sewing_ ? sewing_->samples() : 0; }
  std::string path(std::string_view name) const { return folder_->path(name); }

 private:
  RunFolder* folder_;
  std::unique_ptr<Pc2Writer> sewing_, cloth_, body_;
};

// The cloth as in cloth.obj, which the audit also reads: vt in place of (u, v).
ClothMesh drawn_mesh(const ClothMesh& mesh);

}  // namespace toile::internal
