#include "garment/edge_loop.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace toile::internal {

std::vector<Index> order_loop(Panel& panel, const Json& json) {
  const std::size_t count = panel.edges.size();
  constexpr Index none = -1;
  std::vector<Index> leaving(panel.corners.size(), none), place(count, none);
  const auto name = [](Index edge) { return "edge " + std::to_string(edge); };
  for (std::size_t e = 0; e < count; ++e) {
    const Index corner = panel.edges[e].start;
    if (leaving[at(corner)] != none) {
      json.array()[e].fail("a closed loop, in which one edge leaves each corner",
                           name(static_cast<Index>(e)) + " leaving corner " + std::to_string(corner) + " as " +
                               name(leaving[at(corner)]) + " does");
    }
    leaving[at(corner)] = static_cast<Index>(e);
  }
  std::vector<PanelEdge> ordered;
  Index edge = 0;
  while (ordered.size() < count && place[at(edge)] == none) {
    place[at(edge)] = static_cast<Index>(ordered.size());
    ordered.push_back(panel.edges[at(edge)]);
    const Index corner = ordered.back().end, next = leaving[at(corner)];
    if (next == none) {
      json.array()[at(edge)].fail(
          "a closed loop", name(edge) + " ending at corner " + std::to_string(corner) + ", where no edge begins");
    }
    edge = next;
  }
  if (edge != 0) {  // returned to the middle of its own path, like a 6
    const auto last = static_cast<Index>(std::find(place.begin(), place.end(), ordered.size() - 1) - place.begin());
    json.array()[at(last)].fail("a closed loop through edge 0",
                                name(last) + " ending at the beginning of " + name(edge));
  }
  if (ordered.size() < count) {
    const auto left = static_cast<Index>(std::find(place.begin(), place.end(), none) - place.begin());
    json.array()[at(left)].fail("one closed loop", name(left) + " outside of the loop that edge 0 belongs to");
  }
  panel.edges = std::move(ordered);
  return place;
}

}  // namespace toile::internal
