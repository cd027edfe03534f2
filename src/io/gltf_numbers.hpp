// io/gltf_numbers.hpp: the numbers of a glTF accessor, of every component type, normalised or not, sparse or not.
//
// The library does not validate the file: every index, offset and length is checked here before a byte is read.
#pragma once
#include "io/gltf_library.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace toile::internal {

class GltfNumbers {
 public:
  // `bytes` is the total size of the file and its buffers: an accessor without data of its own has at most so many entries.
  GltfNumbers(const tinygltf::Model& model, std::string file, std::size_t bytes)
      : model_(&model), file_(std::move(file)), bytes_(bytes) {}

  // [count * components] of an accessor of type TINYGLTF_TYPE_..., all finite.  Throws InputError naming the accessor.
  std::vector<double> read(int accessor, int type, std::size_t count_limit) const;
  // For indices: integers that are not normalised.
  std::vector<double> read_indices(int accessor, int type, std::size_t count_limit) const;

 private:
  [[noreturn]] void fail(const std::string& place, const std::string& expected, const std::string& got) const;
  // Where `count` elements of `size` bytes begin, `stride` from one to the next (0: close together).
  const unsigned char* data(const std::string& place, int view, std::size_t offset, std::size_t count, std::size_t size,
                            std::size_t& stride) const;
  void replace_sparse(const tinygltf::Accessor& accessor, const std::string& place, std::size_t components,
                      std::vector<double>& values) const;

  const tinygltf::Model* model_;
  std::string file_;
  std::size_t bytes_;
};

}  // namespace toile::internal
