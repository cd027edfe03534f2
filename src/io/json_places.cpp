#include "io/json_places.hpp"

#include <utility>

namespace toile::internal {

void JsonPlaces::add(std::string path, const Json& value, std::string_view note) {
  place_of_.insert_or_assign(std::move(path), Place{value.where(), value.pointer().append(note)});
}

InputError JsonPlaces::complete(const InputError& error) const {
  const auto found = place_of_.find(error.path());
  if (found == place_of_.end()) return error;
  const auto& [where, pointer] = found->second;
  const std::string& rest = error.place();
  const std::string_view between = rest.empty() || rest.front() == '/' ? "" : ": ";
  return {where, pointer + std::string(between) + rest, error.expected(), error.got()};
}

}  // namespace toile::internal
