// tests/generated/scene_generator.hpp: small and short scenes, valid as a user writes them, from a number.
//
// The first scenes are the rows that cover all pairs of features; those behind have features by chance.  Lengths, times and strengths
// are drawn by the number of the scene and the name of what is drawn, so a change of one thing moves nothing else.
#pragma once
#include "generated/scene_space.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace toile::internal::generated {

struct TextFile {
  std::string name, bytes;  // names with '/' go into folders
};

// A scene as JSON, once as generated and with things added that change nothing.
struct GeneratedScene {
  Choice choice;
  std::string scene;
  std::string earlier;  // the run that it starts from goes into the folder "earlier"; empty: none
  std::string with_far_solid, with_defaults, with_both;  // with_far_solid may be empty: none
  bool begins_to_move =
      false;  // by that solid: then there is another number of frames, and those that both have are the same
  bool may_refuse_start = false;  // exit code 4 for crossings
  std::vector<TextFile> files;    // that all of them read
};

GeneratedScene generate_scene(std::uint64_t number);
// For people: the features that differ from the first of their axis.
std::string describe(const Choice& choice);
// Features of scene `number`.
Choice choice_of(std::uint64_t number);

}  // namespace toile::internal::generated
