#include "material/fabric_fit.hpp"

#include "core/error.hpp"
#include "material/drape_curve.hpp"
#include "material/laboratory_units.hpp"
#include "material/tensile_chord.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace toile::internal {
namespace {

constexpr double base_weight_relative = 0.15;   // a weight that nobody measured
constexpr double one_in_twenty_of_one = 3.841;  // chi-square with one degree of freedom
constexpr double stiff_stretch_N_per_m = 1e4;

std::string digits(double x, int count, std::chars_format format = std::chars_format::general) {
  std::array<char, 40> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), x, format, count).ptr};
}

std::string in_percent(double share) { return digits(100 * share, 2) + " %"; }

class Fitting {
 public:
  explicit Fitting(const FabricMeasurements& measured) : measured_(measured) {
    fit_.fabric = fabric_preset(measured.base, "", "/base");
    fit_.name = measured.name;
  }

  FabricFit fit() {
    add_weight();
    add_stretch({"stretch_u_N_per_m", "doubling_strain_u", &Fabric::stretch_u_N_per_m, &Fabric::doubling_strain_u},
                "warp", measured_.warp);
    add_stretch({"stretch_v_N_per_m", "doubling_strain_v", &Fabric::stretch_v_N_per_m, &Fabric::doubling_strain_v},
                "weft", measured_.weft);
    add_shear();
    find_bending_friction();
    add_bending();
    add("friction", &Fabric::friction, estimates_of(measured_.friction, single_reading::friction, "friction"));
    add_beside();
    return std::move(fit_);
  }

 private:
  static std::vector<Estimate> estimates_of(const Readings& readings, double single, std::string from) {
    if (readings.empty()) return {};
    return {estimate_of(readings, single, std::move(from))};
  }
  static void append(std::vector<Estimate>& to, const std::vector<Estimate>& more) {
    to.insert(to.end(), more.begin(), more.end());
  }

  void flag(std::string_view code, std::string_view key, std::string text) {
    fit_.flags.push_back({code, key, std::move(text)});
  }

  Estimate combined(std::string_view key, const std::vector<Estimate>& sources) {
    const Combined all = combine(sources);
    if (all.agree) return all.estimate;
    std::string text = std::string(key) + ": ";
    for (std::size_t k = 0; k < sources.size(); ++k)
      text += (k == 0                    ? ""
               : k + 1 == sources.size() ? " and "
                                         : ", ") +
              sources[k].from + " " + digits(sources[k].value, 3) + " (" + in_percent(sources[k].relative) + ")";
    text += " disagree by more than their uncertainties allow: chi-square " + digits(all.chi_square, 3) + " with " +
            std::to_string(all.freedom) + (all.freedom == 1 ? " degree" : " degrees") +
            " of freedom. The uncertainty is widened " + digits(all.widened, 2) + " times";
    flag(fit_flag::sources_disagree, key, std::move(text));
    return all.estimate;
  }

  // A number of the fabric: of its sources, or the base's.
  void set(std::string_view key, double Fabric::*member, const Estimate& estimate,
           const std::vector<Estimate>& sources) {
    fit_.fabric.*member = four_digits(estimate.value);
    fit_.numbers.push_back({key, estimate, sources});
  }
  void set_base(std::string_view key, double Fabric::*member) {
    fit_.numbers.push_back({key, {fit_.fabric.*member, 0, 0, measured_.base + " (base)"}, {}});
  }
  void add(std::string_view key, double Fabric::*member, const std::vector<Estimate>& sources) {
    if (sources.empty()) return set_base(key, member);
    set(key, member, combined(key, sources), sources);
  }

  void add_weight() {
    add("density_kg_per_m2", &Fabric::density_kg_per_m2,
        estimates_of(measured_.weight_kg_per_m2, single_reading::weight, "weight"));
    weight_ = fit_.numbers.back().estimate;
    if (weight_.readings > 0) return;
    weight_.relative = base_weight_relative;
  }

  void needs_weight(std::string_view key) {
    if (weight_.readings > 0 || weight_missed_) return;
    weight_missed_ = true;
    flag(fit_flag::weight_of_the_base, key,
         std::string(key) + ": there is no weight, and that of " + measured_.base + ", " +
             digits(1e3 * weight_.value, 3) + " g/m2, is taken to be known to " + in_percent(base_weight_relative));
  }

  // ---- stretch and shear ------------------------------------------------------------------------------------------

