#include "io/gltf_numbers.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace toile::internal {
namespace {

static_assert(std::endian::native == std::endian::little, "buffers are little-endian, and so must the machine be");

// 0: not a type of the format.
std::size_t component_bytes(int component) {
  switch (component) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

template <class T>
double number_at(const unsigned char* bytes, bool normalised) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  if (!normalised) return static_cast<double>(value);
  return std::max(-1.0, static_cast<double>(value) / static_cast<double>(std::numeric_limits<T>::max()));
}

double component_at(const unsigned char* bytes, int component, bool normalised) {
  switch (component) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return number_at<std::int8_t>(bytes, normalised);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return number_at<std::uint8_t>(bytes, normalised);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return number_at<std::int16_t>(bytes, normalised);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return number_at<std::uint16_t>(bytes, normalised);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return number_at<std::uint32_t>(bytes, normalised);
    default:
      return number_at<float>(bytes, false);
  }
}

std::size_t components_of(int type) {
  if (type == TINYGLTF_TYPE_MAT4) return 16;
  return type == TINYGLTF_TYPE_SCALAR ? 1 : static_cast<std::size_t>(type);
}

std::string type_name(int type) {
  switch (type) {
    case TINYGLTF_TYPE_SCALAR:
      return "SCALAR";
    case TINYGLTF_TYPE_VEC2:
      return "VEC2";
    case TINYGLTF_TYPE_VEC3:
      return "VEC3";
    case TINYGLTF_TYPE_VEC4:
      return "VEC4";
    case TINYGLTF_TYPE_MAT4:
      return "MAT4";
    default:
      return "another type";
  }
}

}  // namespace

void GltfNumbers::fail(const std::string& place, const std::string& expected, const std::string& got) const {
  throw InputError(file_, place, expected, got);
}

const unsigned char* GltfNumbers::data(const std::string& place, int view_number, std::size_t offset, std::size_t count,
                                       std::size_t size, std::size_t& stride) const {
  constexpr std::size_t stride_limit = 252;  // by the format
  const auto& views = model_->bufferViews;
  if (view_number < 0 || static_cast<std::size_t>(view_number) >= views.size())
    fail(place + "/bufferView", "a number below " + std::to_string(views.size()), std::to_string(view_number));
  const tinygltf::BufferView& view = views[static_cast<std::size_t>(view_number)];
  const std::string view_place = "/bufferViews/" + std::to_string(view_number);
  if (view.extensions.contains("EXT_meshopt_compression"))
    fail(view_place, "data that are not compressed", "EXT_meshopt_compression");
  if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model_->buffers.size())
    fail(view_place + "/buffer", "a number below " + std::to_string(model_->buffers.size()),
         std::to_string(view.buffer));
  const auto& bytes = model_->buffers[static_cast<std::size_t>(view.buffer)].data;
  if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset)
    fail(view_place, "bytes of a buffer of " + std::to_string(bytes.size()),
         std::to_string(view.byteLength) + " from " + std::to_string(view.byteOffset) + " on");
  if (view.byteStride > stride_limit || (view.byteStride != 0 && view.byteStride < size))
    fail(view_place + "/byteStride", std::to_string(size) + " to " + std::to_string(stride_limit),
         std::to_string(view.byteStride));
  stride = view.byteStride == 0 ? size : view.byteStride;
  const bool fits = count == 0 || (offset <= view.byteLength && size <= view.byteLength - offset &&
                                   (count - 1) <= (view.byteLength - offset - size) / stride);
  if (!fits)
    fail(place,
         std::to_string(count) + " elements of " + std::to_string(size) + " bytes in " + view_place.substr(1) +
             ", which has " + std::to_string(view.byteLength) + " bytes",
         offset == 0 ? "fewer" : "fewer, from byte " + std::to_string(offset) + " on");
  return bytes.data() + view.byteOffset + offset;
}

