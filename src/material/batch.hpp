// material/batch.hpp: eight elements in one array per number, the layout of vector registers.
//
// A batch is the same on every machine; the registers decide how many lanes are computed at once, and change no bit.
#pragma once
#include "core/types.hpp"

#include <array>

namespace toile::internal {

inline constexpr std::size_t batch_size = 8;
using Batched = double[batch_size];  // one number of eight elements; aligned to the whole of it wherever it stands

constexpr std::size_t batches_for(std::size_t elements) { return (elements + batch_size - 1) / batch_size; }

}  // namespace toile::internal
