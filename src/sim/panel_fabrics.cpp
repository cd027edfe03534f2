#include "sim/panel_fabrics.hpp"

#include "core/error.hpp"
#include "io/file.hpp"
#include "io/json.hpp"
#include "io/mesh_writer.hpp"

#include <filesystem>
#include <map>
#include <utility>
#include <vector>

namespace toile::internal {
namespace {

namespace fs = std::filesystem;

// The fabrics by garment and panel, where the report lists them.
std::map<std::pair<std::string, std::string>, std::string> fabrics_of(const fs::path& directory) {
  std::map<std::pair<std::string, std::string>, std::string> fabrics;
  const std::string path = (directory / "report.json").string();
  if (!fs::exists(path)) return fabrics;
  const Json report = Json::parse(read_file(path, Json::text_limit), printable(path));
  const Json* const known = report.find("fabrics");
  if (known == nullptr) return fabrics;
  for (const Json& panel : known->array())
    fabrics.try_emplace({name_on_one_line(panel.at("garment").string()), name_on_one_line(panel.at("panel").string())},
                        panel.at("fabric").string());
  return fabrics;
}

}  // namespace

void settle_groups(SurfaceMesh& mesh, const std::string& directory) {
  if (mesh.group.empty() || mesh.object.empty()) return;
  const auto fabrics = fabrics_of(directory);
  std::map<std::pair<Index, Index>, Index> numbers;
  std::vector<std::string> names;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::pair<Index, Index> panel(mesh.object[t], mesh.group[t]);
    const auto [place, is_new] = numbers.try_emplace(panel, static_cast<Index>(names.size()));
    if (is_new) {
      const std::string &garment = mesh.object_names[at(panel.first)], &name = mesh.group_names[at(panel.second)];
      const auto fabric = fabrics.find({garment, name});
      names.push_back(name);
      mesh.group_material.push_back(fabric == fabrics.end() ? std::string() : fabric->second);
    }
    mesh.group[t] = place->second;
  }
  mesh.group_names = std::move(names);
}

}  // namespace toile::internal
