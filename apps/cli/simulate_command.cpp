// apps/cli/simulate_command.cpp: `toile demo`, `toile dress` and `toile run`: from a scene of any origin to a run.
#include "body/motion.hpp"
#include "body_option.hpp"
#include "commands.hpp"
#include "core/parallel.hpp"
#include "core/stopwatch.hpp"
#include "embedded.hpp"
#include "io/bvh.hpp"
#include "io/file.hpp"
#include "io/json_text.hpp"
#include "io/mesh_file.hpp"
#include "io/run_folder.hpp"
#include "output_folder.hpp"
#include "preview/preview.hpp"
#include "sim/body_figure.hpp"
#include "sim/fabric_file.hpp"
#include "sim/picture_run.hpp"
#include "sim/picture_state.hpp"
#include "sim/simulate.hpp"
#include "terminal.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <vector>

namespace toile::internal {
namespace {

struct Demo {
  std::string_view name, what;
};
constexpr std::array<Demo, 10> demos = {
    {{"tshirt", "a T-shirt sewn around a woman, who then walks (the default)"},
     {"skirt", "an A-line skirt on the mannequin"},
     {"cylinder", "a square cloth falls over a cylinder"},
     {"sheet", "the same cloth, held by two corners"},
     {"fig1-drape", "figure 1 of the paper: cloth draping on a cylinder, frames 8, 13 and 35"},
     {"fig2-sheet", "figure 2: a sheet held at two corners, frames 10, 29 and 67"},
     {"fig3-twist", "figure 3: a shirt on a twisting man, frames 1, 24 and 46"},
     {"fig4-walk", "figure 4: shirt and pants on a walking man, frames 30, 45 and 58"},
     {"fig5-short-skirt", "figure 5: short skirt and blouse on a dancer, frames 110, 136 and 155"},
     {"fig6-long-skirt", "figure 6: long skirt and blouse on a dancer, frames 185, 215 and 236"}}};

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
    text += std::string(demo.name) + std::string(18 - demo.name.size(), ' ') + std::string(demo.what) + '\n';
  }
  json.end_array();
  json.end_object();
  print(line.json ? json.str() + '\n' : text);
  return ExitCode::ok;
}

SceneFile demo_scene(const CommandLine& line) {
  const std::string name = line.inputs.empty() ? "tshirt" : line.inputs.front();
  std::vector<std::string_view> names;
  for (const Demo& demo : demos) {
    if (!is_demo(demo)) continue;
    if (demo.name == name) {
      const std::string path = "scenes/" + name + ".json";
      return read_scene(embedded_text(path), path);
    }
    names.push_back(demo.name);
  }
  throw Error(ErrorKind::usage, "demo: expected one of toile demo --list; nearest is \"" +
                                    std::string(nearest_name(name, names.data(), names.size())) + "\", got \"" +
                                    printable(name) + '"');
}

std::string name_of_pattern(const std::string& path) {
  std::string name = std::filesystem::path(path).stem().string();
  constexpr std::string_view garmentcode = "_specification";
  if (name.ends_with(garmentcode)) name.resize(name.size() - garmentcode.size());
  return name.empty() ? "garment" : name;
}

// A text that cannot be a file's name is a misspelt motion; a missing mesh file is reported when it is read.
bool looks_like_a_file(const std::string& text) {
  return is_point_cache(text) || moves_a_skeleton(text) || text.find_first_of("/%") != std::string::npos ||
         std::filesystem::exists(text);
}

SceneCollider dress_body(const CommandLine& line) {
  SceneCollider body = body_option(line);
  const bool mannequin = body.as<SceneMannequin>() != nullptr;
  if (mannequin && !line.body_unit.empty()) throw Error(ErrorKind::usage, "--body-unit: mannequins are in metres");
  if (!line.clip.empty() && !has_animated_ending(line.motion))
    throw Error(ErrorKind::usage, "--clip: expected --motion with a glTF file beside it");
  if (!line.bones.empty() && !has_bvh_ending(line.motion))
    throw Error(ErrorKind::usage, "--bones: expected --motion with a BVH file beside it");
  if (line.motion.empty()) return body;
  SceneMotion motion;
  const auto names = motion_names(), of_a_mesh = motion_names_without_skeleton();
  const auto among = [&](std::span<const std::string_view> some) {
    return std::find(some.begin(), some.end(), line.motion) != some.end();
  };
  if (!mannequin && !among(of_a_mesh) && (among(names) || !looks_like_a_file(line.motion)))
    throw Error(ErrorKind::usage,
                "--motion: expected " + std::string(motions_for_a_mesh) + "; got \"" + printable(line.motion) + '"');
  if (mannequin && !among(names) && !std::filesystem::exists(line.motion))
    throw Error(ErrorKind::usage, "--motion: expected a motion or a file; nearest is \"" +
                                      std::string(nearest_name(line.motion, names.data(), names.size())) +
                                      "\", got \"" + printable(line.motion) + '"');
  if (among(names)) motion.name = line.motion;
  if (motion.name.empty()) {
    motion.path = line.motion;
    motion.clip = line.clip;
    motion.bones = line.bones;
    motion.fps = line.fps.value_or(motion.fps);
  }
  body.motion = std::move(motion);
  return body;
}

