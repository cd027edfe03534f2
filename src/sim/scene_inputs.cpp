#include "sim/scene_inputs.hpp"

#include "body/body_samples.hpp"
#include "io/file.hpp"
#include "io/mesh_file.hpp"
#include "sim/body_figure.hpp"
#include "sim/setup.hpp"

#include <filesystem>
#include <set>

namespace toile::internal {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> files_among(std::span<const std::string> paths) {
  std::vector<std::string> files;
  for (const std::string& path : paths) {
    const fs::path place(path);
    if (fs::is_regular_file(place)) {
      const std::vector<std::string> parts = has_mesh_ending(path) ? files_of_mesh(path) : std::vector{path};
      files.insert(files.end(), parts.begin(), parts.end());
    } else if (fs::exists(place / "report.json")) {
      for (const char* name : {"report.json", "cloth.obj", "cloth.pc2", "body.obj", "body.pc2"})
        if (fs::is_regular_file(place / name)) files.push_back((place / name).string());
    } else if (fs::is_directory(place) || place.filename().string().find('%') != std::string::npos) {
      for (const NumberedFile& frame : numbered_files(path)) files.push_back(frame.path);
    }
  }
  return files;
}

}  // namespace

std::vector<std::string> input_paths(const Scene& scene) {
  std::vector<std::string> paths;
  const auto add = [&](const std::string& path) {
    if (!path.empty()) paths.push_back(path);
  };
  for (const SceneCloth& cloth : scene.cloth) add(std::string(cloth.path()));
  const auto add_collider = [&](const SceneCollider& collider) {
    const SceneMesh* const mesh = collider.as<SceneMesh>();
    if (mesh != nullptr) add(mesh->path);
    if (mesh != nullptr && collider.worn) add(measurements_path(*mesh));
    if (mesh != nullptr) {
      for (const std::string& path : rig_paths(*mesh)) add(path);
      for (const SceneTarget& target : mesh->targets) add(target.path);
    }
    if (collider.motion) add(collider.motion->path);
    if (collider.motion) add(collider.motion->bones);
  };
  add_collider(scene.body);
  for (const SceneCollider& solid : scene.solids) add_collider(solid);
  add(scene.start);
  return paths;
}

std::vector<InputFile> checksums_of_inputs(std::span<const std::string> paths, const std::string& directory) {
  const fs::path from = fs::absolute(directory).lexically_normal();
  std::set<std::string> known;
  std::vector<InputFile> inputs;
  for (const std::string& file : files_among(paths)) {
    const std::string seen = fs::absolute(file).lexically_proximate(from).generic_string();
    if (known.insert(seen).second) inputs.push_back({seen, checksum_of_file(file)});
  }
  return inputs;
}

}  // namespace toile::internal
