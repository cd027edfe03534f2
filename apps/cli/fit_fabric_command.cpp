// apps/cli/fit_fabric_command.cpp: `toile fit-fabric`: a fabric from the figures of a textile laboratory.
#include "commands.hpp"
#include "core/utf8.hpp"
#include "io/file.hpp"
#include "sim/fabric_file.hpp"
#include "sim/fabric_measurements_file.hpp"
#include "sim/scene.hpp"
#include "sim/settings.hpp"
#include "terminal.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace toile::internal {
namespace {

// What is there already is replaced only where an earlier run of this command wrote it.
void refuse_what_is_not_ours(const CommandLine& line) {
  if (line.out.empty()) return;
  if (!line.out.ends_with(".json"))
    throw Error(ErrorKind::usage, "--out: expected a name that ends in .json, got " + printable(line.out));
  std::error_code ignored;
  if (std::filesystem::equivalent(line.inputs.front(), line.out, ignored))
    throw IoError(printable(line.out), "is an input, which would be written over: name another file with --out");
  if (std::filesystem::exists(line.out, ignored) && !is_fabric_fit(read_text_file(line.out)))
    throw IoError(printable(line.out), "is there, and not written by fit-fabric: name another file with --out");
}

// Power of ten of the first digit that is shown: 3 of 1996 shown with two digits, as 2.0e+03.
int exponent_of(double x, int digits) {
  const std::string text = fmt::sprintf("%.*e", digits - 1, x);
  return std::atoi(text.c_str() + text.find('e') + 1);
}

// "0.11842 ± 0.00071", "6500 ± 1100", "(8.72 ± 0.33)e-06": the uncertainty with two digits, the value to the same place.
std::string with_uncertainty(const Estimate& estimate) {
  if (estimate.readings == 0) return fmt::sprintf("%.4g", estimate.value);
  const int of_value = exponent_of(estimate.value, 4), last = exponent_of(estimate.uncertainty(), 2) - 1;
  if (of_value < -3) {
    const double unit = std::pow(10.0, of_value);
    const int decimals = std::max(0, of_value - last);
    return fmt::sprintf("(%.*f ± %.*f)e%03d", decimals, estimate.value / unit, decimals, estimate.uncertainty() / unit,
                        of_value);
  }
  const double unit = std::pow(10.0, std::max(0, last));
  const int decimals = std::max(0, -last);
  const auto shown = [&](double x) {
    return fmt::sprintf("%.*f", decimals, last > 0 ? unit * std::round(x / unit) : x);
  };
  return shown(estimate.value) + " ± " + shown(estimate.uncertainty());
}

std::string padded(const std::string& text, std::size_t width) {
  std::size_t characters = 0;
  for (std::string_view rest = text; !rest.empty();
       rest.remove_prefix(std::max<std::size_t>(1, utf8_character_bytes(rest))))
    ++characters;
  return text + std::string(width > characters ? width - characters : 0, ' ');
}

std::string rows_of(const std::vector<FittedNumber>& numbers) {
  std::string text;
  for (const FittedNumber& number : numbers) {
    const std::string key(number.key);
    text += "  " + padded(key, 26) + padded(with_uncertainty(number.estimate), 24) + padded(unit_of(key), 8) +
            number.estimate.from;
    if (number.estimate.readings > 0)
      text += fmt::sprintf(", %d reading%s", number.estimate.readings, number.estimate.readings == 1 ? "" : "s");
    text += '\n';
    if (number.sources.size() > 1)
      for (const Estimate& source : number.sources)
        text += "    " + padded(source.from, 24) + with_uncertainty(source) + '\n';
  }
  return text;
}

std::string table_of(const FabricFit& fit) {
  std::string text =
      (fit.name.empty() ? "" : printable(fit.name) + ": ") + "a fabric based on " + fit.fabric.name + '\n';
  text += rows_of(fit.numbers);
  if (!fit.beside.empty()) text += "measured, and no number of the fabric:\n" + rows_of(fit.beside);
  const DrapeFit& drape = fit.drape;
  if (drape.measured) text += "drape coefficient, measured: " + with_uncertainty(*drape.measured) + " %\n";
  if (drape.of_the_fabric)
    text += "drape coefficient of the fitted fabric: " + with_uncertainty(*drape.of_the_fabric) + " %\n";
  for (const FitFlag& flag : fit.flags) text += "warning: " + flag.text + '\n';
  return text;
}

// The object for a scene, as it stands in the JSON.
std::string fabric_object(const FabricFit& fit) {
  std::string text = "\"fabric\": {\"base\": \"" + fit.fabric.name + '"';
  for (const FittedNumber& number : fit.numbers)
    if (number.estimate.readings > 0)
      text += fmt::sprintf(", \"%s\": %g", std::string(number.key), four_digits(number.estimate.value));
  return text + "}\n";
}

}  // namespace

ExitCode fit_fabric_command(const CommandLine& line) {
  refuse_what_is_not_ours(line);
  const FabricFit fit = fit_fabric_file(line.inputs.front());
  const std::string json = to_json(fit);
  if (!line.out.empty()) {
    make_directories(std::filesystem::path(line.out).parent_path().string());
    AtomicFile file(line.out);
    file.write(json);
    file.commit();
  }
  if (line.json) {
    print(json);
  } else if (!line.quiet) {
    print(table_of(fit) + fabric_object(fit) + (line.out.empty() ? "" : line.out + '\n'));
  }
  return ExitCode::ok;
}

}  // namespace toile::internal