  Estimate of_chord(std::string_view key, const Chord& chord, double of_readings, double of_shape, int readings,
                    std::string from) {
    if (!chord.inside)
      flag(fit_flag::chord_elsewhere, key,
           std::string(key) + ": " + from + " has no point where garments pull, at " +
               digits(measured_.chord_N_per_m[0], 3) + " to " + digits(measured_.chord_N_per_m[1], 3) +
               " N/m: the nearest chord is taken");
    return {chord.stiffness_N_per_m, quadrature(of_readings, of_shape, chord.relative), readings, std::move(from)};
  }

  // The largest force of a curve, and the chord to it.
  struct CurveEnd {
    double force_N_per_m = 0;
    Estimate chord;
  };
  static void keep_larger(CurveEnd& end, double force_N_per_m, double extension, double relative, int readings,
                          std::string from) {
    if (force_N_per_m > end.force_N_per_m)
      end = {force_N_per_m, {force_N_per_m / extension, relative, readings, std::move(from)}};
  }

  struct Stretch {
    std::string_view key, doubling_key;
    double Fabric::*stiffness;
    double Fabric::*doubling;
  };

  void add_stretch(const Stretch& stretch, const std::string& thread, const ThreadMeasurements& of) {
    const std::string_view key = stretch.key;
    std::vector<Estimate> sources;
    CurveEnd end;
    const auto& range = measured_.chord_N_per_m;
    if (!of.curve.empty())
      sources.push_back(of_chord(key, chord_of(of.curve, range), single_reading::curve, 0, 1, "tensile curve"));
    if (!of.curve.empty())
      keep_larger(end, of.curve.back()[1], of.curve.back()[0], single_reading::curve, 1, "end of the tensile curve");
    std::vector<std::array<double, 2>> fast;
    double relative = 0;
    int readings = 0;
    for (std::size_t k = 0; k < of.fast_extension.size(); ++k) {
      if (of.fast_extension[k].empty()) continue;
      const Estimate extension = estimate_of(of.fast_extension[k], single_reading::extension, "");
      fast.push_back({extension.value, laboratory::fast_loads_N_per_m[k]});
      keep_larger(end, laboratory::fast_loads_N_per_m[k], extension.value, extension.relative, extension.readings,
                  "FAST extension");
      relative = std::max(relative, extension.relative);
      readings += extension.readings;
    }
    if (!fast.empty()) sources.push_back(of_chord(key, chord_of(fast, range), relative, 0, readings, "FAST extension"));
    if (!of.kes_extension.empty()) {
      sources.push_back(kes_stretch(key, thread, of));
      const Estimate extension = estimate_of(of.kes_extension, single_reading::extension, "KES-F EMT");
      keep_larger(end, laboratory::kes_tensile_N_per_m, extension.value, extension.relative, extension.readings,
                  extension.from);
    }
    if (sources.empty()) {
      set_base(key, stretch.stiffness);
      set_base(stretch.doubling_key, stretch.doubling);
      return;
    }
    set_curve(stretch, combined(key, sources), sources, end);
    if (fit_.fabric.*stretch.stiffness > stiff_stretch_N_per_m)
      flag(fit_flag::stiff_stretch, key,
           std::string(key) + ": above " + digits(stiff_stretch_N_per_m, 5) +
               " N/m nothing changes that can be seen, and steps take longer: it may be lowered to that");
  }

  void set_curve(const Stretch& stretch, const Estimate& chord, const std::vector<Estimate>& sources,
                 const CurveEnd& end) {
    const double middle = 0.5 * (measured_.chord_N_per_m[0] + measured_.chord_N_per_m[1]);
    const double rise = end.chord.value - chord.value;
    const double known_to = quadrature(end.chord.uncertainty(), chord.uncertainty());
    if (end.force_N_per_m < measured_.chord_N_per_m[1] || rise <= 0 ||
        rise * rise <= one_in_twenty_of_one * known_to * known_to) {
      set(stretch.key, stretch.stiffness, chord, sources);
      if (fit_.fabric.*stretch.doubling > 0)
        set(stretch.doubling_key, stretch.doubling, {0, 0, chord.readings, "no stiffening seen"}, {});
      return;
    }
    // `a` and `b`: half an uncertainty of the chord and of the end's; the rise stays one.
    const auto at = [&](double a, double b) {
      return curve_through(chord.value + 0.5 * a * chord.uncertainty(), middle, end.force_N_per_m,
                           end.chord.value + 0.5 * b * end.chord.uncertainty());
    };
    const StiffeningCurve curve = at(0, 0), of_chord[2] = {at(-1, 0), at(1, 0)}, of_end[2] = {at(0, -1), at(0, 1)};
    const auto relative = [&](double StiffeningCurve::*number) {
      return quadrature(of_chord[1].*number - of_chord[0].*number, of_end[1].*number - of_end[0].*number) /
             curve.*number;
    };
    set(stretch.key, stretch.stiffness,
        {curve.stiffness_N_per_m, relative(&StiffeningCurve::stiffness_N_per_m), chord.readings, chord.from}, sources);
    set(stretch.doubling_key, stretch.doubling,
        {curve.doubling_strain, relative(&StiffeningCurve::doubling_strain), end.chord.readings, end.chord.from}, {});
  }