Scene dress_scene(const CommandLine& line) {
  Scene scene;
  scene.name.clear();
  for (const std::string& pattern : line.inputs) {
    SceneCloth cloth;
    cloth.kind = ScenePattern{pattern, {}};
    if (line.inputs.size() > 1) {
      cloth.name = name_of_pattern(pattern);
      const auto taken = [&](const SceneCloth& other) { return other.name == cloth.name; };
      if (std::any_of(scene.cloth.begin(), scene.cloth.end(), taken))
        cloth.name.append("-").append(std::to_string(scene.cloth.size() + 1));
    }
    if (!scene.name.empty()) scene.name += '+';
    scene.name += name_of_pattern(pattern);
    scene.cloth.push_back(std::move(cloth));
  }
  scene.until_still = true;
  scene.body = dress_body(line);
  if (!scene.body.motion) scene.seconds = Scene::longest_dress_s;
  scene.strict_start = line.strict_start;
  return scene;
}

// Applies --quality; options for single values override it later.
void set_quality(const std::string& quality, Scene& scene) {
  struct Quality {
    std::string_view name;
    double resolution_m, step_max_s, tolerance;
  };
  static constexpr std::array<Quality, 3> qualities = {
      {{"draft", 0.02, 1.0 / 30, 3e-2}, {"good", 0.01, 1.0 / 60, 1e-2}, {"final", 0.007, 1.0 / 120, 1e-3}}};
  for (const Quality& q : qualities) {
    if (q.name != quality) continue;
    for (SceneCloth& cloth : scene.cloth) {
      cloth.set_edge_m(q.resolution_m);
    }
    scene.step_max_s = q.step_max_s;
    scene.tolerance = q.tolerance;
  }
}

}  // namespace

SceneFile scene_of(const CommandLine& line) {
  SceneFile file;
  switch (line.command) {
    case CommandLine::Command::demo:
      file = demo_scene(line);
      break;
    case CommandLine::Command::dress:
      file.scene = dress_scene(line);
      break;
    default:
      file = read_scene(read_text_file(line.inputs.front()), line.inputs.front());
      break;
  }
  Scene& scene = file.scene;
  set_quality(line.quality, scene);
  for (SceneCloth& cloth : scene.cloth) {
    if (line.fabric) cloth.fabric = fabric_of(*line.fabric, "--fabric");
    if (line.resolution_cm) cloth.set_edge_m(0.01 * *line.resolution_cm);
    if (auto* pattern = std::get_if<ScenePattern>(&cloth.kind)) {
      if (line.hem_mm) pattern->finish.hem_m = 1e-3 * *line.hem_mm;
      if (line.tape_mm) pattern->finish.tape_m = 1e-3 * *line.tape_mm;
      if (line.allowance_mm) pattern->finish.allowance_m = 1e-3 * *line.allowance_mm;
      if (line.topstitched) pattern->finish.topstitched = true;
    }
  }
  if (!line.start.empty()) scene.start = line.start;
  if (line.fps) scene.fps = *line.fps;
  if (line.seconds) {
    scene.seconds = *line.seconds;
    scene.seconds_given = true;
  }
  return file;
}

