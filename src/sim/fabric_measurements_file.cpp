#include "sim/fabric_measurements_file.hpp"

#include "material/laboratory_units.hpp"
#include "material/tensile_chord.hpp"
#include "sim/scene.hpp"
#include "sim/scene_reading.hpp"

#include <fmt/printf.h>

#include <array>
#include <numeric>
#include <vector>

namespace toile::internal {
namespace {

using scene_reading::number_in;

constexpr std::size_t most_readings = 1000;
namespace of_cloth {
constexpr double percent = 0.01, mm = 1e-3;

// What a cloth can have, from the lightest gauze to felt and belting, in the unit of the key; `unit` is that in SI.
constexpr Range weights{5, 5000, 1e-3}, thicknesses{0.01, 50, mm}, bending_lengths{2, 200, mm},
    overhangs{4, 400, laboratory::bending_length_per_overhang*mm}, rigidities{0.01, 1e5, 1e-6},
    extensions{0.01, 300, percent}, kes_bendings{5e-4, 200, laboratory::bending_N_m},
    kes_bending_hystereses{1e-4, 200, laboratory::bending_friction_N}, kes_shears{0.01, 100, laboratory::shear_N_per_m},
    kes_shear_hystereses{0.01, 1000, laboratory::force_N_per_m}, linearities{least_linearity, 1, 1},
    works{0.01, 1000, laboratory::work_N_per_m}, drapes{1, 100, percent}, frictions{0.01, 5, 1},
    strains_percent{0, 300, percent}, forces{0, 1e5, 1}, chord_forces{0.1, 1e4, 1};
}  // namespace of_cloth

// A key, its range, and where its readings go.
struct Figure {
  std::string_view key;
  Range range;
  Readings* into;
};

class MeasurementsReader {
 public:
  explicit MeasurementsReader(FabricMeasurementsFile& file) : file_(file), measured_(file.measured) {}

  void read(const Json& root) {
    const std::array<Figure, 4> figures = {{{"weight_g_per_m2", of_cloth::weights, &measured_.weight_kg_per_m2},
                                            {"thickness_mm", of_cloth::thicknesses, &measured_.thickness_m},
                                            {"drape_percent", of_cloth::drapes, &measured_.drape},
                                            {"friction", of_cloth::frictions, &measured_.friction}}};
    read_figures(root, figures, {"name", "base", "chord_N_per_m", "cantilever", "fast", "kes", "tensile"});
    if (const Json* name = root.find("name")) {
      measured_.name = name->string();
      if (measured_.name.empty()) name->fail("a name", "an empty string");
    }
    if (const Json* base = root.find("base"))
      measured_.base = fabric_preset(base->string(), base->where(), base->pointer()).name;
    if (const Json* chord = root.find("chord_N_per_m")) read_chord(*chord);
    if (const Json* cantilever = root.find("cantilever")) read_cantilever(*cantilever);
    if (const Json* fast = root.find("fast")) read_fast(*fast);
    if (const Json* kes = root.find("kes")) read_kes(*kes);
    if (const Json* tensile = root.find("tensile")) read_tensile(*tensile);
    if (figures_ == 0) root.fail("at least one figure, say \"weight_g_per_m2\"", "none");
  }

 private:
  // Reads all that are there; refuses other keys than theirs and `others`.
  void read_figures(const Json& object, std::span<const Figure> figures,
                    std::initializer_list<std::string_view> others = {}) {
    std::vector<std::string_view> keys(others);
    for (const Figure& figure : figures) keys.push_back(figure.key);
    object.allow_only(keys);
    for (const Figure& figure : figures)
      if (const Json* value = object.find(figure.key)) read_readings(*value, figure.range, *figure.into);
  }

