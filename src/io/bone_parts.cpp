#include "io/bone_parts.hpp"

#include "core/error.hpp"
#include "io/json.hpp"

#include <string>
#include <vector>

namespace toile::internal {
namespace {

Index node_of(const Json& name, const Figure& figure) {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < figure.nodes.size(); ++i) {
    if (figure.nodes[i].name == name.string()) return static_cast<Index>(i);
    names.push_back(figure.nodes[i].name);
  }
  name.fail("a joint (nearest is \"" + printable(nearest_name(name.string(), names.data(), names.size())) + "\")",
            name.describe());
}

void read_side(const Json* parts, const NamedSkeleton& skeleton) {
  if (parts == nullptr) return;
  const std::vector<std::string> words = part_words();
  const std::vector<std::string_view> known(words.begin(), words.end());
  parts->allow_only(known);
  for (const auto& [word, given] : parts->object()) {
    std::vector<Index> nodes;
    if (given.is_array()) {
      if (word != "spine") given.fail("one joint", given.describe());
      for (const Json& one : given.array()) nodes.push_back(node_of(one, *skeleton.figure));
    } else if (!given.is_null()) {
      nodes.push_back(node_of(given, *skeleton.figure));
    }
    set_part(*skeleton.bones, word, nodes);
  }
}

}  // namespace

void read_bone_parts(std::string_view text, std::string_view file, const NamedSkeleton& body,
                     const NamedSkeleton& motion) {
  const Json json = Json::parse(text, file);
  json.allow_only({"body", "motion"});
  read_side(json.find("body"), body);
  read_side(json.find("motion"), motion);
}

}  // namespace toile::internal