namespace {

// A build without pictures refuses a user's scene that asks for them, before hours are spent on it; `demo` and `dress` make pictures by default,
// and do without.
bool wants_pictures(const CommandLine& line, const Scene& scene) {
  const bool asked = line.command == CommandLine::Command::run;
  const bool wanted = scene.preview.value_or(!asked) && !line.no_preview;
  if (!wanted || can_draw()) return wanted;
  if (asked)
    throw Error(ErrorKind::usage,
                "/output/preview of the scene asks for pictures, and this Toile is built without "
                "pictures (--no-preview runs the scene without)");
  if (!line.quiet)
    std::fprintf(stderr, "toile: built without pictures: there will be no preview.png and preview.mp4\n");
  return false;
}

// One view of the last frame, for lists of many runs.
void draw_thumbnail(const std::string& directory) {
  constexpr StillOptions small{144, 192, 6, 25, 8};  // a few kilobytes, and a tenth of a second
  const RunFolder folder(directory, RunFolder::Use::pictures, {}, {});
  const std::string png = picture_last_frame(directory, small);
  AtomicFile file(folder.path("thumbnail.png"));
  file.write(png);
  file.commit();
}

// For `dress`: an unattended run must not take a quarter of an hour.
constexpr double default_time_limit_s = 300;

std::string summary(const Report& report, const std::string& directory) {
  const PhaseReport& drape = report.drape;
  std::string out = directory + ": " + judgement_line(report.verdict) + " (ended: " + report.ended + ")\n" +
                    judgement_details(report.verdict);
  for (const std::string& warning : report.warnings) out += "  warning: " + warning + '\n';
  out += fmt::sprintf(
      "  %d vertices, %d triangles, %d panels, %d seams; body %d vertices\n"
      "  %d frames, %ld steps (%ld rejected), %.3f s per frame; sewing %.1f s; total %.1f s; %d threads\n",
      report.vertices, report.triangles, report.panels, report.seams, report.body_vertices, report.frames, drape.steps,
      drape.steps_rejected, drape.frames > 0 ? drape.seconds / drape.frames : 0.0, report.sewing.seconds,
      report.seconds_total, report.threads);
  if (report.frames == 0) return out;
  out += slip_line(report.audit.slip);
  return out + fmt::sprintf(
                   "  last frame: %d edges cloth-body, %d cloth-cloth; stretch p50 %.2f %%, p99 %.2f %%, max %.2f %%; "
                   "still %.2f mm/s\n"
                   "  state %s\n",
                   report.audit.cloth_body_edges.last, report.audit.cloth_cloth_edges.last,
                   100 * report.audit.stretch.p50, 100 * report.audit.stretch.p99, 100 * report.audit.stretch.max,
                   report.audit.still_mm_per_s_p99, report.state_hash.c_str());
}

void draw_pictures(const std::string& directory, const Scene& scene, ProgressBar& bar) {
  const RunFolder folder(directory, RunFolder::Use::pictures, {}, {});
  PictureOptions pictures;
  pictures.frames = scene.picture_frames;
  picture_run(
      directory, pictures,
      [&](double share) {
        bar.show({"picturing", share, -1});
      },
      interrupted);
}

ExitCode run_scene(const CommandLine& line, const Scene& scene, const Stopwatch& since_start) {
  if (line.thumbnail) require_pictures();
  const bool pictures_wanted = wants_pictures(line, scene);
  ProgressBar bar(line);
  RunOptions options;
  options.directory = output_folder(line, scene);
  options.command = line.typed;
  options.arguments = line.words;
  if (line.command == CommandLine::Command::run) options.inputs = line.inputs;
  if (line.fabric && names_a_fabric_file(*line.fabric)) options.inputs.push_back(*line.fabric);
  options.resume = line.resume;
  options.checkpoints.every_frames = line.checkpoint_frames.value_or(0);
  options.seconds_before = since_start.seconds();
  if (line.command == CommandLine::Command::demo) {
    options.read = embedded_text;
    options.built_in = true;
  }
  options.progress = [&](const Progress& progress) { bar.show(progress); };
  options.stop = interrupted;
  options.limits = line.limits;
  const bool dresses = line.command == CommandLine::Command::dress;
  options.time_limit_s = line.time_limit_s.value_or(dresses ? default_time_limit_s : 0);
  const Report report = simulate(scene, options);
  ExitCode code = exit_code(outcome(report));

  std::string picture_error;
  if ((pictures_wanted || line.thumbnail) && code != ExitCode::interrupted) {
    // The run is complete without its pictures: errors here are reported, and do not discard the result.
    try {
      if (line.thumbnail && (report.frames > 0 || report.sewing.frames > 0)) draw_thumbnail(options.directory);
      if (pictures_wanted) draw_pictures(options.directory, scene, bar);
    } catch (const Error& error) {
      picture_error = error.what();
      if (code == ExitCode::ok) code = exit_code(error.kind());
    }
  }
  bar.clear();
  if (!picture_error.empty()) std::fprintf(stderr, "toile: preview: %s\n", picture_error.c_str());
  if (line.json) {
    print(to_json(report, 2) + '\n');
  } else if (!line.quiet) {
    print(summary(report, options.directory));
  }
  tell_failure(options.directory, report.verdict);
  return code;
}

}  // namespace

ExitCode simulate_command(const CommandLine& line) {
  const Stopwatch since_start;
  if (line.list) return list_demos(line);
  const SceneFile file = scene_of(line);
  return file.places.complete_errors_of([&] { return run_scene(line, file.scene, since_start); });
}

}  // namespace toile::internal
