#include "io/gltf_text.hpp"

#include "core/error.hpp"

#include <nlohmann/json.hpp>

#include <charconv>
#include <cstdint>
#include <cstring>

namespace toile::internal {
namespace {

constexpr int depth_limit = 64;  // nested arrays and objects: the library parses by recursion

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

void check_depth(std::string_view json, std::string_view file) {
  int depth = 0, line = 1;
  bool quoted = false;
  for (std::size_t k = 0; k < json.size(); ++k) {
    const char c = json[k];
    if (c == '\n') ++line;
    if (quoted) {
      if (c == '\\') ++k;
      quoted = c != '"';
    } else if (c == '"') {
      quoted = true;
    } else if (c == '{' || c == '[') {
      if (++depth > depth_limit)
        throw InputError(std::string(file) + ':' + std::to_string(line), "glTF",
                         "arrays and objects at most " + std::to_string(depth_limit) + " deep", "more");
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
}

nlohmann::json parse_json(std::string_view text, std::string_view file) {
  check_depth(text, file);
  try {
    nlohmann::json root = nlohmann::json::parse(text.begin(), text.end());
    if (!root.is_object()) throw InputError(file, "glTF", "an object", root.type_name());
    return root;
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file, "glTF", "JSON", printable(error.what()));
  }
}

// Required extensions that are not supported.  Materials, textures and lights are not read.
void check_extensions(const nlohmann::json& root, std::string_view file) {
  const auto required = root.find("extensionsRequired");
  if (required == root.end() || !required->is_array()) return;
  for (const auto& entry : *required) {
    const std::string name = entry.is_string() ? entry.get<std::string>() : std::string("no name");
    const bool harmless = name == "KHR_mesh_quantization" || name.starts_with("KHR_materials_") ||
                          name.starts_with("KHR_texture_") || name.starts_with("EXT_texture_") ||
                          name.starts_with("KHR_lights_");
    if (!harmless)
      throw InputError(file, "/extensionsRequired", "none but of materials, textures, lights and KHR_mesh_quantization",
                       printable(name));
  }
}

// "a%20b" is "a b".
std::string decoded(std::string_view uri) {
  std::string name;
  for (std::size_t k = 0; k < uri.size(); ++k) {
    unsigned char byte = 0;
    const char* const digits = uri.data() + k + 1;
    if (uri[k] == '%' && k + 2 < uri.size() && std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
      name += static_cast<char>(byte);
      k += 2;
    } else {
      name += uri[k];
    }
  }
  return name;
}

}  // namespace

bool is_glb(std::string_view bytes) { return bytes.substr(0, 4) == "glTF"; }

bool is_gltf_text(std::string_view bytes) {
  if (bytes.substr(0, 3) == "\xef\xbb\xbf") bytes.remove_prefix(3);
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && bytes[first] == '{';
}

std::string_view gltf_json_of(std::string_view bytes, std::string_view file) {
  if (!is_glb(bytes)) return bytes.substr(0, 3) == "\xef\xbb\xbf" ? bytes.substr(3) : bytes;
  constexpr std::size_t before = 20;  // magic, version, length; length and kind of the first chunk
  if (bytes.size() < before) throw InputError(file, "header", "20 bytes", std::to_string(bytes.size()));
  if (word_at(bytes, 4) != 2) throw InputError(file, "version", "2", std::to_string(word_at(bytes, 4)));
  if (word_at(bytes, 8) != bytes.size())
    throw InputError(file, "length in the header", std::to_string(bytes.size()) + ", the size of the file",
                     std::to_string(word_at(bytes, 8)));
  if (bytes.substr(16, 4) != "JSON")
    throw InputError(file, "byte 16", "\"JSON\"", '"' + printable(bytes.substr(16, 4)) + '"');
  const std::size_t length = word_at(bytes, 12);
  if (length > bytes.size() - before)
    throw InputError(file, "byte 12", "a chunk of at most " + std::to_string(bytes.size() - before) + " bytes",
                     std::to_string(length));
  return bytes.substr(before, length);
}

void check_gltf_text(std::string_view bytes, std::string_view file) {
  check_extensions(parse_json(gltf_json_of(bytes, file), file), file);
}

std::vector<std::string> gltf_buffers_beside(std::string_view bytes) {
  std::vector<std::string> names;
  const nlohmann::json root = parse_json(gltf_json_of(bytes, ""), "");
  const auto buffers = root.find("buffers");
  if (buffers == root.end() || !buffers->is_array()) return names;
  for (const auto& buffer : *buffers) {
    const auto uri = buffer.is_object() ? buffer.find("uri") : buffer.end();
    if (buffer.is_object() && uri != buffer.end() && uri->is_string() && !uri->get<std::string>().starts_with("data:"))
      names.push_back(decoded(uri->get<std::string>()));
  }
  return names;
}

}  // namespace toile::internal
