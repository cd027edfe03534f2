#include "sim/offenders.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <limits>
#include <map>

namespace toile::internal {
namespace {

// Copies triangles with the vertices that they use.
class Copy {
 public:
  Copy(SurfaceMesh& to, std::span<const Vec3> x) : to_(&to), x_(x), vertex_(x.size(), -1) {}

  void add(const Triangle& triangle, Index group, Index object) {
    Triangle copied{};
    for (std::size_t k = 0; k < 3; ++k) {
      Index& vertex = vertex_[at(triangle[k])];
      if (vertex < 0) {
        vertex = static_cast<Index>(to_->positions.size());
        to_->positions.push_back(x_[at(triangle[k])]);
      }
      copied[k] = vertex;
    }
    to_->triangles.push_back(copied);
    to_->group.push_back(group);
    to_->object.push_back(object);
  }

 private:
  SurfaceMesh* to_;
  std::span<const Vec3> x_;
  std::vector<Index> vertex_;
};

bool finite(const Triangle& triangle, std::span<const Vec3> x) {
  return std::all_of(triangle.begin(), triangle.end(), [&](Index i) { return x[at(i)].allFinite(); });
}

}  // namespace

std::string name_triangles(const ClothMesh& mesh, std::span<const Index> triangles) {
  constexpr std::size_t most_numbers = 8;
  std::map<Index, std::vector<Index>> of_panel;
  for (const Index t : triangles) of_panel[mesh.panel[at(t)]].push_back(t);
  std::string words;
  for (const auto& [panel, members] : of_panel) {
    words += (words.empty() ? "" : ", ") + std::to_string(members.size());
    if (&members == &of_panel.begin()->second) words += members.size() == 1 ? " triangle" : " triangles";
    words += " of " + printable(mesh.panel_names[at(panel)]) + " (";
    for (std::size_t k = 0; k < std::min(members.size(), most_numbers); ++k)
      words += (k > 0 ? ", " : "") + std::to_string(members[k]);
    words += members.size() > most_numbers ? ", ...)" : ")";
  }
  return words;
}

SurfaceMesh offenders_obj(const ClothMesh& mesh, std::span<const Vec3> x, std::span<const Index> triangles,
                          std::span<const Triangle> body, std::span<const Vec3> body_x, double near_m) {
  SurfaceMesh obj;
  obj.object_names = {"cloth", "body"};
  obj.group_names = mesh.panel_names;
  obj.group_names.emplace_back("body");
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  Copy cloth(obj, x);
  for (const Index t : triangles) {
    const Triangle& triangle = mesh.triangles[at(t)];
    if (!finite(triangle, x)) continue;
    cloth.add(triangle, mesh.panel[at(t)], 0);
    for (const Index i : triangle) {
      low = low.cwiseMin(x[at(i)]);
      high = high.cwiseMax(x[at(i)]);
    }
  }
  Copy solid(obj, body_x);
  const auto body_group = static_cast<Index>(mesh.panel_names.size());
  for (const Triangle& triangle : body) {
    Vec3 least = body_x[at(triangle[0])], most = least;
    for (const Index i : triangle) {
      least = least.cwiseMin(body_x[at(i)]);
      most = most.cwiseMax(body_x[at(i)]);
    }
    const bool near = ((least.array() - near_m <= high.array()) && (low.array() <= most.array() + near_m)).all();
    if (near && finite(triangle, body_x)) solid.add(triangle, body_group, 1);
  }
  return obj;
}

}  // namespace toile::internal
