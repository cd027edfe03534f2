// sim/run_writer.hpp: the files of a run, frame by frame, complete or not at all.                    docs/reports.md
//
//   sewing.obj, sewing.pc2   panels unwelded, while they are sewn
//   cloth.obj, cloth.pc2     the welded garment, frame 0 first
//   body.obj, body.pc2       one sample per frame of cloth.pc2
//   offenders.obj            what a run ended over (sim/offenders.hpp); only of one whose step collapsed
//   report.json              last: a directory without it is not a finished run
//
// Easily missed: what an earlier run left under these names is removed at the start, its report first, so that a run that
// dies leaves nothing behind that looks finished.
//
// vt are the panel's own drawing coordinates: vt = (-v, u), because u = y of the drawing is the warp and v = -x the weft
// (garment/garment_mesh.hpp).  A reader that calls the first vt axis "u" sees the weft there.
#pragma once
#include "io/obj.hpp"
#include "io/pc2.hpp"
#include "mesh/cloth_mesh.hpp"

#include <memory>
#include <string>
#include <string_view>

namespace toile {

class RunWriter {
 public:
  // Makes the directory and clears it of an earlier run.  Throws IoError, before anything was simulated, when nothing can be
  // written there.
  explicit RunWriter(std::string directory);

  void begin_sewing(const ClothMesh& mesh, std::string_view garment, std::span<const Vec3> x);
  void sewing_frame(std::span<const Vec3> x);
  // `x` and `body_x` are frame 0, and written as such.  Without a body its spans are empty and it gets no files.
  // `garment_of_panel` says to which of `garments` a panel belongs; each becomes an object of cloth.obj.
  void begin_cloth(const ClothMesh& mesh, std::span<const Index> garment_of_panel,
                   std::span<const std::string> garments, std::span<const Vec3> x, std::span<const Triangle> body,
                   std::span<const Vec3> body_x);
  void cloth_frame(std::span<const Vec3> x, std::span<const Vec3> body_x);
  void offenders(const ObjMesh& mesh) { write_obj(path("offenders.obj"), mesh); }
  // Gives the streamed files their names, then writes the report.
  void finish(std::string_view report_json);

  int cloth_frames() const { return cloth_ ? cloth_->samples() : 0; }
  int sewing_frames() const { return sewing_ ? sewing_->samples() : 0; }
  const std::string& directory() const { return directory_; }

 private:
  std::string path(const char* name) const;

  std::string directory_;
  std::unique_ptr<Pc2Writer> sewing_, cloth_, body_;
};

// The cloth as it stands in cloth.obj: vt in place of (u, v).  What is audited, too.
ClothMesh drawn_mesh(const ClothMesh& mesh);

}  // namespace toile
