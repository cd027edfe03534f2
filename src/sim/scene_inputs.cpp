#include "sim/scene_inputs.hpp"

namespace toile {

std::vector<std::string> input_paths(const Scene& scene) {
  std::vector<std::string> paths;
  const auto add = [&](const std::string& path) {
    if (!path.empty()) paths.push_back(path);
  };
  for (const SceneCloth& cloth : scene.cloth) add(cloth.pattern);
  add(scene.body.mesh);
  if (scene.body.motion) add(scene.body.motion->path);
  for (const SceneSolid& solid : scene.solids)
    if (const auto* mesh = std::get_if<SceneSolid::Mesh>(&solid.shape)) add(mesh->path);
  add(scene.start);
  return paths;
}

}  // namespace toile
