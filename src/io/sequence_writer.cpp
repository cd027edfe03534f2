#include "io/sequence_writer.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "io/mdd.hpp"
#include "io/pc2.hpp"

namespace toile::internal {
namespace {

bool goes_on(const Sequence& sequence) { return !sequence.goes_on || sequence.goes_on(); }

const SurfaceSequence& only_surface(const std::string& path, const Sequence& sequence) {
  if (sequence.surfaces.size() != 1)
    throw InputError(printable(path), "surfaces", "one, as a point cache has",
                     std::to_string(sequence.surfaces.size()));
  return sequence.surfaces.front();
}

// Calls with the positions of each frame; false if it was stopped.
template <class F>
bool for_each_frame(const std::string& path, const Sequence& sequence, const F& f) {
  Vec3s x;
  for (int frame = 0; frame < sequence.frames; ++frame) {
    if (!goes_on(sequence)) return false;
    read_frame(path, sequence.surfaces.front(), frame, x);
    f(x);
  }
  return true;
}

bool write_pc2(const std::string& path, const Sequence& sequence) {
  const auto points = static_cast<Index>(only_surface(path, sequence).mesh->positions.size());
  AtomicFile file(path);
  file.write(pc2_header(points, 0, 1, sequence.frames));
  std::vector<float> numbers;
  const bool whole = for_each_frame(path, sequence, [&](const Vec3s& x) {
    numbers.clear();
    for (const Vec3& p : x)
      for (const double number : p) numbers.push_back(static_cast<float>(number));
    file.write(numbers.data(), numbers.size() * sizeof(float));
  });
  if (whole) file.commit();
  return whole;
}

bool write_mdd(const std::string& path, const Sequence& sequence) {
  MddWriter file(path, static_cast<Index>(only_surface(path, sequence).mesh->positions.size()), sequence.frames,
                 sequence.fps);
  const bool whole = for_each_frame(path, sequence, [&](const Vec3s& x) { file.append(x); });
  if (whole) file.commit();
  return whole;
}

}  // namespace

const std::vector<SequenceWriter>& sequence_writers() {
  static const std::vector<SequenceWriter> writers = {pc2_sequence_writer(), mdd_sequence_writer(),
                                                      usda_sequence_writer(), gltf_sequence_writer()};
  return writers;
}

const SequenceWriter* sequence_writer_named(std::string_view name) {
  for (const SequenceWriter& writer : sequence_writers())
    if (writer.name == name) return &writer;
  return nullptr;
}

const SequenceWriter* sequence_writer_for(std::string_view path) {
  for (const SequenceWriter& writer : sequence_writers())
    if (path.ends_with(writer.ending)) return &writer;
  return nullptr;
}

std::string sequence_writers_in_words() {
  std::vector<std::string> names;
  for (const SequenceWriter& writer : sequence_writers()) names.emplace_back(writer.name);
  return alternatives(names);
}

void read_frame(const std::string& path, const SurfaceSequence& surface, int frame, Vec3s& positions) {
  surface.read(frame, positions);
  const std::string place = surface.name + ", frame " + std::to_string(frame);
  if (positions.size() != surface.mesh->positions.size())
    throw InputError(printable(path), place, std::to_string(surface.mesh->positions.size()) + " positions",
                     std::to_string(positions.size()));
  for (std::size_t i = 0; i < positions.size(); ++i)
    for (const double number : positions[i])
      if (!std::isfinite(static_cast<float>(number)))
        throw InputError(printable(path), place + ", vertex " + std::to_string(i), "numbers that a float can hold",
                         std::to_string(number));
}

Vec3s normals_of(const SurfaceMesh& mesh, std::span<const Vec3> positions) {
  Vec3s normals(positions.size(), Vec3::Zero());
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = positions[at(t[0])];
    const Vec3 twice_area = (positions[at(t[1])] - a).cross(positions[at(t[2])] - a);
    for (const Index i : t) normals[at(i)] += twice_area;
  }
  for (Vec3& n : normals) {
    const double length = n.norm();
    n = length > 0 && std::isfinite(length) ? Vec3(n / length) : Vec3(0, 1, 0);
  }
  return normals;
}

SequenceWriter pc2_sequence_writer() { return {"pc2", ".pc2", false, write_pc2}; }
SequenceWriter mdd_sequence_writer() { return {"mdd", ".mdd", false, write_mdd}; }

}  // namespace toile::internal
