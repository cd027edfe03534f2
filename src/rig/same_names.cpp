#include "rig/same_names.hpp"

#include "core/error.hpp"

#include <map>

namespace toile::internal {

Clip clip_for(const Figure& to, const Clip& clip, const Figure& from, std::string_view file, std::size_t& left_out) {
  std::map<std::string_view, Index> number;
  for (std::size_t i = 0; i < to.nodes.size(); ++i) number.try_emplace(to.nodes[i].name, static_cast<Index>(i));
  Clip mapped;
  mapped.name = clip.name;
  mapped.begin_s = clip.begin_s;
  mapped.end_s = clip.end_s;
  left_out = 0;
  for (const ClipChannel& channel : clip.channels) {
    const FigureNode& node = from.nodes[at(channel.node)];
    const auto found = number.find(node.name);
    const bool fits =
        found != number.end() && !node.name.empty() &&
        (channel.moves != ClipChannel::Moves::weights || to.nodes[at(found->second)].weights == node.weights);
    if (!fits) {
      ++left_out;
      continue;
    }
    mapped.channels.push_back(channel);
    mapped.channels.back().node = found->second;
  }
  if (mapped.channels.empty() && !clip.channels.empty())
    throw InputError(file, "animation " + printable(clip.name), "nodes with the names of the body's skeleton",
                     "none, but \"" + printable(from.nodes[at(clip.channels.front().node)].name) + '"');
  return mapped;
}

}  // namespace toile::internal
