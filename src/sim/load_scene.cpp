// sim/load_scene.cpp: reads all files that a scene names.
#include "core/stopwatch.hpp"
#include "sim/setup.hpp"
#include "sim/start_run.hpp"

namespace toile::internal {

LoadedScene load_scene(const Scene& scene, const TextSource& read) {
  LoadedScene loaded;
  {
    const Timed timed(loaded.cloth_s);
    for (std::size_t k = 0; k < scene.cloth.size(); ++k) loaded.cloth.push_back(load_cloth(scene, k, read));
  }
  const Timed timed(loaded.body_s);
  loaded.colliders = load_colliders(scene.body, scene.solids);
  if (!scene.start.empty()) {
    loaded.start_hash = hash_of_start(scene.start);
    loaded.start = start_from(scene.start, loaded.cloth, loaded.colliders.joined.surface.positions);
  }
  return loaded;
}

}  // namespace toile::internal
