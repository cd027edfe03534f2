// apps/cli/export_command.cpp: `toile export`: frames of a run for other programs.
#include "commands.hpp"
#include "io/json_text.hpp"
#include "process_end.hpp"
#include "sim/export_run.hpp"
#include "terminal.hpp"

namespace toile::internal {

ExitCode export_command(const CommandLine& line) {
  ExportOptions options;
  options.to = line.to;
  options.out = line.out;
  options.of = line.of;
  options.frame = line.export_frame;
  options.all = line.all;
  bool stopped = false;
  const Exported exported = export_run(line.inputs.front(), options, [&] {
    stopped = interrupted();
    return !stopped;
  });
  JsonText json;
  json.begin_object();
  json.key("files");
  json.begin_array();
  for (const std::string& file : exported.files) json.value(file);
  json.end_array();
  json.member("vertices", exported.vertices);
  json.member("triangles", exported.triangles);
  json.member("frames", exported.frames);
  json.end_object();
  std::string said;
  for (const std::string& file : exported.files) said += file + '\n';
  if (line.json) {
    print(json.str() + '\n');
  } else if (!line.quiet) {
    print(said);
  }
  return stopped ? ExitCode::interrupted : ExitCode::ok;
}

}  // namespace toile::internal
