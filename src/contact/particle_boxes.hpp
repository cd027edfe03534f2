// contact/particle_boxes.hpp: bounding boxes of particles, edges and triangles on a straight motion.
//
// Easily got wrong: boxes relative to the mean have its motion taken out.  They tell which features of one mesh can
// meet, but not their place: never compare them with boxes of something else.
#pragma once
#include "contact/lane_boxes.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace toile::internal {

class ParticleBoxes {
 public:
  // Box i contains start[i], end[i] and all between, grown by `margin_m`.
  void set(std::span<const Vec3> start, std::span<const Vec3> end, double margin_m);
  // The same for particles whose moved[i] is not 0; the others stay as they are.
  void set(std::span<const Vec3> start, std::span<const Vec3> end, double margin_m,
           std::span<const std::uint8_t> moved);
  // Like the first, but relative to the mean motion of the particles: a falling or walking garment has small boxes.
  void set_seen_from_mean(std::span<const Vec3> start, std::span<const Vec3> end, double margin_m);
  // Grows box i by its own length.
  template <class Length>
  void grow(Length&& by_m) {
    for (std::size_t i = 0; i < boxes_.size(); ++i) boxes_[i].grow(by_m(i));
  }

  std::size_t size() const { return boxes_.size(); }
  const OuterBox& operator[](Index particle) const { return boxes_[static_cast<std::size_t>(particle)]; }
  OuterBox edge(Index a, Index b) const {
    OuterBox box = (*this)[a];
    box.include((*this)[b]);
    return box;
  }
  OuterBox triangle(const Triangle& corners) const {
    OuterBox box = edge(corners[0], corners[1]);
    box.include((*this)[corners[2]]);
    return box;
  }
  // Is every box within that of the same particle in `other`?
  bool within(const ParticleBoxes& other) const;

 private:
  void set(std::span<const Vec3> start, const Vec3& from, std::span<const Vec3> end, const Vec3& to, double margin_m);

  std::vector<OuterBox> boxes_;
};

}  // namespace toile::internal
