// apps/cli/simulate_command.cpp: `toile demo`, `toile dress` and `toile run`: from a scene, wherever it comes from, to a run.
#include "commands.hpp"
#include "core/parallel.hpp"
#include "embedded.hpp"
#include "io/file.hpp"
#include "sim/json_text.hpp"
#include "sim/picture_run.hpp"
#include "sim/simulate.hpp"
#include "terminal.hpp"

#include <array>
#include <cstdio>
#include <filesystem>
#include <vector>

namespace toile {
namespace {

struct Demo {
  std::string_view name, what;
};
constexpr std::array<Demo, 4> demos = {{{"tshirt", "a T-shirt sewn around the mannequin (the default)"},
                                        {"skirt", "an A-line skirt on the mannequin"},
                                        {"cylinder", "a square cloth falls over a cylinder [BW98, figure 1]"},
                                        {"sheet", "the same cloth, held by two corners"}}};

std::string embedded_text(const std::string& path) {
  for (const EmbeddedFile& file : embedded_files())
    if (file.path == path) return std::string(file.text);
  throw IoError(path, "not built into this program");
}

bool is_demo(const Demo& demo) {
  for (const EmbeddedFile& file : embedded_files())
    if (file.path == "scenes/" + std::string(demo.name) + ".json") return true;
  return false;
}

ExitCode list_demos(const CommandLine& line) {
  JsonText json(0);
  std::string text;
  json.begin_object();
  json.key("demos");
  json.begin_array();
  for (const Demo& demo : demos) {
    if (!is_demo(demo)) continue;
    json.begin_object();
    json.member("name", demo.name);
    json.member("description", demo.what);
    json.end_object();
    text += std::string(demo.name) + std::string(12 - demo.name.size(), ' ') + std::string(demo.what) + '\n';
  }
  json.end_array();
  json.end_object();
  print(line.json ? json.str() + '\n' : text);
  return ExitCode::ok;
}

Scene demo_scene(const CommandLine& line) {
  const std::string name = line.inputs.empty() ? "tshirt" : line.inputs.front();
  std::vector<std::string_view> names;
  for (const Demo& demo : demos) {
    if (!is_demo(demo)) continue;
    if (demo.name == name) {
      const std::string path = "scenes/" + name + ".json";
      return parse_scene(embedded_text(path), path);
    }
    names.push_back(demo.name);
  }
  throw Error(ExitCode::usage, "demo: expected one of toile demo --list; nearest is \"" +
                                   std::string(nearest_name(name, names.data(), names.size())) + "\", got \"" +
                                   printable(name) + '"');
}

Scene dress_scene(const CommandLine& line) {
  if (!line.motion.empty()) throw Error(ExitCode::usage, "--motion: moving bodies are not available yet");
  if (line.inputs.size() > 1)
    throw Error(ExitCode::usage, "dress: expected one pattern (several garments are not available yet), got " +
                                     std::to_string(line.inputs.size()));
  Scene scene;
  SceneCloth cloth;
  cloth.pattern = line.inputs.front();
  scene.name = std::filesystem::path(cloth.pattern).stem().string();
  constexpr std::string_view garmentcode = "_specification";
  if (scene.name.ends_with(garmentcode)) scene.name.resize(scene.name.size() - garmentcode.size());
  if (scene.name.empty()) scene.name = "garment";
  scene.cloth.push_back(std::move(cloth));
  scene.until_still = true;
  scene.seconds = 10;  // a limit: most garments are still after three or four
  if (line.body == "mannequin") {
    scene.body.kind = SceneBody::Kind::mannequin;
    if (!line.body_unit.empty()) throw Error(ExitCode::usage, "--body-unit: the mannequin is in metres");
  } else {
    scene.body.kind = SceneBody::Kind::mesh;
    scene.body.mesh = line.body;
    if (line.body_unit == "m") scene.body.unit = LengthUnit::m;
    if (line.body_unit == "dm") scene.body.unit = LengthUnit::dm;
    if (line.body_unit == "cm") scene.body.unit = LengthUnit::cm;
  }
  scene.strict_start = line.strict_start;
  return scene;
}

Scene scene_of(const CommandLine& line) {
  Scene scene;
  switch (line.command) {
    case CommandLine::Command::demo:
      scene = demo_scene(line);
      break;
    case CommandLine::Command::dress:
      scene = dress_scene(line);
      break;
    default:
      scene = parse_scene(read_text_file(line.inputs.front()), line.inputs.front());
      break;
  }
  SceneCloth& cloth = scene.cloth.front();
  if (line.fabric) cloth.fabric = fabric_preset(*line.fabric, "", "--fabric");
  if (line.resolution_cm) cloth.resolution_m = 0.01 * *line.resolution_cm;
  if (line.resolution_cm && cloth.grid) cloth.grid->edge_m = 0.01 * *line.resolution_cm;
  if (line.fps) scene.fps = *line.fps;
  if (line.seconds) scene.seconds = *line.seconds;
  return scene;
}

std::string directory_of(const CommandLine& line, const Scene& scene) {
  if (!line.out.empty()) return line.out;
  if (!scene.output_dir.empty()) return scene.output_dir;
  std::string name = scene.name;
  for (char& c : name)
    if (c == '/' || static_cast<unsigned char>(c) < 0x20) c = '_';
  if (name == "." || name == "..") name = "scene";
  return "out/" + name;
}

std::string summary(const Report& report, const std::string& directory) {
  std::array<char, 1024> text;
  const PhaseReport& drape = report.drape;
  std::string out = directory + ": " + (report.verdict.pass ? "pass" : "fail") + " (ended: " + report.ended + ")\n";
  for (const Reason& reason : report.verdict.reasons) out += "  " + reason.code + ": " + reason.detail + '\n';
  for (const std::string& warning : report.warnings) out += "  warning: " + warning + '\n';
  std::snprintf(text.data(), text.size(),
                "  %d vertices, %d triangles, %d panels, %d seams; body %d vertices\n"
                "  %d frames, %ld steps (%ld rejected), %.3f s per frame; sewing %.1f s; total %.1f s; %d threads\n",
                report.vertices, report.triangles, report.panels, report.seams, report.body_vertices, report.frames,
                drape.steps, drape.steps_rejected, drape.frames > 0 ? drape.seconds / drape.frames : 0.0,
                report.sewing.seconds, report.seconds_total, report.threads);
  out += text.data();
  if (report.frames == 0) return out;
  std::snprintf(text.data(), text.size(),
                "  last frame: %d edges cloth-body, %d cloth-cloth; stretch p50 %.2f %%, p99 %.2f %%, max %.2f %%; "
                "still %.2f mm/s\n"
                "  state %s\n",
                report.audit.cloth_body_edges.last, report.audit.cloth_cloth_edges.last, 100 * report.audit.stretch.p50,
                100 * report.audit.stretch.p99, 100 * report.audit.stretch.max, report.audit.still_mm_per_s_p99,
                report.state_hash.c_str());
  return out + text.data();
}

}  // namespace

ExitCode simulate_command(const CommandLine& line) {
  if (line.list) return list_demos(line);
  const Scene scene = scene_of(line);
  ProgressBar bar(line);
  RunOptions options;
  options.directory = directory_of(line, scene);
  options.command = line.typed;
  if (line.command == CommandLine::Command::demo) options.read = embedded_text;
  options.progress = [&](const Progress& progress) { bar.show(progress); };
  options.stop = interrupted;
  const Report report = simulate(scene, options);
  ExitCode code = exit_code(report);

  const bool wanted = scene.preview.value_or(line.command != CommandLine::Command::run) && !line.no_preview;
  std::string picture_error;
  if (wanted && code != ExitCode::interrupted) {
    // The run is complete without its pictures; what goes wrong here is told, and does not take the result away.
    try {
      picture_run(
          options.directory, {},
          [&](double share) {
            bar.show({"picturing", share, -1});
          },
          interrupted);
    } catch (const Error& error) {
      picture_error = error.what();
      if (code == ExitCode::ok) code = error.code();
    }
  }
  bar.clear();
  if (!picture_error.empty()) std::fprintf(stderr, "toile: preview: %s\n", picture_error.c_str());
  if (line.json) {
    print(to_json(report, 2) + '\n');
  } else if (!line.quiet) {
    print(summary(report, options.directory));
  }
  if (!report.verdict.pass) {
    const Reason& reason = report.verdict.reasons.front();
    std::fprintf(stderr, "toile: %s: %s: %s\n", options.directory.c_str(), reason.code.c_str(), reason.detail.c_str());
  }
  return code;
}

}  // namespace toile
