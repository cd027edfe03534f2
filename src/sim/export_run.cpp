#include "sim/export_run.hpp"

#include "core/error.hpp"
#include "io/file.hpp"
#include "io/json.hpp"
#include "io/mesh_writer.hpp"
#include "io/obj.hpp"
#include "io/pc2.hpp"
#include "io/run_folder.hpp"
#include "io/sequence_writer.hpp"
#include "sim/panel_fabrics.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <utility>

namespace toile::internal {
namespace {

namespace fs = std::filesystem;

// What is written: single frames, or all of them in one file.
struct Writer {
  const MeshWriter* frame = nullptr;
  const SequenceWriter* sequence = nullptr;
  std::string_view name() const { return frame != nullptr ? frame->name : sequence->name; }
  std::string_view ending() const { return frame != nullptr ? frame->ending : sequence->ending; }
};

// Where a format has both, --all with the name of a file means one file.
Writer writer_of(const ExportOptions& options) {
  Writer writer;
  writer.frame = options.to.empty() ? mesh_writer_for(options.out) : mesh_writer_named(options.to);
  writer.sequence = options.to.empty() ? sequence_writer_for(options.out) : sequence_writer_named(options.to);
  if (writer.frame == nullptr && writer.sequence == nullptr)
    throw Error(ErrorKind::usage, options.to.empty() ? "export: expected a format, " + export_formats_in_words() +
                                                           ", or a file whose name ends as one of them"
                                                     : "export: expected " + export_formats_in_words() + ", got " +
                                                           printable(options.to));
  if (writer.frame != nullptr && writer.sequence != nullptr) {
    if (options.all && options.out.ends_with(writer.sequence->ending))
      writer.frame = nullptr;
    else
      writer.sequence = nullptr;
  }
  // Programs go by the extension: a .glb that is called .gltf opens in few of them.
  const bool folder = writer.frame != nullptr && options.all;
  if (!folder && !options.out.empty() && !options.out.ends_with(writer.ending()))
    throw Error(ErrorKind::usage, "export: expected a file that ends in " + std::string(writer.ending()) + ", got " +
                                      printable(options.out));
  return writer;
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

// The cloth or the body of a run.
class RunSurface {
 public:
  RunSurface(const fs::path& folder, const std::string& of) : of_(of), pc2_((folder / (of + ".pc2")).string()) {
    mesh = load_obj((folder / (of + ".obj")).string());
    settle_groups(mesh, folder.string());
    reader_ = std::make_unique<Pc2Reader>(pc2_, Pc2End::cut);
    if (at(reader_->points()) != mesh.positions.size())
      throw InputError(printable(pc2_), "points", std::to_string(mesh.positions.size()) + ", as in " + of + ".obj",
                       std::to_string(reader_->points()));
    if (frames() == 0) throw InputError(printable(pc2_), "samples", "at least one", "0");
  }

  int frames() const { return reader_->samples(); }
  void read(int frame, Vec3s& x) const { reader_->read(frame, x); }
  void check_frame(int frame) const {
    if (frame < 0 || frame >= frames())
      throw InputError(printable(pc2_), "frame", "0 to " + std::to_string(frames() - 1), std::to_string(frame));
  }
  const std::string& of() const { return of_; }

  SurfaceMesh mesh;

 private:
  std::string of_, pc2_;
  std::unique_ptr<Pc2Reader> reader_;
};

// Of a finished run, or of one that is going on; 30 of one without a report.
double fps_of(const fs::path& directory) {
  const std::string path = (directory / "report.json").string();
  if (!fs::exists(path)) return 30;
  const Json report = Json::parse(read_file(path, Json::text_limit), printable(path));
  const Json* const fps = report.find("fps");
  return fps == nullptr ? 30 : fps->number();
}

std::string name_of_run(const fs::path& folder) {
  return fs::path(fs::absolute(folder).lexically_normal() / ".").parent_path().filename().string();
}

// out/NAME.EXT, out/NAME_body.EXT, out/NAME_<format> for a folder of frames.
std::string out_of(const fs::path& folder, const ExportOptions& options, const Writer& writer) {
  if (!options.out.empty()) return options.out;
  const std::string name = name_of_run(folder) + (options.of == "body" ? "_body" : "");
  const bool frames = writer.frame != nullptr && options.all;
  return (fs::path("out") / (name + (frames ? '_' + std::string(writer.name()) : std::string(writer.ending()))))
      .string();
}

void write_frames(const fs::path& folder, const ExportOptions& options, const MeshWriter& writer,
                  const std::string& out, RunSurface& surface, const std::function<bool()>& goes_on,
                  Exported& exported) {
  const int frames = surface.frames();
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
    surface.read(frame, surface.mesh.positions);
    writer.write(file, surface.mesh);
    exported.files.push_back(file);
  }
}

// A sequence of the one frame that is asked for, or of all.
void write_sequence(const fs::path& folder, const ExportOptions& options, const SequenceWriter& writer,
                    const std::string& out, std::span<const std::unique_ptr<RunSurface>> surfaces,
                    const std::function<bool()>& goes_on, Exported& exported) {
  make_directories(fs::path(out).parent_path().string());
  refuse_run_files(folder, out);
  const int first = options.frame.value_or(0);
  Sequence sequence;
  sequence.frames = options.frame ? 1 : exported.frames;
  sequence.fps = fps_of(folder);
  sequence.goes_on = goes_on;
  for (const auto& surface : surfaces)
    sequence.surfaces.push_back(
        {surface->of(), &surface->mesh, [&surface, first](int frame, Vec3s& x) { surface->read(first + frame, x); }});
  if (writer.write(out, sequence)) exported.files.push_back(out);
}

}  // namespace

std::string export_formats_in_words() {
  std::vector<std::string> names;
  for (const MeshWriter& writer : mesh_writers()) names.emplace_back(writer.name);
  for (const SequenceWriter& writer : sequence_writers())
    if (std::find(names.begin(), names.end(), writer.name) == names.end()) names.emplace_back(writer.name);
  return alternatives(names);
}

Exported export_run(const std::string& directory, const ExportOptions& options, const std::function<bool()>& goes_on) {
  if (options.of != "cloth" && options.of != "body" && options.of != "both")
    throw Error(ErrorKind::usage, "export: expected cloth, body or both, got " + printable(options.of));
  if (options.all && options.frame) throw Error(ErrorKind::usage, "export: one frame or all of them, not both");
  const Writer writer = writer_of(options);
  const bool both = options.of == "both";
  if (both && (writer.sequence == nullptr || !writer.sequence->several))
    throw Error(ErrorKind::usage, "export: cloth and body in one file are for usda, not " + std::string(writer.name()));
  const fs::path folder(directory);
  std::vector<std::unique_ptr<RunSurface>> surfaces;
  for (const std::string& of : both ? std::vector<std::string>{"cloth", "body"} : std::vector{options.of})
    surfaces.push_back(std::make_unique<RunSurface>(folder, of));
  Exported exported;
  exported.frames = surfaces.front()->frames();
  for (const auto& surface : surfaces) {
    exported.vertices += surface->mesh.positions.size();
    exported.triangles += surface->mesh.triangles.size();
    exported.frames = std::min(exported.frames, surface->frames());  // a run that is going on
    if (options.frame) surface->check_frame(*options.frame);
  }
  const std::string out = out_of(folder, options, writer);
  if (writer.frame != nullptr)
    write_frames(folder, options, *writer.frame, out, *surfaces.front(), goes_on, exported);
  else
    write_sequence(folder, options, *writer.sequence, out, surfaces, goes_on, exported);
  return exported;
}

}  // namespace toile::internal
