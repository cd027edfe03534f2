// The mannequins, made once per test program.
#pragma once
#include "body/mannequin.hpp"

#include <algorithm>
#include <map>
#include <string_view>

namespace toile::internal::test {

inline const Mannequin& mannequin_of(MannequinKind kind) {
  static std::map<MannequinKind, Mannequin> made;
  const auto found = made.find(kind);
  return found != made.end() ? found->second : made.emplace(kind, make_mannequin(kind)).first->second;
}

inline std::size_t joint(const Mannequin& m, std::string_view name) {
  return static_cast<std::size_t>(
      std::find_if(m.joints.begin(), m.joints.end(), [&](const Joint& j) { return j.name == name; }) -
      m.joints.begin());
}

}  // namespace toile::internal::test
