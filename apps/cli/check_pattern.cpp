#include "check_pattern.hpp"

#include "body_option.hpp"
#include "budget_text.hpp"
#include "garment/garment_mesh.hpp"
#include "garment/pattern_check.hpp"
#include "garment/pattern_svg.hpp"
#include "io/file.hpp"
#include "sim/body_figures.hpp"
#include "sim/setup.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <filesystem>
#include <optional>

namespace toile::internal {
namespace {

// `garment` is the meshed pattern.
std::string describe(const Pattern& pattern, const GarmentMesh& garment, double resolution_m, JsonText& json) {
  const PatternSummary summary = summarize(pattern);
  const MeshQuality quality = mesh_quality(garment.mesh);
  json.member("kind", "pattern");
  json.member("panels", summary.panels.size());
  json.member("stitches", summary.stitches);
  json.member("darts", summary.darts);
  json.member("eased", summary.eased_stitches);
  json.member("longest_ratio", summary.longest_ratio);
  json.member("seam_m", summary.seam_m);
  json.member("area_m2", summary.area_m2);
  json.key("mesh");
  json.begin_object();
  json.member("resolution_cm", 100 * resolution_m);
  json.member("vertices", garment.mesh.particle_count);
  json.member("triangles", garment.mesh.triangle_count());
  json.member("min_angle_deg", quality.min_angle_deg);
  json.member("mean_edge_m", quality.mean_edge_m);
  json.member("min_edge_m", quality.min_edge_m);
  json.member("max_edge_m", quality.max_edge_m);
  json.end_object();
  json.key("notes");
  json.begin_array();
  for (const std::string& note : summary.notes) json.value(note);
  json.end_array();
  std::string text = fmt::sprintf(
      "pattern, %zu panels, %d stitches (%d darts, %d eased, longest ratio %.2f), %.2f m of seam, %.2f m2 of cloth\n",
      summary.panels.size(), summary.stitches, summary.darts, summary.eased_stitches, summary.longest_ratio,
      summary.seam_m, summary.area_m2);
  text += fmt::sprintf(
      "  at %.1f cm: %d vertices, %d triangles, smallest angle %.1f degrees, edges %.1f / %.1f / %.1f mm (least, mean, "
      "most)\n",
      100 * resolution_m, garment.mesh.particle_count, garment.mesh.triangle_count(), quality.min_angle_deg,
      1e3 * quality.min_edge_m, 1e3 * quality.mean_edge_m, 1e3 * quality.max_edge_m);
  for (const std::string& note : summary.notes) text += "  note: " + note + '\n';
  return text;
}

// Loads it as `dress` does, and estimates the most that this takes on the mannequin.
std::string load_as_dress_does(const CommandLine& line, const std::string& path, const std::string& text,
                               JsonText& json) {
  const double resolution_m = line.resolution_cm ? 0.01 * *line.resolution_cm : SceneCloth{}.resolution_m;
  const Pattern pattern = parse_pattern(text, printable(path));
  Scene dressed;
  dressed.name = pattern.name;
  dressed.seconds = Scene::longest_dress_s;
  dressed.until_still = true;
  dressed.body.shape = SceneMannequin{};
  SceneCloth& cloth = dressed.cloth.emplace_back();
  cloth.kind = ScenePattern{path, {}};
  cloth.set_edge_m(resolution_m);
  const std::string budget =
      fmt::sprintf("  as dressed for %g s: ", dressed.seconds) + describe_budget(dressed, line.limits, json);
  const LoadedCloth loaded = load_cloth(dressed, 0, [&](const std::string&) { return text; });
  return describe(pattern, as_worn(loaded), resolution_m, json) + budget;
}

void write_whole(const std::string& path, std::string_view text) {
  make_directories(std::filesystem::path(path).parent_path().string());
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

// An input is never an output, nor one output another.
void refuse_inputs(const CommandLine& line) {
  const std::pair<const std::string&, const char*> outputs[] = {{line.svg, "--svg"}, {line.repair, "--repair"}};
  for (const auto& [output, option] : outputs) {
    if (output.empty()) continue;
    std::error_code ignored;
    for (const std::string& input : {line.inputs.front(), line.body, line.measurements})
      if (!input.empty() && std::filesystem::equivalent(input, output, ignored))
        throw IoError(printable(input),
                      std::string("is an input, which would be written over: name another file with ") + option);
  }
  if (!line.svg.empty() &&
      std::filesystem::path(line.svg).lexically_normal() == std::filesystem::path(line.repair).lexically_normal())
    throw Error(ErrorKind::usage, "--svg and --repair name one file");
}

std::string describe_findings(const std::vector<LintFinding>& findings) {
  std::string text;
  std::size_t number = 0;
  for (const LintFinding& finding : findings) {
    text += fmt::sprintf("  %zu. %s %s: %s: expected %s, got %s\n", ++number, std::string(to_string(finding.severity)),
                         std::string(finding.code), finding.place, finding.expected, finding.got);
    text += "     " + finding.where + (finding.pointer.empty() ? "" : ": " + finding.pointer) + "\n     " +
            (finding.mended ? "can be mended: " : "") + finding.repair + '\n';
  }
  return text;
}

// `notes`: gets the warnings about the body.
std::optional<BodyFigures> figures_of(const CommandLine& line, std::string& notes) {
  if (line.body.empty() && !line.measurements.empty())
    throw Error(ErrorKind::usage, "--measurements: expected --body beside it");
  if (line.body.empty()) return std::nullopt;
  const Collider body = load_collider(body_option(line));
  BodyFigures figures = body_figures(body.surface.positions, body.surface.triangles, body.measurements);
  add_arms(figures, find_arms(body.surface.positions, body.surface.triangles));
  for (const std::string& note : body.warnings) notes += "  note: " + note + '\n';
  const std::string odd = body.measurements ? odd_pose(*body.measurements, figures) : "";
  if (!odd.empty()) notes += "  note: " + odd + '\n';
  return figures;
}

// Writes the mended copy and returns the text about it; its errors become those of `checked`.
std::string write_mended(const CommandLine& line, const std::string& text, const LintReport& report, Checked& checked) {
  const auto mended =
      std::count_if(report.findings.begin(), report.findings.end(), [](const auto& f) { return f.mended; });
  const std::string& copy = report.mended_text.empty() ? text : report.mended_text;
  if (report.mended_text.empty() && !checked.error.empty()) return "  nothing could be mended: nothing is written\n";
  write_whole(line.repair, copy);
  checked.mended_file = line.repair;
  if (!report.mended_text.empty()) {
    checked.error.clear();
    checked.code = ExitCode::ok;
    JsonText ignored;
    ignored.begin_object();
    try {
      load_as_dress_does(line, line.repair, copy, ignored);
    } catch (const Error& error) {
      checked.error = error.what();
      checked.code = exit_code(error.kind());
    }
  }
  if (mended == 0) return "  nothing is to be mended: " + printable(line.repair) + " is a copy\n";
  return fmt::sprintf("  %d mended: %s is written%s\n", mended, printable(line.repair),
                      checked.error.empty() ? "" : ", and still cannot be used: " + checked.error);
}

}  // namespace

Checked check_pattern(const CommandLine& line, const std::string& path, const std::string& text, JsonText& json) {
  refuse_inputs(line);
  Checked checked;
  checked.is_pattern = true;
  std::string notes;
  LintReport report = lint_pattern(text, printable(path), figures_of(line, notes));
  const JsonText before = json;
  try {
    checked.said = load_as_dress_does(line, path, text, json);
  } catch (const Error& error) {
    json = before;
    checked.error = error.what();
    checked.code = exit_code(error.kind());
    if (!report.has_errors()) {
      LintFinding finding;
      finding.code = error.kind() == ErrorKind::resource_limit ? reason::beyond_limits : reason::cannot_mesh;
      finding.where = printable(path);
      finding.place = "the garment";
      finding.expected = "what `dress` takes";
      finding.got = error.what();
      finding.repair = "refused: what is meant cannot be known";
      report.findings.insert(report.findings.begin(), std::move(finding));
    }
  }
  if (checked.error.empty() && report.has_errors()) {
    const auto first = std::find_if(report.findings.begin(), report.findings.end(),
                                    [](const auto& f) { return f.severity == Severity::error; });
    checked.error = InputError(first->where, first->place, first->expected, first->got).what();
    checked.code = ExitCode::bad_input;
  }
  if (!checked.error.empty()) checked.said = "pattern, cannot be used\n";
  checked.findings = report.findings;
  checked.said += notes + describe_findings(report.findings);
  if (!line.svg.empty()) {
    write_whole(line.svg, draw_pattern(report.drawing, report.findings));
    checked.said += "  drawn: " + printable(line.svg) + '\n';
  }
  if (!line.repair.empty()) checked.said += write_mended(line, text, report, checked);
  if (!checked.error.empty()) json = before;
  return checked;
}

void write_findings(const Checked& checked, JsonText& json) {
  json.key("findings");
  json.begin_array();
  for (const LintFinding& finding : checked.findings) {
    json.begin_object();
    json.member("code", finding.code);
    json.member("severity", to_string(finding.severity));
    json.member("where", finding.where);
    json.member("pointer", finding.pointer);
    json.member("place", finding.place);
    json.key("marks");
    json.begin_array();
    for (const LintMark& mark : finding.marks) {
      json.begin_object();
      json.member("panel", mark.panel);
      json.member("edge", mark.edge);
      json.member("x_cm", 100 * mark.at_m.x());
      json.member("y_cm", 100 * mark.at_m.y());
      json.end_object();
    }
    json.end_array();
    json.member("expected", finding.expected);
    json.member("got", finding.got);
    json.member("repairable", finding.mended);
    json.member("repair", finding.repair);
    json.end_object();
  }
  json.end_array();
  json.key("mended_file");
  if (checked.mended_file.empty()) {
    json.null();
  } else {
    json.value(checked.mended_file);
  }
}

void refuse_other_files(const CommandLine& line, bool is_pattern, const std::string& path) {
  const std::pair<const std::string&, const char*> options[] = {
      {line.svg, "--svg"}, {line.repair, "--repair"}, {line.body, "--body"}, {line.measurements, "--measurements"}};
  for (const auto& [value, option] : options)
    if (!value.empty() && !is_pattern)
      throw Error(ErrorKind::usage, std::string(option) + ": " + printable(path) + " is no pattern");
}

}  // namespace toile::internal