  Estimate kes_stretch(std::string_view key, const std::string& thread, const ThreadMeasurements& of) {
    const Estimate extension = estimate_of(of.kes_extension, single_reading::extension, "");
    Estimate linearity;
    if (of.kes_work_N_per_m.empty()) {
      linearity = estimate_of(of.kes_linearity, single_reading::kes_linearity, "");
    } else {
      const Estimate work = estimate_of(of.kes_work_N_per_m, single_reading::kes_work, "");
      linearity.value = work.value / (0.5 * laboratory::kes_tensile_N_per_m * extension.value);
      linearity.relative = quadrature(work.relative, extension.relative);
      if (linearity.value < least_linearity || linearity.value > 1) {
        const std::string path = "/kes/WT_" + thread + "_gf_cm_per_cm2";
        throw InputError("", "", "a linearity WT / (250 gf/cm * EMT) from 1/3 to 1", digits(linearity.value, 3))
            .of(path);
      }
    }
    const auto chord = [&](double of_linearity) {
      return kes_chord(extension.value, std::clamp(of_linearity, least_linearity, 1.0), measured_.chord_N_per_m);
    };
    const Chord at = chord(linearity.value);
    const double by_linearity = std::abs(chord(linearity.value * (1 + linearity.relative)).stiffness_N_per_m -
                                         chord(linearity.value * (1 - linearity.relative)).stiffness_N_per_m) /
                                (2 * at.stiffness_N_per_m);
    return of_chord(key, at, quadrature(extension.relative, by_linearity), kes_shape_relative, extension.readings,
                    "KES-F EMT");
  }

  void add_shear() {
    std::vector<Estimate> sources = estimates_of(measured_.kes_shear_N_per_m, single_reading::shear, "KES-F G");
    for (Estimate extension :
         estimates_of(measured_.fast_bias_extension, single_reading::extension, "FAST bias extension")) {
      extension.value = laboratory::bias_shear_N_per_m(extension.value);
      sources.push_back(std::move(extension));
    }
    add("shear_N_per_m", &Fabric::shear_N_per_m, sources);
  }

  // ---- bending and drape ------------------------------------------------------------------------------------------

  Estimate rigidity_of(const Estimate& length) const {
    return {laboratory::rigidity_N_m(weight_.value, length.value), quadrature(3 * length.relative, weight_.relative),
            length.readings, length.from};
  }

  // All lengths give one, before the weight comes in: its error is the same in each of them.
  std::optional<FittedNumber> bending_of(std::string_view key, const ThreadMeasurements& of) {
    std::vector<Estimate> lengths = estimates_of(of.cantilever_m, single_reading::bending_length, "cantilever");
    append(lengths, estimates_of(of.fast_bending_m, single_reading::bending_length, "FAST bending length"));
    std::vector<Estimate> direct = estimates_of(of.fast_bending_N_m, single_reading::fast_rigidity, "FAST rigidity");
    append(direct, estimates_of(of.kes_bending_N_m, single_reading::kes_bending, "KES-F B"));
    FittedNumber number{key, {}, {}};
    for (const Estimate& length : lengths) number.sources.push_back(rigidity_of(length));
    append(number.sources, direct);
    if (number.sources.empty()) return std::nullopt;
    if (!lengths.empty()) needs_weight(key);
    if (rubs_) {
      // B is read where threads slip; a cantilever bends less than that in part, and shows up to B + D_f.
      number.estimate = estimate_of(of.kes_bending_N_m, single_reading::kes_bending, "KES-F B");
      for (const Estimate& source : number.sources)
        if (source.from != number.estimate.from) compare_with_friction(key, number.estimate, source);
    } else {
      std::vector<Estimate> rigidities = direct;
      if (!lengths.empty()) rigidities.insert(rigidities.begin(), rigidity_of(combined(key, lengths)));
      number.estimate = combined(key, rigidities);
    }
    return number;
  }

  void compare_with_friction(std::string_view key, const Estimate& B, const Estimate& shown) {
    const double most = B.value + friction_rigidity_N_m_;
    const double off = std::max({0.0, B.value - shown.value, shown.value - most});
    const double together = quadrature(shown.uncertainty(), B.uncertainty());
    if (off * off <= one_in_twenty_of_one * together * together) return;
    flag(fit_flag::sources_disagree, key,
         std::string(key) + ": " + shown.from + " " + digits(shown.value, 3) +
             ", where KES-F B and 2HB let one expect " + digits(B.value, 3) + " to " + digits(most, 3));
  }

