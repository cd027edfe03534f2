#include "body_option.hpp"

#include "core/error.hpp"

namespace toile::internal {

SceneBody body_option(const CommandLine& line) {
  SceneBody body;
  if (line.body == "mannequin" || line.body == "woman" || line.body == "dancer" || line.body == "man") {
    body.kind = SceneBody::Kind::mannequin;
    if (line.body != "mannequin") body.mannequin = mannequin_kind(line.body);
    if (!line.measurements.empty())
      throw Error(ExitCode::usage, "--measurements: expected a body from a file, got " + line.body);
    return body;
  }
  body.kind = SceneBody::Kind::mesh;
  body.mesh = line.body;
  body.measurements = line.measurements;
  if (line.body_unit == "m") body.unit = LengthUnit::m;
  if (line.body_unit == "dm") body.unit = LengthUnit::dm;
  if (line.body_unit == "cm") body.unit = LengthUnit::cm;
  return body;
}

}  // namespace toile::internal
