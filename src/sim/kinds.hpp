// sim/kinds.hpp: functions of a list of kinds: a std::variant of structs, of which an object of a scene chooses one by its key.
#pragma once
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace toile::internal {

// Calls f with a default object of every kind that a scene file can choose, in the order of the list.
template <class Kinds, class F>
void for_each_kind(const F& f) {
  const auto one = [&]<class Kind>(std::type_identity<Kind>) {
    if constexpr (requires { Kind::key; }) f(Kind{});
  };
  [&]<class... Kind>(std::type_identity<std::variant<Kind...>>) {
    (one(std::type_identity<Kind>{}), ...);
  }(std::type_identity<Kinds>{});
}

template <class Kinds>
std::vector<std::string_view> keys_of_kinds() {
  std::vector<std::string_view> keys;
  for_each_kind<Kinds>([&]<class Kind>(const Kind&) { keys.push_back(Kind::key); });
  return keys;
}

}  // namespace toile::internal
