#include "verify/hem_loops.hpp"

#include <algorithm>
#include <iterator>

namespace toile::internal {

std::vector<Side> hem_sides(std::span<const Triangle> triangles) {
  std::vector<Side> sides, reversed;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      sides.push_back({t[k], t[(k + 1) % 3]});
      reversed.push_back({t[(k + 1) % 3], t[k]});
    }
  std::sort(sides.begin(), sides.end());
  std::sort(reversed.begin(), reversed.end());
  std::vector<Side> hems;
  std::set_difference(sides.begin(), sides.end(), reversed.begin(), reversed.end(), std::back_inserter(hems));
  return hems;
}

std::vector<std::vector<Index>> hem_loops(std::span<const Triangle> triangles) {
  const std::vector<Side> hems = hem_sides(triangles);
  std::vector<char> used(hems.size(), 0);
  std::vector<std::vector<Index>> loops;
  for (std::size_t first = 0; first < hems.size(); ++first) {
    if (used[first] != 0) continue;
    std::vector<Index> loop;
    for (std::size_t side = first; side < hems.size() && used[side] == 0;) {
      used[side] = 1;
      loop.push_back(hems[side][0]);
      const Index next = hems[side][1];
      side = static_cast<std::size_t>(std::lower_bound(hems.begin(), hems.end(), Side{next, 0}) - hems.begin());
      while (side < hems.size() && hems[side][0] == next && used[side] != 0) ++side;
      if (side < hems.size() && hems[side][0] != next) break;
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace toile::internal
