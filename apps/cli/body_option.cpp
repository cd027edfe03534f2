#include "body_option.hpp"

namespace toile {

SceneBody body_option(const CommandLine& line) {
  SceneBody body;
  if (line.body == "mannequin" || line.body == "woman" || line.body == "dancer" || line.body == "man") {
    body.kind = SceneBody::Kind::mannequin;
    if (line.body != "mannequin") body.mannequin = mannequin_kind(line.body);
    return body;
  }
  body.kind = SceneBody::Kind::mesh;
  body.mesh = line.body;
  if (line.body_unit == "m") body.unit = LengthUnit::m;
  if (line.body_unit == "dm") body.unit = LengthUnit::dm;
  if (line.body_unit == "cm") body.unit = LengthUnit::cm;
  return body;
}

}  // namespace toile
