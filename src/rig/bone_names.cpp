#include "rig/bone_names.hpp"

#include <algorithm>
#include <optional>
#include <span>

namespace toile::internal {
namespace {

using Words = std::span<const std::string_view>;

struct PartNames {
  BodyPart part;
  bool sided;
  std::array<std::string_view, 6> words;  // the better first
};

constexpr std::array<PartNames, body_part_count> known = {
    {{BodyPart::hips, false, {"hips", "pelvis", "hip", "root"}},
     {BodyPart::spine, false, {"spine", "lowerback", "torso", "chest", "abdomen", "upperchest"}},
     {BodyPart::neck, false, {"neck"}},
     {BodyPart::head, false, {"head"}},
     {BodyPart::collar, true, {"clavicle", "collar", "shoulder"}},
     {BodyPart::upper_arm, true, {"upperarm", "uparm", "arm", "shoulder"}},
     {BodyPart::forearm, true, {"forearm", "lowerarm", "loarm", "elbow"}},
     {BodyPart::hand, true, {"hand", "wrist"}},
     {BodyPart::thigh, true, {"upleg", "upperleg", "thigh", "hip", "leg"}},
     {BodyPart::shank, true, {"lowerleg", "loleg", "calf", "shin", "leg", "knee"}},
     {BodyPart::foot, true, {"foot", "ankle"}},
     {BodyPart::toes, true, {"toebase", "toes", "toe", "ball"}}}};

struct Name {
  std::string word;         // in lower case, without side, digits and separators
  std::optional<int> side;  // 0: left, 1: right
};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
char lower(char c) { return is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c; }

// "mixamorig:LeftUpLeg" is "upleg" on the left, "toe1-1.L" is "toe" there.
Name parsed(std::string_view given) {
  if (const std::size_t colon = given.rfind(':'); colon != std::string_view::npos) given.remove_prefix(colon + 1);
  Name name;
  if (given.starts_with("__")) return name;  // MakeHuman's way to a bone that does not begin where its parent ends
  // One letter for a side stands apart, or before a capital.
  const auto one = [](char c) -> std::optional<int> {
    if (lower(c) == 'l') return 0;
    if (lower(c) == 'r') return 1;
    return std::nullopt;
  };
  const std::size_t size = given.size();
  if (size > 2 && !is_letter(given[size - 2]) && one(given[size - 1])) {
    name.side = one(given[size - 1]);
    given.remove_suffix(2);
  } else if (size > 2 && one(given[0]) && (!is_letter(given[1]) || (is_upper(given[0]) && is_upper(given[1])))) {
    name.side = one(given[0]);
    given.remove_prefix(1);
  }
  for (const char c : given)
    if (is_letter(c)) name.word += lower(c);
  for (const std::string_view program : {"mixamorig", "bip", "def"})
    if (name.word.starts_with(program)) name.word.erase(0, program.size());
  for (const auto& [word, side] : {std::pair(std::string_view("left"), 0), {"right", 1}}) {
    if (name.side) break;
    if (name.word.starts_with(word)) {
      name.word.erase(0, word.size());
      name.side = side;
    } else if (name.word.ends_with(word)) {
      name.word.erase(name.word.size() - word.size());
      name.side = side;
    }
  }
  return name;
}

class Finder {
 public:
  explicit Finder(const Figure& figure) : figure_(&figure) {
    for (const FigureNode& node : figure.nodes) names_.push_back(parsed(node.name));
  }

  // The first node, from the roots down, of that name.
  Index node(std::string_view word, std::optional<int> side) const {
    for (const Index i : figure_->order)
      if (names_[at(i)].word == word && names_[at(i)].side == side) return i;
    return -1;
  }

  Index best(const PartNames& part, std::optional<int> side) const {
    for (const std::string_view word : part.words)
      if (const Index found = word.empty() ? -1 : node(word, side); found >= 0) return found;
    return -1;
  }

  std::vector<Index> all(const PartNames& part) const {
    std::vector<Index> found;
    for (const Index i : figure_->order)
      if (!names_[at(i)].side && !names_[at(i)].word.empty() &&
          std::find(part.words.begin(), part.words.end(), names_[at(i)].word) != part.words.end())
        found.push_back(i);
    return found;
  }

 private:
  const Figure* figure_;
  std::vector<Name> names_;
};

}  // namespace

std::string_view to_string(BodyPart part) {
  static constexpr std::array<std::string_view, body_part_count> names = {
      "hips", "spine", "neck", "head", "collar", "upper arm", "forearm", "hand", "thigh", "shank", "foot", "toes"};
  return names[static_cast<std::size_t>(part)];
}

std::vector<std::string> part_words() {
  std::vector<std::string> words;
  for (const PartNames& part : known) {
    const std::string name(to_string(part.part));
    if (part.sided) {
      words.push_back("left " + name);
      words.push_back("right " + name);
    } else {
      words.push_back(name);
    }
  }
  return words;
}

void set_part(PersonBones& bones, std::string_view word, const std::vector<Index>& nodes) {
  const std::size_t side = word.starts_with("right ") ? 1 : 0;
  if (const std::size_t space = word.find(' '); word.starts_with("left ") || side == 1) word.remove_prefix(space + 1);
  for (const PartNames& part : known) {
    if (to_string(part.part) != word) continue;
    bones.node[static_cast<std::size_t>(part.part)][side] = nodes.empty() ? -1 : nodes.front();
    if (part.part == BodyPart::spine) bones.spine = nodes;
  }
}

PersonBones person_bones(const Figure& figure) {
  const Finder finder(figure);
  PersonBones bones;
  for (const PartNames& part : known) {
    auto& found = bones.node[static_cast<std::size_t>(part.part)];
    for (std::size_t side = 0; side < 2; ++side)
      found[side] = part.sided  ? finder.best(part, static_cast<int>(side))
                    : side == 0 ? finder.best(part, std::nullopt)
                                : -1;
    if (part.part == BodyPart::spine) bones.spine = finder.all(part);
  }
  // What several parts may be called belongs to the one that has no other name.
  for (std::size_t side = 0; side < 2; ++side) {
    auto& collar = bones.node[static_cast<std::size_t>(BodyPart::collar)][side];
    if (collar == bones.of(BodyPart::upper_arm, side)) collar = -1;
    auto& shank = bones.node[static_cast<std::size_t>(BodyPart::shank)][side];
    if (shank == bones.of(BodyPart::thigh, side)) shank = finder.node("knee", static_cast<int>(side));
  }
  return bones;
}

}  // namespace toile::internal
