#include "io/makehuman.hpp"

#include "core/error.hpp"
#include "io/json.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>

namespace toile::internal {
namespace {

constexpr double weights_agree = 1e-2;  // of a vertex' weights
constexpr double farthest_shift = 1e6;  // of a target's shift
constexpr std::size_t most_bones = 10'000;

// The bones of a rig; newer files have them under a key.
const Json& bones_in(const Json& rig) {
  const Json* const bones = rig.find("bones");
  return bones != nullptr && bones->is_object() && bones->find("head") == nullptr ? *bones : rig;
}

class RigReader {
 public:
  RigReader(const SurfaceMesh& mesh, const Json& rig) : mesh_(&mesh), bones_(&bones_in(rig)) {}

  void read(std::string_view file, Figure& figure) {
    const Json::Object& bones = bones_->object();
    if (bones.empty() || bones.size() > most_bones)
      bones_->fail("1 to " + std::to_string(most_bones) + " bones", std::to_string(bones.size()));
    for (const auto& [name, bone] : bones) {
      number_.emplace(name, static_cast<Index>(figure.nodes.size()));
      figure.nodes.push_back({name});
      heads_.push_back(place_of(bone.at("head")));
    }
    for (std::size_t i = 0; i < bones.size(); ++i) figure.nodes[i].parent = parent_of(bones[i].second);
    figure.order = parents_first(figure.nodes, file);
    for (std::size_t i = 0; i < bones.size(); ++i) {
      const Index parent = figure.nodes[i].parent;
      NodePose pose;
      pose.translation = heads_[i] - (parent < 0 ? Vec3(0, 0, 0) : heads_[at(parent)]);
      figure.rest.nodes.push_back(pose);
    }
  }

  // -1: no bone of this name.
  Index bone(const std::string& name) const {
    const auto found = number_.find(name);
    return found == number_.end() ? -1 : found->second;
  }
  const std::vector<Vec3>& heads() const { return heads_; }

 private:
  Index parent_of(const Json& bone) const {
    const Json* const parent = bone.find("parent");
    if (parent == nullptr || parent->is_null() || parent->string().empty()) return -1;
    const Index found = this->bone(parent->string());
    if (found < 0) parent->fail("a bone of this rig", '"' + printable(parent->string()) + '"');
    return found;
  }

  Vec3 vertex(const Json& number) const {
    const long long i = number.integer();
    if (i < 0 || static_cast<std::size_t>(i) >= mesh_->positions.size())
      number.fail("a vertex below " + std::to_string(mesh_->positions.size()), std::to_string(i));
    return mesh_->positions[static_cast<std::size_t>(i)];
  }

  Vec3 place_of(const Json& end) {
    const Json& strategy = end.at("strategy");
    if (strategy.string() == "CUBE") return middle_of_group(end.at("cube_name"));
    if (strategy.string() == "VERTEX") return vertex(end.at("vertex_index"));
    if (strategy.string() != "MEAN") strategy.fail("CUBE, MEAN or VERTEX", strategy.describe());
    const Json& vertices = end.at("vertex_indices");
    Vec3 sum = Vec3::Zero();
    for (const Json& number : vertices.array()) sum += vertex(number);
    if (vertices.array().empty()) vertices.fail("at least one vertex", "none");
    return sum / static_cast<double>(vertices.array().size());
  }

  Vec3 middle_of_group(const Json& name) {
    if (middles_.empty()) find_middles();
    const auto found = middles_.find(name.string());
    if (found == middles_.end()) name.fail("a group of the mesh", '"' + printable(name.string()) + '"');
    return found->second;
  }

  void find_middles() {
    std::vector<std::vector<Index>> vertices(mesh_->group_names.size());
    for (std::size_t t = 0; t < mesh_->triangles.size(); ++t)
      for (const Index v : mesh_->triangles[t]) vertices[at(mesh_->group[t])].push_back(v);
    for (std::size_t g = 0; g < vertices.size(); ++g) {
      std::vector<Index>& own = vertices[g];
      std::sort(own.begin(), own.end());
      own.erase(std::unique(own.begin(), own.end()), own.end());
      Vec3 sum = Vec3::Zero();
      for (const Index v : own) sum += mesh_->positions[at(v)];
      if (!own.empty()) middles_.emplace(mesh_->group_names[g], sum / static_cast<double>(own.size()));
    }
  }