void GltfNumbers::replace_sparse(const tinygltf::Accessor& accessor, const std::string& place, std::size_t components,
                                 std::vector<double>& values) const {
  const auto& sparse = accessor.sparse;
  const std::string indices_place = place + "/sparse/indices", values_place = place + "/sparse/values";
  if (sparse.count < 0 || static_cast<std::size_t>(sparse.count) > accessor.count)
    fail(place + "/sparse/count", "at most " + std::to_string(accessor.count), std::to_string(sparse.count));
  const int index_type = sparse.indices.componentType;
  if (index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
      index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
    fail(indices_place + "/componentType", "5121, 5123 or 5125", std::to_string(index_type));
  if (sparse.indices.byteOffset < 0) fail(indices_place + "/byteOffset", "at least 0", "less");
  if (sparse.values.byteOffset < 0) fail(values_place + "/byteOffset", "at least 0", "less");
  const auto count = static_cast<std::size_t>(sparse.count);
  const std::size_t size = component_bytes(accessor.componentType);
  std::size_t index_stride = 0, value_stride = 0;
  const unsigned char* const indices =
      data(indices_place, sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset), count,
           component_bytes(index_type), index_stride);
  const unsigned char* const given =
      data(values_place, sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset), count,
           components * size, value_stride);
  for (std::size_t k = 0; k < count; ++k) {
    const auto index = static_cast<std::size_t>(component_at(indices + k * index_stride, index_type, false));
    if (index >= accessor.count)
      fail(indices_place, "indices below " + std::to_string(accessor.count), std::to_string(index));
    for (std::size_t c = 0; c < components; ++c)
      values[index * components + c] =
          component_at(given + k * value_stride + c * size, accessor.componentType, accessor.normalized);
  }
}

std::vector<double> GltfNumbers::read(int number, int type, std::size_t count_limit) const {
  const std::string place = "/accessors/" + std::to_string(number);
  if (number < 0 || static_cast<std::size_t>(number) >= model_->accessors.size())
    fail(place, "a number below " + std::to_string(model_->accessors.size()), std::to_string(number));
  const tinygltf::Accessor& accessor = model_->accessors[static_cast<std::size_t>(number)];
  if (accessor.type != type) fail(place + "/type", type_name(type), type_name(accessor.type));
  const std::size_t size = component_bytes(accessor.componentType);
  if (size == 0) fail(place + "/componentType", "5120 to 5123, 5125 or 5126", std::to_string(accessor.componentType));
  if (accessor.count > count_limit)
    fail(place + "/count", "at most " + std::to_string(count_limit), std::to_string(accessor.count));
  // Columns of smaller components have gaps between them.
  if (type == TINYGLTF_TYPE_MAT4 && accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
    fail(place + "/componentType", "5126", std::to_string(accessor.componentType));
  const std::size_t components = components_of(type);
  std::vector<double> values;
  if (accessor.bufferView >= 0) {
    std::size_t stride = 0;
    const unsigned char* const bytes =
        data(place, accessor.bufferView, accessor.byteOffset, accessor.count, components * size, stride);
    values.reserve(accessor.count * components);
    for (std::size_t i = 0; i < accessor.count; ++i)
      for (std::size_t c = 0; c < components; ++c)
        values.push_back(component_at(bytes + i * stride + c * size, accessor.componentType, accessor.normalized));
  } else {  // zeros, except for the sparse entries
    if (accessor.count > bytes_)
      fail(place + "/count", "no more than the file has bytes, as it has no data", std::to_string(accessor.count));
    values.assign(accessor.count * components, 0);
  }
  if (accessor.sparse.isSparse) replace_sparse(accessor, place, components, values);
  for (std::size_t k = 0; k < values.size(); ++k)
    if (!std::isfinite(values[k]))
      fail(place + ", element " + std::to_string(k / components), "finite numbers",
           std::isnan(values[k]) ? "not a number" : "infinity");
  return values;
}

std::vector<double> GltfNumbers::read_indices(int number, int type_wanted, std::size_t count_limit) const {
  std::vector<double> indices = read(number, type_wanted, count_limit);
  const tinygltf::Accessor& accessor = model_->accessors[static_cast<std::size_t>(number)];
  const int type = accessor.componentType;
  if (accessor.normalized ||
      (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
       type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT))
    fail("/accessors/" + std::to_string(number), "indices: 5121, 5123 or 5125, not normalised", std::to_string(type));
  return indices;
}

}  // namespace toile::internal
