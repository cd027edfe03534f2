// garment/edge_loop.hpp: the edges of a panel as one closed loop, whatever their order in the file.
#pragma once
#include "garment/pattern.hpp"
#include "io/json.hpp"

#include <vector>

namespace toile::internal {

// Puts the edges into the order in which they follow each other, the file's first edge first.  Returns the new place of each.  Throws InputError, at the
// edge in `json`, where they are no single closed loop.
std::vector<Index> order_loop(Panel& panel, const Json& json);

}  // namespace toile::internal
