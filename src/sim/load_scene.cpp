// sim/load_scene.cpp: all that a scene names, from its files.
#include "core/stopwatch.hpp"
#include "sim/setup.hpp"
#include "sim/start_run.hpp"

namespace toile::internal {

LoadedScene load_scene(const Scene& scene, const TextSource& read, Hash& inputs) {
  LoadedScene loaded;
  {
    const Timed timed(loaded.cloth_s);
    for (const SceneCloth& cloth : scene.cloth) loaded.cloth.push_back(load_cloth(scene, cloth, read, inputs));
  }
  const Timed timed(loaded.body_s);
  loaded.body = load_body(scene.body, inputs);
  loaded.person_vertices = loaded.body.solid.positions.size();
  loaded.person_triangles = loaded.body.solid.triangles.size();
  add_solids(scene.solids, loaded.body, inputs);
  if (!scene.start.empty()) {
    add_start(scene.start, inputs);
    loaded.start = start_from(scene.start, loaded.cloth, loaded.body.solid.positions);
  }
  return loaded;
}

}  // namespace toile::internal