  void read_readings(const Json& value, const Range& range, Readings& into) {
    file_.places.add(value);
    ++figures_;
    if (value.is_number()) {
      into.push_back(range.unit * number_in(value, range));
      return;
    }
    if (!value.is_array()) value.fail("a number or a list of readings", value.describe());
    const std::size_t count = value.array().size();
    if (count == 0) value.fail("at least one reading", "an empty array");
    if (count > most_readings)
      value.fail("at most " + std::to_string(most_readings) + " readings", std::to_string(count));
    for (const Json& one : value.array()) into.push_back(range.unit * number_in(one, range));
  }

  static void exclude(const Json& object, const std::string& one, const std::string& other) {
    const Json* const second = object.find(other);
    if (object.find(one) != nullptr && second != nullptr)
      second->fail("either \"" + one + "\" or \"" + other + '"', "both");
  }

  void read_chord(const Json& value) {
    if (!value.is_array() || value.array().size() != 2) value.fail("two forces [from, to] in N/m", value.describe());
    for (std::size_t k = 0; k < 2; ++k)
      measured_.chord_N_per_m[k] = number_in(value.array()[k], of_cloth::chord_forces);
    if (!(measured_.chord_N_per_m[0] < measured_.chord_N_per_m[1]))
      value.array()[1].fail(fmt::sprintf("a force above %g N/m", measured_.chord_N_per_m[0]),
                            value.array()[1].describe());
  }

  void read_cantilever(const Json& value) {
    const std::array<std::pair<std::string, Readings*>, 3> directions = {{{"warp", &measured_.warp.cantilever_m},
                                                                          {"weft", &measured_.weft.cantilever_m},
                                                                          {"bias", &measured_.bias_cantilever_m}}};
    std::vector<std::string> names;
    for (const auto& [name, into] : directions) {
      names.push_back(name + "_bending_length_mm");
      names.push_back(name + "_overhang_mm");
    }
    std::vector<Figure> figures;
    for (std::size_t k = 0; k < directions.size(); ++k) {
      figures.push_back({names[2 * k], of_cloth::bending_lengths, directions[k].second});
      figures.push_back({names[2 * k + 1], of_cloth::overhangs, directions[k].second});
    }
    read_figures(value, figures);
    for (std::size_t k = 0; k < directions.size(); ++k) exclude(value, names[2 * k], names[2 * k + 1]);
  }

  void read_fast(const Json& value) {
    std::vector<std::string> names;
    std::vector<Figure> figures;
    names.reserve(10);
    const auto add = [&](const std::string& name, const Range& range, Readings& into) {
      names.push_back(name);
      figures.push_back({names.back(), range, &into});
    };
    for (const auto& [thread, of] : threads()) {
      add("bending_length_" + thread + "_mm", of_cloth::bending_lengths, of->fast_bending_m);
      add("bending_rigidity_" + thread + "_uN_m", of_cloth::rigidities, of->fast_bending_N_m);
      add("E5_" + thread + "_percent", of_cloth::extensions, of->fast_extension[0]);
      add("E20_" + thread + "_percent", of_cloth::extensions, of->fast_extension[1]);
      add("E100_" + thread + "_percent", of_cloth::extensions, of->fast_extension[2]);
    }
    figures.push_back({"EB5_percent", of_cloth::extensions, &measured_.fast_bias_extension});
    read_figures(value, figures);
    for (const auto& [thread, of] : threads()) {
      exclude(value, "bending_length_" + thread + "_mm", "bending_rigidity_" + thread + "_uN_m");
      double before = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const Readings& readings = of->fast_extension[k];
        if (readings.empty()) continue;
        const double mean =
            std::accumulate(readings.begin(), readings.end(), 0.0) / static_cast<double>(readings.size());
        if (!(mean > before))
          value.at(std::array{"E5_", "E20_", "E100_"}[k] + thread + "_percent")
              .fail(fmt::sprintf("more than under the smaller load, %g %%", before / of_cloth::percent),
                    fmt::sprintf("%g %%", mean / of_cloth::percent));
        before = mean;
      }
    }
  }

