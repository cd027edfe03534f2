#include "io/gltf_load.hpp"

#include "core/error.hpp"
#include "io/gltf_text.hpp"

#include <exception>
#include <new>
#include <string>
#include <string_view>

namespace toile::internal {
namespace {

struct Beside {
  const MeshSource* source;
  std::size_t bytes = 0;
};

}  // namespace

tinygltf::Model load_gltf(const MeshSource& source, std::size_t& bytes) {
  check_gltf_text(source.bytes, source.file);
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader([](tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*, int,
                           void*) { return true; },
                        nullptr);
  Beside beside{&source};
  tinygltf::FsCallbacks files{};
  files.FileExists = [](const std::string&, void*) { return true; };
  files.ExpandFilePath = [](const std::string& path, void*) { return path; };
  files.ReadWholeFile = [](std::vector<unsigned char>* out, std::string*, const std::string& path, void* user) {
    auto& from = *static_cast<Beside*>(user);
    const std::string read = from.source->beside(path);
    from.bytes += read.size();
    out->assign(read.begin(), read.end());
    return true;
  };
  files.user_data = &beside;
  loader.SetFsCallbacks(files);
  tinygltf::Model model;
  std::string error, warning;
  bool good = false;
  const auto size = static_cast<unsigned int>(source.bytes.size());
  try {
    if (is_glb(source.bytes)) {
      const auto* const first = reinterpret_cast<const unsigned char*>(source.bytes.data());
      good = loader.LoadBinaryFromMemory(&model, &error, &warning, first, size, "", tinygltf::REQUIRE_VERSION);
    } else {
      const std::string_view json = gltf_json_of(source.bytes, source.file);
      good = loader.LoadASCIIFromString(&model, &error, &warning, json.data(), static_cast<unsigned int>(json.size()),
                                        "", tinygltf::REQUIRE_VERSION);
    }
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& thrown) {
    throw InputError(source.file, "glTF", "a file of glTF 2.0", printable(thrown.what()));
  }
  if (!good) {
    const std::string first = error.substr(0, error.find('\n'));
    throw InputError(source.file, "glTF", "a file of glTF 2.0", first.empty() ? "none" : printable(first));
  }
  if (!model.asset.version.starts_with("2."))
    throw InputError(source.file, "/asset/version", "2.x", '"' + printable(model.asset.version) + '"');
  bytes = source.bytes.size() + beside.bytes;
  return model;
}

}  // namespace toile::internal
