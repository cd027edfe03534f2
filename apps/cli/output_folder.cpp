#include "output_folder.hpp"

#include "core/error.hpp"

#include <filesystem>
#include <system_error>

namespace toile::internal {
namespace {

// Links are followed as far as the path exists.
bool is_within_working_directory(const std::string& directory) {
  std::error_code error;
  const std::filesystem::path here = std::filesystem::weakly_canonical(std::filesystem::current_path(error), error);
  const std::filesystem::path there = std::filesystem::weakly_canonical(here / directory, error);
  if (error) return false;
  const std::filesystem::path way = there.lexically_relative(here);
  return !way.empty() && *way.begin() != "..";
}

}  // namespace

std::string output_folder(const CommandLine& line, const Scene& scene) {
  if (!line.out.empty()) return line.out;
  if (!scene.output_dir.empty()) {
    if (!is_within_working_directory(scene.output_dir))
      throw InputError("output.dir", "", "a folder within the one where the program runs (--out may name any)",
                       '"' + printable(scene.output_dir) + '"')
          .of("/output/dir");
    return scene.output_dir;
  }
  std::string name = scene.name;
  for (char& c : name)
    if (c == '/' || static_cast<unsigned char>(c) < 0x20) c = '_';
  if (name == "." || name == "..") name = "scene";
  return "out/" + name;
}

}  // namespace toile::internal