  void read_kes(const Json& value) {
    std::vector<std::string> names;
    std::vector<Figure> figures;
    names.reserve(10);
    const auto add = [&](const std::string& name, const Range& range, Readings& into) {
      names.push_back(name);
      figures.push_back({names.back(), range, &into});
    };
    for (const auto& [thread, of] : threads()) {
      add("B_" + thread + "_gf_cm2_per_cm", of_cloth::kes_bendings, of->kes_bending_N_m);
      add("2HB_" + thread + "_gf_cm_per_cm", of_cloth::kes_bending_hystereses, of->kes_hysteresis_N);
      add("EMT_" + thread + "_percent", of_cloth::extensions, of->kes_extension);
      add("LT_" + thread, of_cloth::linearities, of->kes_linearity);
      add("WT_" + thread + "_gf_cm_per_cm2", of_cloth::works, of->kes_work_N_per_m);
    }
    figures.push_back({"G_gf_per_cm_deg", of_cloth::kes_shears, &measured_.kes_shear_N_per_m});
    figures.push_back({"2HG_gf_per_cm", of_cloth::kes_shear_hystereses, &measured_.kes_shear_hysteresis_N_per_m});
    read_figures(value, figures);
    for (const auto& [thread, of] : threads()) {
      const std::string end = "EMT_" + thread + "_percent", shape = "LT_" + thread,
                        work = "WT_" + thread + "_gf_cm_per_cm2", either = '"' + shape + "\" or \"" + work + '"';
      exclude(value, shape, work);
      const bool has_shape = value.find(shape) != nullptr, has_work = value.find(work) != nullptr;
      if (value.find(end) != nullptr && !has_shape && !has_work)
        value.at(end).fail(either + " beside it: the end of a curve does not say how it begins", "neither");
      if (value.find(end) == nullptr && (has_shape || has_work))
        value.at(has_shape ? shape : work).fail('"' + end + "\" beside it", "none");
    }
  }

  void read_tensile(const Json& value) {
    value.allow_only({"warp", "weft"});
    for (const auto& [thread, of] : threads()) {
      const Json* const rows = value.find(thread);
      if (rows == nullptr) continue;
      file_.places.add(*rows);
      ++figures_;
      std::array<double, 2> before = {0, 0};
      for (const Json& row : rows->array()) {
        if (!row.is_array() || row.array().size() != 2)
          row.fail("two numbers [strain in %, force in N/m]", row.describe());
        const std::array<double, 2> next = {of_cloth::percent * number_in(row.array()[0], of_cloth::strains_percent),
                                            number_in(row.array()[1], of_cloth::forces)};
        if (of->curve.empty() && next == before) continue;  // the curve's beginning
        for (std::size_t k = 0; k < 2; ++k)
          if (!(next[k] > before[k]))
            row.array()[k].fail(
                fmt::sprintf(k == 0 ? "a strain above that before, %g %%" : "a force above that before, %g N/m",
                             k == 0 ? before[k] / of_cloth::percent : before[k]),
                row.array()[k].describe());
        of->curve.push_back(next);
        before = next;
      }
      if (of->curve.empty()) rows->fail("at least one point with a strain and a force above zero", rows->describe());
      if (of->curve.size() > most_readings)
        rows->fail("at most " + std::to_string(most_readings) + " points", std::to_string(of->curve.size()));
    }
  }

  std::array<std::pair<std::string, ThreadMeasurements*>, 2> threads() {
    return {{{"warp", &measured_.warp}, {"weft", &measured_.weft}}};
  }

  FabricMeasurementsFile& file_;
  FabricMeasurements& measured_;
  int figures_ = 0;
};

}  // namespace

FabricMeasurementsFile parse_fabric_measurements(std::string_view text, const std::string& file) {
  FabricMeasurementsFile read;
  const Json root = Json::parse(text, printable(file));
  MeasurementsReader(read).read(root);
  return read;
}

FabricFit fit_fabric_file(const std::string& path) {
  const FabricMeasurementsFile file = parse_fabric_measurements(read_text_file(path), path);
  return file.places.complete_errors_of([&] { return fit_fabric(file.measured); });
}

}  // namespace toile::internal
