#include "body_option.hpp"

#include "core/error.hpp"

namespace toile::internal {

LengthUnit unit_option(const CommandLine& line) {
  for (const auto& [name, unit] : length_units)
    if (name == line.body_unit) return unit;
  return LengthUnit::automatic;
}

UpAxis up_option(const CommandLine& line) {
  for (const auto& [name, up] : up_axes)
    if (name == line.body_up) return up;
  return UpAxis::automatic;
}

SceneCollider body_option(const CommandLine& line) {
  SceneCollider body;
  body.worn = true;
  if (line.body == "mannequin" || line.body == "woman" || line.body == "dancer" || line.body == "man") {
    SceneMannequin mannequin;
    if (line.body != "mannequin") mannequin.who = mannequin_kind(line.body);
    body.shape = mannequin;
    if (!line.measurements.empty())
      throw Error(ErrorKind::usage, "--measurements: expected a body from a file, got " + line.body);
    return body;
  }
  SceneMesh mesh;
  mesh.path = line.body;
  mesh.measurements = line.measurements;
  mesh.unit = unit_option(line);
  mesh.up = up_option(line);
  body.shape = std::move(mesh);
  return body;
}

}  // namespace toile::internal
