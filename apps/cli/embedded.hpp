// apps/cli/embedded.hpp: the built-in scenes and patterns.
#pragma once
#include "core/error.hpp"

#include <span>
#include <string>
#include <string_view>

namespace toile::internal {

struct EmbeddedFile {
  std::string_view path, text;  // "scenes/tshirt.json"
};

std::span<const EmbeddedFile> embedded_files();

// Throws IoError for an unknown path.
inline std::string embedded_text(const std::string& path) {
  for (const EmbeddedFile& file : embedded_files())
    if (file.path == path) return std::string(file.text);
  throw IoError(path, "not built into this program");
}

}  // namespace toile::internal
