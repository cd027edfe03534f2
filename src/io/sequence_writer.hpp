// io/sequence_writer.hpp: all frames of surfaces in one file.                                                   docs/howto/export.md#one-file
//
// Numbers are rounded to float; the same frames give the same bytes.  A file appears under its name when it is complete (io/file.hpp).
#pragma once
#include "io/surface_mesh.hpp"

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

struct SurfaceSequence {
  std::string name;                                       // "cloth", "body"
  const SurfaceMesh* mesh = nullptr;                      // its positions are those of some frame
  std::function<void(int frame, Vec3s& positions)> read;  // m; as many as the mesh has, each time
};

struct Sequence {
  std::vector<SurfaceSequence> surfaces;
  int frames = 0;  // at least one
  double fps = 30;
  std::function<bool()> goes_on;  // polled for each frame that is read; false: nothing is written.  Empty: true
};

struct SequenceWriter {
  std::string_view name;    // "usda", as on the command line
  std::string_view ending;  // ".usda"
  bool several = false;     // surfaces in one file; others take exactly one
  // False if it was stopped.  Throws IoError, and InputError for a mesh that does not fit together, a number that no float can hold, and more than
  // the format can hold.
  bool (*write)(const std::string& path, const Sequence& sequence) = nullptr;
};

// pc2, mdd, usda, gltf
const std::vector<SequenceWriter>& sequence_writers();
// By name, or else by the extension of `path`; nullptr: none.
const SequenceWriter* sequence_writer_named(std::string_view name);
const SequenceWriter* sequence_writer_for(std::string_view path);
// "pc2, mdd, usda or gltf"
std::string sequence_writers_in_words();

// For writers.

// Reads a frame and checks it: throws InputError naming `path` and the frame for another count and for numbers that no float can hold.
void read_frame(const std::string& path, const SurfaceSequence& surface, int frame, Vec3s& positions);
// [vertex] normals of the surface, weighted by area; up for a vertex without triangles.
Vec3s normals_of(const SurfaceMesh& mesh, std::span<const Vec3> positions);

SequenceWriter pc2_sequence_writer();   // sequence_writer.cpp
SequenceWriter mdd_sequence_writer();   // sequence_writer.cpp
SequenceWriter usda_sequence_writer();  // usda_write.cpp
SequenceWriter gltf_sequence_writer();  // gltf_write.cpp

}  // namespace toile::internal