  void add_bending() {
    constexpr std::string_view key_u = "bend_u_N_m", key_v = "bend_v_N_m";
    std::optional<FittedNumber> u = bending_of(key_u, measured_.warp), v = bending_of(key_v, measured_.weft);
    const std::vector<Estimate> drapes = estimates_of(measured_.drape, single_reading::drape, "drape");
    if (!drapes.empty()) {
      fit_.drape.measured = drapes.front();
      fit_.drape.measured->value *= 100;
    }
    const bool both = u && v;
    if (!rubs_ && (u || v || !drapes.empty()))
      leave_out_friction((u ? u->estimate.readings : 0) + (v ? v->estimate.readings : 0) +
                         (drapes.empty() ? 0 : drapes.front().readings));
    if (!drapes.empty() && !both) {
      fit_.drape.gives_bending = true;
      const Estimate mean = rigidity_by_drape(key_u);
      // The disc shows the mean of both threads.
      const auto other_of = [&](std::string_view key, const std::optional<FittedNumber>& one) {
        if (!one) return FittedNumber{key, mean, {mean}};
        const Estimate other{mean.value * mean.value / one->estimate.value,
                             quadrature(2 * mean.relative, one->estimate.relative), mean.readings,
                             "drape and the other thread"};
        return FittedNumber{key, other, {other}};
      };
      const auto given_u = u;
      if (!u) u = other_of(key_u, v);
      if (!v) v = other_of(key_v, given_u);
    }
    const auto put = [&](std::string_view key, double Fabric::*member, const std::optional<FittedNumber>& number) {
      if (!number) return set_base(key, member);
      set(key, member, number->estimate, number->sources);
    };
    put(key_u, &Fabric::bend_u_N_m, u);
    put(key_v, &Fabric::bend_v_N_m, v);
    if (both) compare_drape(u->estimate, v->estimate);
  }

  // A cantilever and a disc show friction as a part of the rigidity: with the base's beside it, it would count twice.
  void leave_out_friction(int readings) {
    friction_rigidity_N_m_ = 0;
    if (fit_.fabric.bend_friction_N > 0)
      set("bend_friction_N", &Fabric::bend_friction_N, {0, 0, readings, "a bending without 2HB"}, {});
    const auto shows_it = [](const ThreadMeasurements& of) {
      return !of.cantilever_m.empty() || !of.fast_bending_m.empty() || !of.fast_bending_N_m.empty();
    };
    if (shows_it(measured_.warp) || shows_it(measured_.weft) || !measured_.drape.empty()) return;
    flag(fit_flag::no_bending_friction, "bend_friction_N",
         "bend_friction_N: KES-F B is the slope where threads slip, and without 2HB and B of both threads what they "
         "hold before is not known: none is taken, and the cloth falls softer than the sheet");
  }

  Estimate rigidity_by_drape(std::string_view key) {
    const MonotoneCurve& curve = drape_curve::percent_of_bending_length(fit_.fabric.compression_ratio);
    const Estimate& percent = *fit_.drape.measured;
    if (percent.value < curve.first()[1] || percent.value > curve.last()[1])
      throw InputError("", "",
                       "a mean from " + digits(curve.first()[1], 3) + " to " + digits(curve.last()[1], 3) +
                           ", where the drape says how stiff a cloth is",
                       digits(percent.value, 4))
          .of("/drape_percent");
    needs_weight(key);
    const double length = curve.inverse(percent.value);
    const double points =
        quadrature(percent.uncertainty(), drape_curve::uncertainty_points(length, fit_.fabric.compression_ratio));
    return rigidity_of({length, points / curve.slope(length) / length, percent.readings, "drape"});
  }