  const SurfaceMesh* mesh_;
  const Json* bones_;
  std::map<std::string, Index> number_;
  std::map<std::string, Vec3> middles_;
  std::vector<Vec3> heads_;
};

// [vertex] its bones and weights, as in the file.
std::vector<std::vector<Influence>> read_weights(const Json& file, const RigReader& rig, std::size_t vertices) {
  std::vector<std::vector<Influence>> of(vertices);
  for (const auto& [name, pairs] : file.at("weights").object()) {
    const Index bone = rig.bone(name);
    if (bone < 0 && !pairs.array().empty()) pairs.fail("a bone of the rig", '"' + printable(name) + '"');
    for (const Json& pair : pairs.array()) {
      if (!pair.is_array() || pair.array().size() != 2) pair.fail("a vertex and a weight", pair.describe());
      const long long vertex = pair.array()[0].integer();
      const double weight = pair.array()[1].number();
      if (vertex < 0 || static_cast<std::size_t>(vertex) >= vertices)
        pair.fail("a vertex below " + std::to_string(vertices), std::to_string(vertex));
      if (!(weight >= 0 && weight <= farthest_shift)) pair.fail("a weight of 0 or more", pair.array()[1].describe());
      if (weight > 0) of[static_cast<std::size_t>(vertex)].push_back({bone, weight});
    }
  }
  return of;
}

void add_weights(const std::vector<std::vector<Influence>>& of, Index first_bone, std::string_view file, Figure& figure,
                 std::vector<std::string>& notes) {
  std::size_t divided = 0;
  figure.first_influence.push_back(0);
  for (const std::vector<Influence>& own : of) {
    double sum = 0;
    for (const Influence& one : own) sum += one.weight;
    if (own.empty()) figure.influences.push_back({first_bone, 1});
    if (!own.empty() && std::abs(sum - 1) > weights_agree) ++divided;
    for (const Influence& one : own) figure.influences.push_back({one.joint, one.weight / sum});
    figure.first_influence.push_back(figure.influences.size());
  }
  if (divided > 0)
    notes.push_back(std::string(file) + ": the weights of " + std::to_string(divided) +
                    " vertices do not sum to 1, and are divided by their sum");
}

}  // namespace

void apply_target(std::string_view text, std::string_view file, double share, SurfaceMesh& mesh) {
  int line_number = 0;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    ++line_number;
    line = line.substr(0, line.find('#'));
    const auto skip = [&] { line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size())); };
    const auto fail = [&](std::string_view expected) {
      throw InputError(std::string(file) + ':' + std::to_string(line_number), "", expected,
                       line.empty() ? std::string("the end of the line") : '"' + printable(line.substr(0, 40)) + '"');
    };
    skip();
    if (line.empty()) continue;
    std::size_t vertex = 0;
    const auto [after, error] = std::from_chars(line.data(), line.data() + line.size(), vertex);
    if (error != std::errc() || vertex >= mesh.positions.size())
      fail("a vertex below " + std::to_string(mesh.positions.size()));
    line.remove_prefix(static_cast<std::size_t>(after - line.data()));
    Vec3 shift;
    for (Eigen::Index k = 0; k < 3; ++k) {
      skip();
      const auto [stop, wrong] = std::from_chars(line.data(), line.data() + line.size(), shift[k]);
      if (wrong != std::errc() || !(std::abs(shift[k]) <= farthest_shift)) fail("three numbers after the vertex");
      line.remove_prefix(static_cast<std::size_t>(stop - line.data()));
    }
    skip();
    if (!line.empty()) fail("the end of the line");
    mesh.positions[vertex] += share * shift;
  }
}

void put_on_floor(SurfaceMesh& mesh) {
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.group_names[at(mesh.group[t])] != "body") continue;
    for (const Index v : mesh.triangles[t]) lowest = std::min(lowest, mesh.positions[at(v)].y());
  }
  if (!std::isfinite(lowest)) return;
  for (Vec3& x : mesh.positions) x.y() -= lowest;
}

Figure makehuman_figure(const SurfaceMesh& mesh, const TextOfFile& rig_text, const TextOfFile& weights_text,
                        std::vector<std::string>& notes) {
  const Json rig = Json::parse(rig_text.text, rig_text.file);
  const Json weights = Json::parse(weights_text.text, weights_text.file);
  Figure figure;
  RigReader reader(mesh, rig);
  reader.read(rig_text.file, figure);
  FigureSkin skin;
  for (std::size_t i = 0; i < figure.nodes.size(); ++i) {
    skin.joints.push_back(static_cast<Index>(i));
    Affine to_joint;
    to_joint << Mat3::Identity(), -reader.heads()[i];
    skin.to_joint.push_back(to_joint);
  }
  figure.skins.push_back(std::move(skin));
  figure.modelled = mesh.positions;
  figure.parts.push_back({figure.order.front(), 0, 0, mesh.positions.size()});
  add_weights(read_weights(weights, reader, mesh.positions.size()), figure.order.front(), weights_text.file, figure,
              notes);
  return figure;
}

std::string weights_beside(const std::string& rig) {
  const std::filesystem::path path(rig);
  const std::string name = path.filename().string();
  constexpr std::string_view start = "rig.";
  if (!name.starts_with(start)) return {};
  return (path.parent_path() / ("weights." + name.substr(start.size()))).string();
}

}  // namespace toile::internal
