// io/gltf_text.hpp: the JSON of a glTF file, looked through before the library reads it.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

bool is_glb(std::string_view bytes);
bool is_gltf_text(std::string_view bytes);

// Of a text the whole, of a .glb its first chunk.  Throws InputError for a header that is none.
std::string_view gltf_json_of(std::string_view bytes, std::string_view file);

// Throws InputError for what is no JSON, is nested deeper than a stack can take, or asks for an extension that is not read here.
void check_gltf_text(std::string_view bytes, std::string_view file);

// The names of buffers that are files of their own.
std::vector<std::string> gltf_buffers_beside(std::string_view bytes);

}  // namespace toile::internal
