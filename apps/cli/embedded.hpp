// apps/cli/embedded.hpp: the scenes and patterns that are part of the program.
#pragma once
#include <span>
#include <string_view>

namespace toile {

struct EmbeddedFile {
  std::string_view path, text;  // "scenes/tshirt.json"
};

std::span<const EmbeddedFile> embedded_files();

}  // namespace toile
