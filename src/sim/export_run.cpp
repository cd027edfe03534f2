#include "sim/export_run.hpp"

#include "core/error.hpp"
#include "io/file.hpp"
#include "io/json.hpp"
#include "io/mesh_writer.hpp"
#include "io/obj.hpp"
#include "io/pc2.hpp"
#include "io/run_folder.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

namespace toile::internal {
namespace {

namespace fs = std::filesystem;

const MeshWriter& writer_of(const ExportOptions& options) {
  const MeshWriter* const writer = options.to.empty() ? mesh_writer_for(options.out) : mesh_writer_named(options.to);
  if (writer == nullptr)
    throw Error(ErrorKind::usage,
                options.to.empty() ? "export: expected a format, " + mesh_writers_in_words() +
                                         ", or a file whose name ends as one of them"
                                   : "export: expected " + mesh_writers_in_words() + ", got " + printable(options.to));
  // Programs go by the extension: a .glb that is called .gltf opens in few of them.
  if (!options.all && !options.out.empty() && !options.out.ends_with(writer->ending))
    throw Error(ErrorKind::usage, "export: expected a file that ends in " + std::string(writer->ending) + ", got " +
                                      printable(options.out));
  return *writer;
}

// The fabrics by garment and panel, where the report lists them.
std::map<std::pair<std::string, std::string>, std::string> fabrics_of(const fs::path& directory) {
  std::map<std::pair<std::string, std::string>, std::string> fabrics;
  const std::string path = (directory / "report.json").string();
  if (!fs::exists(path)) return fabrics;
  const Json report = Json::parse(read_file(path, Json::text_limit), printable(path));
  const Json* const known = report.find("fabrics");
  if (known == nullptr) return fabrics;
  for (const Json& panel : known->array())
    fabrics.try_emplace({name_on_one_line(panel.at("garment").string()), name_on_one_line(panel.at("panel").string())},
                        panel.at("fabric").string());
  return fabrics;
}

// A group for each panel of each garment, with its fabric: panels of the same name in two garments are one group in the file.
void settle_groups(SurfaceMesh& mesh, const fs::path& directory) {
  if (mesh.group.empty() || mesh.object.empty()) return;
  const auto fabrics = fabrics_of(directory);
  std::map<std::pair<Index, Index>, Index> numbers;
  std::vector<std::string> names;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::pair<Index, Index> panel(mesh.object[t], mesh.group[t]);
    const auto [place, is_new] = numbers.try_emplace(panel, static_cast<Index>(names.size()));
    if (is_new) {
      const std::string &garment = mesh.object_names[at(panel.first)], &name = mesh.group_names[at(panel.second)];
      const auto fabric = fabrics.find({garment, name});
      names.push_back(name);
      mesh.group_material.push_back(fabric == fabrics.end() ? std::string() : fabric->second);
    }
    mesh.group[t] = place->second;
  }
  mesh.group_names = std::move(names);
}

std::string numbered(const std::string& of, int frame, int frames, std::string_view ending) {
  const int width = std::max<int>(4, static_cast<int>(std::to_string(frames - 1).size()));
  return of + '_' + fmt::sprintf("%0*d", width, frame) + std::string(ending);
}

// A folder of frames has these frames and no others: programs read all of them.
void refuse_others(const std::string& folder, const std::string& of, const std::set<std::string>& ours,
                   std::string_view ending) {
  std::error_code error;
  for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
    const std::string name = i->path().filename().string();
    if (name.starts_with(of + '_') && name.ends_with(ending) && !ours.contains(name))
      throw IoError(printable((fs::path(folder) / name).string()),
                    "would stand among the frames that are written: remove it, or name another folder");
  }
  if (error) throw IoError(printable(folder), "cannot list the folder: " + error.message());
}

void refuse_run_files(const fs::path& directory, const std::string& out) {
  std::error_code ignored;
  for (const std::string_view name : run_file_names)
    if (fs::equivalent(directory / name, out, ignored) ||
        fs::path(out).lexically_normal() == (directory / name).lexically_normal())
      throw IoError(printable(out), "is a file of the run: name another one");
}

}  // namespace

Exported export_run(const std::string& directory, const ExportOptions& options, const std::function<bool()>& goes_on) {
  if (options.of != "cloth" && options.of != "body")
    throw Error(ErrorKind::usage, "export: expected cloth or body, got " + printable(options.of));
  if (options.all && options.frame) throw Error(ErrorKind::usage, "export: one frame or all of them, not both");
  const MeshWriter& writer = writer_of(options);
  const fs::path folder(directory);
  const std::string obj = (folder / (options.of + ".obj")).string(), pc2 = (folder / (options.of + ".pc2")).string();
  SurfaceMesh mesh = load_obj(obj);
  settle_groups(mesh, folder);
  Pc2Reader reader(pc2, Pc2End::cut);
  if (at(reader.points()) != mesh.positions.size())
    throw InputError(printable(pc2), "points", std::to_string(mesh.positions.size()) + ", as in " + options.of + ".obj",
                     std::to_string(reader.points()));
  if (reader.samples() == 0) throw InputError(printable(pc2), "samples", "at least one", "0");
  const int frames = reader.samples();
  if (options.frame && (*options.frame < 0 || *options.frame >= frames))
    throw InputError(printable(pc2), "frame", "0 to " + std::to_string(frames - 1), std::to_string(*options.frame));

  std::string name = fs::path(fs::absolute(folder).lexically_normal() / ".").parent_path().filename().string();
  if (options.of == "body") name += "_body";
  std::string out = options.out;
  if (out.empty())
    out = (fs::path("out") / (name + (options.all ? '_' + std::string(writer.name) : std::string(writer.ending))))
              .string();

  Exported exported;
  exported.vertices = mesh.positions.size();
  exported.triangles = mesh.triangles.size();
  exported.frames = frames;
  std::vector<std::pair<int, std::string>> files;
  if (options.all) {
    make_directories(out);
    std::set<std::string> ours;
    for (int frame = 0; frame < frames; ++frame) {
      const std::string file = numbered(options.of, frame, frames, writer.ending);
      ours.insert(file);
      files.emplace_back(frame, (fs::path(out) / file).string());
    }
    refuse_others(out, options.of, ours, writer.ending);
  } else {
    make_directories(fs::path(out).parent_path().string());
    files.emplace_back(options.frame.value_or(frames - 1), out);
  }
  for (const auto& [frame, file] : files) refuse_run_files(folder, file);
  for (const auto& [frame, file] : files) {
    if (goes_on && !goes_on()) break;
    reader.read(frame, mesh.positions);
    writer.write(file, mesh);
    exported.files.push_back(file);
  }
  return exported;
}

}  // namespace toile::internal
