#include "command_line.hpp"

#include "core/error.hpp"
#include "sim/export_run.hpp"
#include "sim/report.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace toile::internal {
namespace {

void add_common(CLI::App& command, CommandLine& line) {
  command.add_option("--out", line.out, "Directory of the run's files (default: ./out/NAME)");
  command.add_option("--threads", line.threads, "Threads; 0: one per core. The result does not depend on it")
      ->check(CLI::Range(0, 1024));
  command.add_flag("--no-preview", line.no_preview, "No pictures");
  command.add_flag("--quiet", line.quiet, "Print errors only");
  command.add_flag("--json", line.json, "Print the result as one JSON object");
}

void add_checkpoint_option(CLI::App& command, CommandLine& line) {
  command
      .add_option("--checkpoint-frames", line.checkpoint_frames,
                  "Keep the state every so many frames (default: every second)")
      ->check(CLI::Range(1, 1000000));
}

void add_limits(CLI::App& command, CommandLine& line) {
  command
      .add_option("--max-memory", line.limits.memory_mb,
                  "Refuse what is estimated to take more, MB (default: what there is)")
      ->check(CLI::Range(1.0, 1e12));
  command.add_option("--max-frames", line.limits.frames, "Refuse what may take more frames, sewing included")
      ->check(CLI::Range(1.0, 1e12))
      ->capture_default_str();
  command.add_option("--max-hours", line.limits.hours, "Refuse what is estimated to take longer, hours")
      ->check(CLI::Range(1e-6, 1e12))
      ->capture_default_str();
}

void add_unit_option(CLI::App& command, CommandLine& line, const std::string& what) {
  command.add_option("--body-unit", line.body_unit, what)->check(CLI::IsMember({"m", "dm", "cm", "mm", "in"}));
}

void add_up_option(CLI::App& command, CommandLine& line) {
  command
      .add_option("--body-up", line.body_up, "Axis of the body's file that points up (default: as it is seen to stand)")
      ->check(CLI::IsMember({"y", "z"}));
}

void add_untangle_options(CLI::App& command, CommandLine& line) {
  command.add_option("CLOTH", line.inputs, "Cloth mesh (OBJ, PLY, STL, glTF)")->required()->expected(1);
  command.add_option("--body", line.body,
                     "Body mesh (OBJ, PLY, STL, glTF), or a mannequin: woman (also: mannequin), dancer, man");
  add_unit_option(command, line, "Unit of both files");
  command.add_option("--out", line.out, "Where the cloth goes (default: out/NAME_untangled.obj)");
  command.add_option("--threads", line.threads, "Threads; 0: one per core. The result does not depend on it")
      ->check(CLI::Range(0, 1024));
  command.add_flag("--quiet", line.quiet, "Print errors only");
  command.add_flag("--json", line.json, "Print the result as one JSON object");
}

void add_export_options(CLI::App& command, CommandLine& line) {
  command.add_option("DIR", line.inputs, "Directory of the run")->required()->expected(1);
  command.add_option("--to", line.to, "Format: " + export_formats_in_words() + " (default: by the ending of --out)");
  CLI::Option* const frame = command.add_option("--frame", line.export_frame, "Frame of the cloth (default: the last)")
                                 ->check(CLI::Range(0, 1000000000));
  command.add_flag("--all", line.all, "Every frame, in numbered files of a folder, or in one .glb")->excludes(frame);
  command.add_option("--of", line.of, "cloth, body, or both of usda (default: cloth)")
      ->check(CLI::IsMember({"cloth", "body", "both"}));
  command.add_option("--out", line.out, "A file; with --all a folder (default: out/NAME.ENDING, out/NAME_FORMAT)");
  command.add_option("--threads", line.threads, "Threads; 0: one per core. The result does not depend on it")
      ->check(CLI::Range(0, 1024));
  command.add_flag("--quiet", line.quiet, "Print errors only");
  command.add_flag("--json", line.json, "Print the result as one JSON object");
}

void add_fit_fabric_options(CLI::App& command, CommandLine& line) {
  command.add_option("MEASUREMENTS", line.inputs, "Figures of a textile laboratory, JSON")->required()->expected(1);
  command.add_option("--out", line.out, "Write the fabric here, for --fabric: NAME.json (default: print it only)");
  command.add_flag("--quiet", line.quiet, "Print errors only");
  command.add_flag("--json", line.json, "Print the result as one JSON object");
}

void add_batch_options(CLI::App& command, CommandLine& line) {
  command.add_option("JOBS", line.inputs, "Job file: one JSON object per line")->required()->expected(1);
  command.add_option("--out", line.out, "Directory of the batch (default: ./out/NAME)");
  command.add_option("--paths-from", line.paths_from,
                     "Where relative paths of jobs begin (default: the folder of the job file)");
  command.add_option("--jobs", line.processes, "Jobs at a time, each a process; 0: one per core")
      ->check(CLI::Range(0, 1024));
  CLI::Option* const lines = command.add_option(
      "--lines", line.lines, "Only these lines of the file, 7 or 1-100; without the batch's own files");
  command.add_flag("--collect", line.collect, "Run nothing: verdicts, index and page of the runs that are there")
      ->excludes(lines);
  command.add_option("--limit-seconds", line.limit_seconds, "End a job that takes longer; a line may say otherwise")
      ->check(CLI::Range(0.0, 1e9));
  command.add_option("--limit-memory", line.limit_mb, "Refuse a job more memory, MB; a line may say otherwise")
      ->check(CLI::Range(0.0, 1e9));
  command.add_flag("--quiet", line.quiet, "Print errors only");
  command.add_flag("--json", line.json, "Print the result as one JSON object");
}

void add_garment_options(CLI::App& command, CommandLine& line) {
  command.add_option("--fabric", line.fabric,
                     "a preset: silk, cotton, wool, denim, knit, chiffon, satin, jersey, rib, poplin, linen, flannel, "
                     "suiting, canvas, leather or neoprene; or a file of fit-fabric, NAME.json");
  command.add_option("--resolution", line.resolution_cm, "Edge length of the cloth's triangles, cm")
      ->check(CLI::Range(0.1, 20.0));
  command.add_option("--hem", line.hem_mm, "Width of a hem on a pattern's open edges, mm (default: none)")
      ->check(CLI::Range(0.0, 200.0));
  command.add_option("--tape", line.tape_mm, "Width of a tape on open edges with a label, mm (default: 10)")
      ->check(CLI::Range(0.0, 200.0));
  command
      .add_option("--allowance", line.allowance_mm, "Width of the allowances on a pattern's seams, mm (default: none)")
      ->check(CLI::Range(0.0, 200.0));
  command.add_flag("--topstitched", line.topstitched, "The seam allowances are stitched down");
  command.add_option("--fps", line.fps, "Frames per second of the output")->check(CLI::Range(1.0, 1000.0));
  command.add_option("--quality", line.quality, "draft, good or final: resolution, step and tolerance")
      ->check(CLI::IsMember({"draft", "good", "final"}));
  command.add_option("--start", line.start, "Directory of a run: begin where it ended, without sewing again");
  command.add_option("--seconds", line.seconds, "Longest drape, or length of the motion, s")
      ->check(CLI::Range(0.001, 3600.0));
  add_checkpoint_option(command, line);
}

// `toile bench KIND`: each kind only has the options that affect it.
CLI::App* add_bench(CLI::App& app, CommandLine& line) {
  CLI::App* bench = app.add_subcommand("bench", "Measure times, beside those of 1998");
  bench->require_subcommand(0, 1);  // no kind is an error with a message below
  CLI::App* scaling = bench->add_subcommand("scaling", "Time per frame of a drape over its number of particles");
  scaling->add_option("--sizes", line.sizes, "Particles, 500,899,2602,7359 (the default)")
      ->delimiter(',')
      ->check(CLI::Range(50, 1000000));
  CLI::App* stiffness = bench->add_subcommand("stiffness", "Time and iterations of a drape over bend and stretch");
  CLI::App* paper = bench->add_subcommand("paper", "The table of the paper, row by row, and two figures from its text");
  paper->add_option("--rows", line.rows, "Rows 1 to 9, \"cg\" and \"explicit\" (default: all)")
      ->delimiter(',')
      ->check(CLI::IsMember({"1", "2", "3", "4", "5", "6", "7", "8", "9", "cg", "explicit"}));
  CLI::App* micro = bench->add_subcommand("micro", "Times of the pieces of a step");
  micro->add_option("--limits", line.limit_sizes, "Particles of the table of limits, 2602,8800,100000 (the default)")
      ->delimiter(',')
      ->check(CLI::Range(50, 1000000));
  paper->add_option("--step-max-ms", line.step_max_ms, "Longest step (default: each row's own, which is the paper's)")
      ->check(CLI::Range(0.01, 1000.0));
  CLI::App* torture = bench->add_subcommand("torture", "Scenes that break cloth simulators: which hold");
  torture->add_option("--scenes", line.rows, "By their numbers, 01,12 (default: all)")->delimiter(',');
  torture->add_option("--size", line.torture_size, "S, M or L")->check(CLI::IsMember({"S", "M", "L"}));
  torture
      ->add_option("--starts", line.starts, "Start so often; the first is the scene as it is, the others are jittered")
      ->check(CLI::Range(1, 1000));
  torture->add_option("--first-start", line.first_start, "The first of them")->check(CLI::Range(0, 1000000));
  for (CLI::App* kind : {stiffness, micro})
    kind->add_option("--size", line.sizes, "Particles (default: 2602)")->expected(1)->check(CLI::Range(50, 1000000));
  for (CLI::App* kind : {paper, scaling, stiffness, micro, torture}) {
    add_common(*kind, line);
    CLI::Option* json = kind->get_option("--json");
    kind->add_flag("--csv", line.csv, "Print the result as CSV")->excludes(json);
    kind->add_option("--repeat", line.repeats, "Measure so often and keep the fastest")->check(CLI::Range(1, 1000));
  }
  for (CLI::App* kind : {paper, scaling, stiffness, torture})
    kind->add_option("--frames", line.bench_frames, "Frames of each run; fewer than the paper's are for a first look")
        ->check(CLI::Range(1, 100000));
  return bench;
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return printable(text);
}

struct Commands {
  CLI::App *demo, *dress, *run, *check, *verify, *preview, *resume, *untangle, *export_run, *fit_fabric, *bench, *batch;
};

// `demo_name` gets the argument of `demo`.
Commands add_commands(CLI::App& app, CommandLine& line, std::string& demo_name) {
  CLI::App* demo = app.add_subcommand("demo", "Run a scene that is built in: no files needed");
  demo->add_option("NAME", demo_name, "Name of the demo (default: tshirt)");
  demo->add_flag("--list", line.list, "List the demos");
  add_garment_options(*demo, line);

  CLI::App* dress = app.add_subcommand("dress", "Sew a pattern around a body and drape it");
  dress->add_option("PATTERN", line.inputs, "Pattern files, GarmentCode JSON, from the inside out")->required();
  dress
      ->add_option("--body", line.body,
                   "Body mesh (OBJ, PLY, STL, glTF), or a mannequin: woman (also: mannequin), dancer, man")
      ->required();
  add_unit_option(*dress, line, "Unit of the body's file");
  add_up_option(*dress, line);
  dress->add_option("--measurements", line.measurements,
                    "Measurements of the body's mesh, YAML (default: the file of its name beside it)");
  dress->add_option("--motion", line.motion,
                    "Motion: stand, sway, walk, twist, crouch, dance; for a mesh stand, sway, twist, a .pc2 or .mdd "
                    "file, a folder of numbered mesh files, and for a body with a skeleton a glTF or a BVH file");
  dress->add_option("--clip", line.clip, "Animation of the motion's glTF file: its name, or its number from 0");
  dress->add_option("--bones", line.bones,
                    "Which joints of a BVH file and of the body are which part of a person, JSON");
  dress->add_option("--rig", line.rig, "Skeleton of a mesh that has none of its own: a rig of MakeHuman's, JSON");
  dress->add_option("--weights", line.weights,
                    "Skin weights of the rig, JSON (default: weights.NAME.json beside rig.NAME.json)");
  dress->add_option("--target", line.targets, "Change of the mesh's shape, MakeHuman's: FILE or FILE=SHARE; repeatable")
      ->allow_extra_args(false);
  dress->add_flag("--strict-start", line.strict_start, "End with exit code 4 when the start already intersects");
  add_garment_options(*dress, line);

  CLI::App* run = app.add_subcommand("run", "Run a scene file");
  run->add_option("SCENE", line.inputs, "Scene file")->required()->expected(1);
  add_garment_options(*run, line);

  CLI::App* check = app.add_subcommand("check", "Check scenes, patterns and meshes; simulate nothing");
  check->add_option("FILE", line.inputs, "Scene or pattern (.json), mesh (.obj, .ply, .glb)")->required();
  check->add_option("--resolution", line.resolution_cm, "Edge length at which patterns are meshed, cm (default: 1)")
      ->check(CLI::Range(0.1, 20.0));
  check->add_option("--body", line.body, "Of a pattern: who is to wear it; a mesh, or a mannequin: woman, dancer, man");
  check->add_option("--measurements", line.measurements,
                    "Measurements of the body's mesh, YAML (default: the file of its name beside it)");
  check->add_option("--svg", line.svg, "Of one pattern: draw its panels here, with the places that were found");
  check->add_option("--repair", line.repair, "Of one pattern: write a copy here with what can be mended");
  add_unit_option(*check, line, "Unit of meshes that are bodies");
  add_up_option(*check, line);

  CLI::App* verify = app.add_subcommand("verify", "Audit a finished run");
  verify->add_option("DIR", line.inputs, "Directory of the run")->required()->expected(1);
  verify->add_flag("--picture", line.picture, "Draw the worst frame's crossings in red: DIR/crossings.png");

  CLI::App* preview = app.add_subcommand("preview", "Make preview.png and preview.mp4 of a finished run");
  preview->add_option("DIR", line.inputs, "Directory of the run")->required()->expected(1);
  preview->add_option("--frames", line.frames, "Frames of the motion (or of the cloth) to show side by side, 8,13,35")
      ->delimiter(',')
      ->check(CLI::Range(0, 1000000));
  preview
      ->add_option("--style", line.style,
                   "technical: cloth as simulated, with a grid along its threads; studio: smooth, thick, woven, sewn")
      ->check(CLI::IsMember({"technical", "studio"}))
      ->default_str("technical");
  preview->add_option("--looks", line.looks, "Colours and prints by panel, garment and fabric, JSON");
  preview
      ->add_option("--close-up", line.close_up_m, "30 cm around this point in the last frame, X,Y,Z in m: close-up.png")
      ->delimiter(',')
      ->expected(3);
  preview->add_flag("--no-film", line.no_film, "Stills only");
  preview->add_flag("--turntable", line.turntable, "Once around the last frame: turntable.mp4");

  CLI::App* resume = app.add_subcommand("resume", "Go on with a run that was interrupted, to the same bits");
  resume->add_option("DIR", line.inputs, "Directory of the run")->required()->expected(1);
  resume->add_option("--threads", line.threads, "Threads; 0: one per core. The result does not depend on it")
      ->check(CLI::Range(0, 1024));
  resume->add_flag("--no-preview", line.no_preview, "No pictures");
  resume->add_flag("--quiet", line.quiet, "Print errors only");
  resume->add_flag("--json", line.json, "Print the result as one JSON object");
  add_checkpoint_option(*resume, line);

  CLI::App* untangle =
      app.add_subcommand("untangle", "Move a cloth that passes through itself or a body until it does not");
  add_untangle_options(*untangle, line);

  CLI::App* export_run = app.add_subcommand("export", "Write frames of a run as files for other programs");
  add_export_options(*export_run, line);

  CLI::App* fit_fabric =
      app.add_subcommand("fit-fabric", "A fabric, with its uncertainty, from the figures of a textile laboratory");
  add_fit_fabric_options(*fit_fabric, line);

  CLI::App* batch = app.add_subcommand("batch", "Run many jobs, each in a process of its own");
  add_batch_options(*batch, line);

  CLI::App* bench = add_bench(app, line);
  for (CLI::App* command : {demo, dress, run, check, verify, preview}) add_common(*command, line);
  for (CLI::App* command : {demo, dress, run, check}) add_limits(*command, line);
  for (CLI::App* command : {demo, dress, run})
    command
        ->add_option("--time-limit", line.time_limit_s,
                     "Seconds that dressing may take, up to the motion; then what there is is written; 0: any")
        ->check(CLI::Range(0.0, 1e9));
  for (CLI::App* command : {demo, dress, run})
    command->add_flag("--thumbnail", line.thumbnail, "A small picture of the last frame: thumbnail.png");
  return {demo, dress, run, check, verify, preview, resume, untangle, export_run, fit_fabric, bench, batch};
}

// CLI::Range lets NaN pass.
void require_finite(const CommandLine& line) {
  for (const auto& [option, value] : {std::pair{"--resolution", line.resolution_cm},
                                      {"--hem", line.hem_mm},
                                      {"--tape", line.tape_mm},
                                      {"--allowance", line.allowance_mm},
                                      {"--fps", line.fps},
                                      {"--seconds", line.seconds},
                                      {"--max-memory", line.limits.memory_mb},
                                      {"--max-frames", line.limits.frames},
                                      {"--max-hours", line.limits.hours}})
    if (value && !std::isfinite(*value))
      throw Error(ErrorKind::usage, std::string(option) + ": expected a finite number");
}

void settle_bench(const CLI::App& bench, CommandLine& line) {
  if (bench.get_subcommands().empty())
    throw Error(ErrorKind::usage, "bench: expected paper, scaling, stiffness, micro or torture");
  line.inputs = {bench.get_subcommands().front()->get_name()};
  if (line.sizes.empty() && line.inputs.front() == "scaling") line.sizes = {500, 899, 2602, 7359};
  if (line.repeats == 0) line.repeats = line.inputs.front() == "micro" ? 9 : 1;
  if (line.sizes.empty()) line.sizes = {2602};
  if (line.limit_sizes.empty()) line.limit_sizes = {2602, 8800, 100000};
}

}  // namespace

