// sim/load_scene.cpp: reads all files that a scene names.
#include "core/stopwatch.hpp"
#include "sim/setup.hpp"
#include "sim/start_run.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace toile::internal {

namespace {

// Cloth that is modelled on a body has its axes, and is not turned with it.
SceneCollider as_cloth_lies(SceneCollider body, std::span<const SceneCloth> cloth) {
  SceneMesh* const mesh = std::get_if<SceneMesh>(&body.shape);
  const bool sewn = std::all_of(cloth.begin(), cloth.end(), [](const SceneCloth& one) { return one.is_sewn(); });
  if (mesh != nullptr && mesh->up == UpAxis::automatic && !sewn) mesh->up = UpAxis::y;
  return body;
}

}  // namespace

LoadedScene load_scene(const Scene& scene, const TextSource& read) {
  LoadedScene loaded;
  {
    const Timed timed(loaded.cloth_s);
    for (std::size_t k = 0; k < scene.cloth.size(); ++k) loaded.cloth.push_back(load_cloth(scene, k, read));
  }
  const Timed timed(loaded.body_s);
  loaded.colliders = load_colliders(as_cloth_lies(scene.body, scene.cloth), scene.solids);
  if (!scene.start.empty()) {
    loaded.start_hash = hash_of_start(scene.start);
    loaded.start = start_from(scene.start, loaded.cloth, loaded.colliders.joined.surface.positions);
  }
  return loaded;
}

}  // namespace toile::internal
