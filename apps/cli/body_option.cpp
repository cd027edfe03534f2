#include "body_option.hpp"

#include "core/error.hpp"

namespace toile::internal {

LengthUnit unit_option(const CommandLine& line) {
  if (line.body_unit == "m") return LengthUnit::m;
  if (line.body_unit == "dm") return LengthUnit::dm;
  if (line.body_unit == "cm") return LengthUnit::cm;
  return LengthUnit::automatic;
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
  body.shape = std::move(mesh);
  return body;
}

}  // namespace toile::internal
