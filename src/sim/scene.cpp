// sim/scene.cpp: reads a scene.  Its keys are described in sim/settings_scene.hpp.
#include "sim/scene.hpp"

#include "io/file.hpp"
#include "sim/scene_reader.hpp"
#include "sim/settings_scene.hpp"

#include <filesystem>

namespace toile::internal {
namespace {

bool is_given(const Json& scene, std::string_view group, std::string_view key) {
  const Json* members = scene.find(group);
  return members != nullptr && members->find(key) != nullptr;
}

}  // namespace

void settle(const Json& value, Scene& scene) {
  if (scene.name.empty()) value.at("name").fail("a name", "an empty string");
  const Json& cloth = value.at("cloth");
  for (std::size_t k = 0; k < scene.cloth.size(); ++k) {
    if (scene.cloth[k].is_sewn() != scene.cloth.front().is_sewn())
      cloth.array()[k].fail("only patterns, or no pattern, in one scene", "the other kind");
    for (std::size_t j = 0; j < k; ++j)
      if (!scene.cloth[k].name.empty() && scene.cloth[j].name == scene.cloth[k].name)
        cloth.array()[k].fail("a name that no other cloth has", '"' + printable(scene.cloth[k].name) + '"');
  }
  for (std::size_t k = 0; k < scene.cloth.size() && !scene.body.exists() && scene.solids.empty(); ++k)
    for (std::size_t p = 0; p < scene.cloth[k].pins.size(); ++p)
      if (scene.cloth[k].pins[p].hold == ScenePin::Hold::body)
        cloth.array()[k].at("pins").array()[p].at("hold").fail("a body or a solid in the scene",
                                                               "\"body\" without one");
  const bool sewn = scene.cloth.front().is_sewn();
  if (!is_given(value, "time", "until_still")) scene.until_still = sewn;
  if (!is_given(value, "time", "drape_seconds") && !sewn && !scene.body.motion) scene.drape_seconds = 0;
}

double Scene::solver_tolerance() const { return tolerance.value_or(usual_tolerance(preconditioner, procedure)); }

SceneFile read_scene(std::string_view text, const std::string& file) {
  SceneFile read;
  read.scene.name = std::filesystem::path(file).stem().string();
  const Json root = Json::parse(text, file);
  scene_reading::SceneReader::read(root, {file, read.places}, read.scene);
  if (is_given(root, "output", "dir")) read.places.add(root.at("output").at("dir"));
  return read;
}

Scene parse_scene(std::string_view text, const std::string& file) { return read_scene(text, file).scene; }

std::string read_text_file(const std::string& path) { return read_file(path, Json::text_limit); }

}  // namespace toile::internal
