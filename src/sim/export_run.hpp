// sim/export_run.hpp: frames of a run as files of other formats, or all of them in one.                                                 docs/howto/export.md
//
// Reads the files of the run: cloth.obj and cloth.pc2 (or body.*), and the fabrics from report.json.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

struct ExportOptions {
  std::string to;  // a writer's name (io/mesh_writer.hpp, io/sequence_writer.hpp); empty: by the extension of `out`
  std::string
      out;  // a file with the format's extension, or a folder for all frames; empty: out/NAME.EXT, out/NAME_<format>
  std::string of = "cloth";  // or "body", or "both" where the format has several surfaces
  std::optional<int> frame;  // none: the last, or all in one file where the format has that alone
  bool all =
      false;  // every frame, in files cloth_0000.<extension> ..., or in `out` where that is a file of a format that has both
};

// "obj, ply, gltf, pc2, mdd or usda", as on the command line.
std::string export_formats_in_words();

struct Exported {
  std::vector<std::string> files;
  std::size_t vertices = 0, triangles = 0;  // of the run; a format may split vertices
  int frames = 0;                           // of the run
};

// `goes_on` is polled before each file.  Throws Error(usage) for options that do not fit together, InputError for a missing frame or body and
// for numbers that are not finite, IoError instead of overwriting a file of the run, and for other frames in the folder.
Exported export_run(const std::string& directory, const ExportOptions& options,
                    const std::function<bool()>& goes_on = {});

}  // namespace toile::internal
