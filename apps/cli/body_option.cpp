#include "body_option.hpp"

#include "core/error.hpp"

#include <charconv>
#include <cmath>
#include <utility>

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

namespace {

// "FILE" or "FILE=0.5".
SceneTarget target_option(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos) return {text, 1};
  double share = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + equals + 1, end, share);
  if (error != std::errc() || stop != end || !(std::abs(share) <= 10))
    throw Error(ErrorKind::usage,
                "--target: expected FILE or FILE=SHARE with a share of -10 to 10, got \"" + printable(text) + '"');
  return {text.substr(0, equals), share};
}

}  // namespace

SceneCollider body_option(const CommandLine& line) {
  SceneCollider body;
  body.worn = true;
  if (line.body == "mannequin" || line.body == "woman" || line.body == "dancer" || line.body == "man") {
    SceneMannequin mannequin;
    if (line.body != "mannequin") mannequin.who = mannequin_kind(line.body);
    body.shape = mannequin;
    for (const auto& [option, given] : {std::pair{"--measurements", !line.measurements.empty()},
                                        {"--rig", !line.rig.empty()},
                                        {"--weights", !line.weights.empty()},
                                        {"--target", !line.targets.empty()}})
      if (given) throw Error(ErrorKind::usage, std::string(option) + ": expected a body from a file, got " + line.body);
    return body;
  }
  SceneMesh mesh;
  mesh.path = line.body;
  mesh.measurements = line.measurements;
  mesh.unit = unit_option(line);
  mesh.up = up_option(line);
  if (!line.weights.empty() && line.rig.empty()) throw Error(ErrorKind::usage, "--weights: expected --rig beside it");
  mesh.rig = line.rig;
  mesh.weights = line.weights;
  for (const std::string& target : line.targets) mesh.targets.push_back(target_option(target));
  body.shape = std::move(mesh);
  return body;
}

}  // namespace toile::internal
