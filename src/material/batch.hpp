// material/batch.hpp: eight elements side by side, number by number, as vector registers want them.
//
// A batch is the same on every machine; how many of its lanes are worked on at once depends on the registers and changes no bit.
#pragma once
#include "core/types.hpp"

#include <array>

namespace toile::internal {

inline constexpr std::size_t batch_size = 8;
using Batched = double[batch_size];  // one number of eight elements; aligned to the whole of it wherever it stands

constexpr std::size_t batches_for(std::size_t elements) { return (elements + batch_size - 1) / batch_size; }

}  // namespace toile::internal