bool wants_json(int argc, const char* const* argv) {
  return std::any_of(argv, argv + argc, [](const char* word) { return std::string_view(word) == "--json"; });
}

CommandLine parse_command_line(int argc, const char* const* argv) {
  CommandLine line;
  line.words.assign(argv + std::min(argc, 1), argv + argc);
  for (int i = 0; i < argc; ++i) line.typed += (i == 0 ? "" : " ") + std::string(i == 0 ? "toile" : argv[i]);

  CLI::App app("Toile: sewing pattern and body in, clothing out.", "toile");
  app.set_version_flag("--version", std::string(toile_version()));
  app.require_subcommand(0, 1);
  std::string name;

  const Commands known = add_commands(app, line, name);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    line.help = app.help();
    return line;
  } catch (const CLI::CallForVersion&) {
    line.help = std::string(toile_version()) + "\n";
    return line;
  } catch (const CLI::ParseError& error) {
    throw Error(ErrorKind::usage, one_line(error.what()) + " (toile --help lists what there is)");
  }
  if (app.get_subcommands().empty())
    throw Error(ErrorKind::usage,
                "a command is missing: demo, dress, run, check, verify, preview, resume, untangle, export, "
                "fit-fabric, batch or bench (toile --help)");

  const CLI::App* chosen = app.get_subcommands().front();
  require_finite(line);
  using Command = CommandLine::Command;
  const std::pair<const CLI::App*, Command> commands[] = {{known.demo, Command::demo},
                                                          {known.dress, Command::dress},
                                                          {known.run, Command::run},
                                                          {known.check, Command::check},
                                                          {known.verify, Command::verify},
                                                          {known.preview, Command::preview},
                                                          {known.resume, Command::resume},
                                                          {known.untangle, Command::untangle},
                                                          {known.export_run, Command::export_run},
                                                          {known.fit_fabric, Command::fit_fabric},
                                                          {known.bench, Command::bench},
                                                          {known.batch, Command::batch}};
  for (const auto& [command, value] : commands)
    if (command == chosen) line.command = value;
  if (chosen == known.bench) settle_bench(*known.bench, line);
  if (chosen == known.demo && !name.empty()) line.inputs = {name};
  return line;
}

}  // namespace toile::internal
