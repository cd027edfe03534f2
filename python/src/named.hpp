// named.hpp: enums as checked strings.
#pragma once
#include <toile/error.hpp>
#include <toile/types.hpp>

#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace toile::python {

template <class E, std::size_t N>
using Names = std::array<std::pair<std::string_view, E>, N>;

inline constexpr Names<LengthUnit, 6> length_units{{{"automatic", LengthUnit::automatic},
                                                    {"m", LengthUnit::m},
                                                    {"dm", LengthUnit::dm},
                                                    {"cm", LengthUnit::cm},
                                                    {"mm", LengthUnit::mm},
                                                    {"in", LengthUnit::inch}}};
inline constexpr Names<UpAxis, 3> up_axes{{{"automatic", UpAxis::automatic}, {"y", UpAxis::y}, {"z", UpAxis::z}}};

template <class E, std::size_t N>
E named(std::string_view argument, std::string_view name, const Names<E, N>& names) {
  std::string all;
  for (const auto& [known, value] : names) {
    if (known == name) return value;
    all += (all.empty() ? "" : ", ") + std::string(known);
  }
  throw InputError(std::string(argument) + ": expected one of " + all + ", got `" + std::string(name) + "`");
}

}  // namespace toile::python