  // The drape of the fitted cloth, beside the disc's.  A cloth that rubs drapes as one without friction and a rigidity between B and B + D_f.
  void compare_drape(const Estimate& u, const Estimate& v) {
    const MonotoneCurve& curve = drape_curve::percent_of_bending_length(fit_.fabric.compression_ratio);
    const double rigidity = std::sqrt(u.value * v.value);
    const auto length_of = [&](double D) { return cube_root(D / (weight_.value * laboratory::gravity_m_s2)); };
    const double least = length_of(rigidity), most = length_of(rigidity + friction_rigidity_N_m_);
    const double of_rigidity = 0.5 * quadrature(u.relative, v.relative);
    needs_weight("drape_percent");
    if (const double length = least < curve.first()[0] ? least : most;
        length < curve.first()[0] || length > curve.last()[0]) {
      flag(fit_flag::outside_the_drape_curve, "drape_percent",
           "drape_percent: the bending length of the fitted cloth, " + digits(1e3 * length, 3) +
               " mm, is outside of the curve, " + digits(1e3 * curve.first()[0], 3) + " to " +
               digits(1e3 * curve.last()[0], 3) + " mm: its drape is not known");
      return;
    }
    const double points = curve.slope(least) * least * quadrature(of_rigidity, weight_.relative) / 3;
    const double low = curve.value(least), high = curve.value(most);
    Estimate fitted{0.5 * (low + high), 0, u.readings + v.readings, "bending"};
    fitted.relative = quadrature(points, drape_curve::uncertainty_points(least, fit_.fabric.compression_ratio),
                                 (high - low) / std::sqrt(12.0)) /
                      fitted.value;
    fit_.drape.of_the_fabric = fitted;
    if (!fit_.drape.measured) return;
    const Estimate& seen = *fit_.drape.measured;
    const double off = seen.value - fitted.value, together = quadrature(seen.uncertainty(), fitted.uncertainty());
    if (off * off <= one_in_twenty_of_one * together * together) return;
    flag(fit_flag::drape_disagrees, "drape_percent",
         "drape_percent: the disc showed " + digits(seen.value, 3) + " %, and a cloth that bends as measured has " +
             digits(fitted.value, 3) + " %: " + digits(std::abs(off), 2) + " points apart, where " +
             digits(together, 2) + " is their uncertainty");
  }

  // ---- what is no number of the fabric ----------------------------------------------------------------------------

  void add_beside() {
    const auto put = [&](std::string_view key, const Readings& readings, double single, std::string from) {
      for (const Estimate& one : estimates_of(readings, single, std::move(from)))
        fit_.beside.push_back({key, one, {one}});
    };
    put("measured_thickness_m", measured_.thickness_m, single_reading::thickness, "thickness");
    for (const Estimate& length :
         estimates_of(measured_.bias_cantilever_m, single_reading::bending_length, "cantilever, bias")) {
      needs_weight("bend_bias_N_m");
      fit_.beside.push_back({"bend_bias_N_m", rigidity_of(length), {rigidity_of(length)}});
    }
    put("shear_hysteresis_N_per_m", measured_.kes_shear_hysteresis_N_per_m, single_reading::hysteresis, "KES-F 2HG");
  }

  // The moment per width that a bent cloth keeps, half of 2HB, as the mean of both threads.  It belongs to B, which is the slope beyond it: without
  // B along both threads it is for the record.
  void find_bending_friction() {
    std::vector<Estimate> threads =
        estimates_of(measured_.warp.kes_hysteresis_N, single_reading::hysteresis, "KES-F 2HB warp");
    append(threads, estimates_of(measured_.weft.kes_hysteresis_N, single_reading::hysteresis, "KES-F 2HB weft"));
    friction_rigidity_N_m_ = fit_.fabric.bend_friction_N / fit_.fabric.bend_friction_curvature_per_m;  // the base's
    if (threads.empty()) return;
    Estimate mean{0, 0, 0, "KES-F 2HB"};
    double square = 0;
    for (Estimate& one : threads) {
      one.value *= 0.5;
      mean.value += one.value / static_cast<double>(threads.size());
      mean.readings += one.readings;
      square += one.uncertainty() * one.uncertainty();
    }
    mean.relative = std::sqrt(square) / static_cast<double>(threads.size()) / mean.value;
    rubs_ = !measured_.warp.kes_bending_N_m.empty() && !measured_.weft.kes_bending_N_m.empty();
    if (!rubs_) {
      fit_.beside.push_back({"bend_friction_N", mean, threads});
      return;
    }
    set("bend_friction_N", &Fabric::bend_friction_N, mean, threads);
    friction_rigidity_N_m_ = mean.value / fit_.fabric.bend_friction_curvature_per_m;
  }

  const FabricMeasurements& measured_;
  FabricFit fit_;
  Estimate weight_;
  bool weight_missed_ = false;
  bool rubs_ = false;                 // the fabric has bending friction
  double friction_rigidity_N_m_ = 0;  // D_f
};

}  // namespace

double four_digits(double x) {
  std::array<char, 40> text;
  const char* const end =
      std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::scientific, 3).ptr;
  std::from_chars(text.data(), end, x);
  return x;
}

FabricFit fit_fabric(const FabricMeasurements& measured) { return Fitting(measured).fit(); }

}  // namespace toile::internal
