#include "io/body_measurements.hpp"

#include "core/elementary.hpp"
#include "core/error.hpp"

#include <fmt/printf.h>
#include <yaml-cpp/yaml.h>

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <span>

namespace toile::internal {
namespace {

constexpr double m_per_cm = 0.01, rad_per_deg = std::numbers::pi / 180;

std::string where(std::string_view file, const YAML::Mark& mark) {
  if (mark.is_null()) return std::string(file);
  return std::string(file) + ':' + std::to_string(mark.line + 1) + ':' + std::to_string(mark.column + 1);
}

// yaml-cpp throws for invalid YAML, and for a node of another type than asked for.
YAML::Node load(std::string_view text, std::string_view file) {
  if (text.find('\0') != std::string_view::npos) throw InputError(file, "", "YAML", "a NUL byte");
  try {
    return YAML::Load(std::string(text));
  } catch (const YAML::Exception& error) {
    throw InputError(where(file, error.mark), "", "YAML", error.msg);
  }
}

std::string describe(const YAML::Node& node) {
  if (node.IsMap()) return "a mapping";
  if (node.IsSequence()) return "a list";
  if (node.IsScalar()) return '"' + printable(node.Scalar()) + '"';
  return "nothing";
}

// A key of the file: where its value goes, and the range that is possible for a person, in the file's units, cm or degrees.
struct Key {
  std::string_view name;
  std::optional<double> BodyMeasurements::*member;
  double least, most, unit;
};
// From a child of three to more than the tallest and the widest of adults.
constexpr double shortest_cm = 50, tallest_cm = 250, widest_cm = 300;
constexpr std::array<Key, 10> body_keys = {
    {{"head_l", &BodyMeasurements::head_m, 10, 50, m_per_cm},
     {"waist_line", &BodyMeasurements::waist_line_m, 10, 80, m_per_cm},
     {"hips_line", &BodyMeasurements::hips_line_m, 1, 60, m_per_cm},
     {"armscye_depth", &BodyMeasurements::armscye_m, 3, 40, m_per_cm},
     {"shoulder_w", &BodyMeasurements::shoulder_width_m, 10, 80, m_per_cm},
     {"shoulder_incl", &BodyMeasurements::shoulder_slope_rad, 0, 60, rad_per_deg},
     {"bust", &BodyMeasurements::bust_girth_m, 30, widest_cm, m_per_cm},
     {"waist", &BodyMeasurements::waist_girth_m, 30, widest_cm, m_per_cm},
     {"hips", &BodyMeasurements::hips_girth_m, 30, widest_cm, m_per_cm},
     {"arm_pose_angle", &BodyMeasurements::arm_down_rad, 0, 90, rad_per_deg}}};

// from_chars ignores the locale; the stream of yaml-cpp does not.
double number_in(const YAML::Node& node, std::string_view file, const std::string& name, double least, double most) {
  const std::string expected = fmt::sprintf("a number from %g to %g", least, most);
  if (!node.IsScalar()) throw InputError(where(file, node.Mark()), name, expected, describe(node));
  const std::string& text = node.Scalar();
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool read = error == std::errc() && end == text.data() + text.size();
  if (!read || !(value >= least && value <= most))
    throw InputError(where(file, node.Mark()), name, expected, describe(node));
  return value;
}

void require_below(std::string_view file, const char* place, const std::optional<double>& upper_m, double lower_m,
                   const char* expected) {
  if (upper_m && !(*upper_m > lower_m))
    throw InputError(file, place, fmt::sprintf("%s, above %.1f cm", expected, 100 * lower_m),
                     fmt::sprintf("%.1f cm", 100 * *upper_m));
}

}  // namespace

std::optional<double> BodyMeasurements::neck_m() const {
  if (!head_m) return std::nullopt;
  return height_m - *head_m;
}

// The line of a shoulder falls from the neck's base in the middle.
std::optional<double> BodyMeasurements::shoulder_m() const {
  if (!neck_m() || !shoulder_width_m || !shoulder_slope_rad) return std::nullopt;
  return *neck_m() - 0.5 * *shoulder_width_m * ieee_sin(*shoulder_slope_rad) / ieee_cos(*shoulder_slope_rad);
}

std::optional<double> BodyMeasurements::armpit_m() const {
  if (!neck_m() || !armscye_m) return std::nullopt;
  return *neck_m() - *armscye_m;
}

std::optional<double> BodyMeasurements::waist_m() const {
  if (!neck_m() || !waist_line_m) return std::nullopt;
  return *neck_m() - *waist_line_m;
}

bool holds_measurements(std::string_view text, std::string_view file) {
  const YAML::Node root = load(text, file);
  return root.IsMap() && root["body"];
}

BodyMeasurements parse_measurements(std::string_view text, std::string_view file) {
  const YAML::Node root = load(text, file);
  const YAML::Node body = root.IsMap() ? root["body"] : YAML::Node(YAML::NodeType::Undefined);
  if (!root.IsMap() || !body) throw InputError(file, "", "a mapping with the key \"body\"", describe(root));
  if (!body.IsMap()) throw InputError(where(file, body.Mark()), "body", "a mapping of measurements", describe(body));
  BodyMeasurements measured;
  measured.file = file;
  std::array<bool, body_keys.size()> given{};
  bool has_height = false;
  for (const auto& entry : body) {
    if (!entry.first.IsScalar()) continue;
    const std::string& key = entry.first.Scalar();
    const std::string name = "body." + key;
    const auto once = [&](bool& before) {
      if (before) throw InputError(where(file, entry.first.Mark()), name, "it once", "it again");
      before = true;
    };
    if (key == "height") {
      once(has_height);
      measured.height_m = m_per_cm * number_in(entry.second, file, name, shortest_cm, tallest_cm);
    }
    for (std::size_t k = 0; k < body_keys.size(); ++k) {
      if (key != body_keys[k].name) continue;
      once(given[k]);
      measured.*body_keys[k].member =
          body_keys[k].unit * number_in(entry.second, file, name, body_keys[k].least, body_keys[k].most);
    }
  }
  if (!has_height) throw InputError(where(file, body.Mark()), "body.height", "the height in cm", "none");
  // Each value may be possible by itself, and their combination impossible.
  require_below(file, "body.waist_line", measured.waist_m(), measured.hips_line_m.value_or(0),
                "height - head_l - waist_line");
  require_below(file, "body.armscye_depth", measured.armpit_m(), measured.waist_m().value_or(0),
                "height - head_l - armscye_depth");
  require_below(file, "body.head_l", measured.neck_m(), 0.5 * measured.height_m, "height - head_l");
  require_below(file, "body.shoulder_incl", measured.shoulder_m(), measured.waist_m().value_or(0),
                "the tips of the shoulders");
  return measured;
}

}  // namespace toile::internal
