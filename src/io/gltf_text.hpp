// io/gltf_text.hpp: checks the JSON of a glTF file before the library reads it.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

bool is_glb(std::string_view bytes);
bool is_gltf_text(std::string_view bytes);

// The JSON: all of a text file, the first chunk of a .glb.  Throws InputError for an invalid header.
std::string_view gltf_json_of(std::string_view bytes, std::string_view file);

// Throws InputError for invalid JSON, nesting too deep for the stack, or a required extension that is not supported.
void check_gltf_text(std::string_view bytes, std::string_view file);

// The names of external buffer files.
std::vector<std::string> gltf_buffers_beside(std::string_view bytes);

}  // namespace toile::internal
