// garment/pattern_values.hpp: reads words, numbers and indices of a pattern file, with errors that say what was expected.
#pragma once
#include "core/types.hpp"
#include "io/json.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

// "; did you mean X?", or nothing.
std::string suggestion(std::string_view name, const std::vector<std::string>& candidates);
// One of a few words; returns its number.
std::size_t read_word(const Json& json, const std::vector<std::string>& words);
double read_angle(const Json& json);  // of a fold: degrees in the file, radians here
bool read_flag(const Json& json);
// An index below `count`.
Index read_index(const Json& json, std::size_t count, const char* what);

template <int size>
Eigen::Matrix<double, size, 1> read_numbers(const Json& json) {
  if (!json.is_array() || json.array().size() != size) {
    json.fail("an array of " + std::to_string(size) + " numbers", json.describe());
  }
  Eigen::Matrix<double, size, 1> v;
  for (int k = 0; k < size; ++k) v[k] = json.array()[static_cast<std::size_t>(k)].number();
  return v;
}

}  // namespace toile::internal
