#include "io/animated_mesh.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <charconv>

namespace toile::internal {
namespace {

constexpr std::size_t listed_clips = 40;

std::string list_of(const std::vector<Clip>& clips) {
  std::string words;
  for (std::size_t k = 0; k < std::min(clips.size(), listed_clips); ++k)
    words += (k == 0 ? "" : ", ") + std::to_string(k) + ' ' + printable(clips[k].name);
  return clips.size() > listed_clips ? words + ", ..." : words;
}

}  // namespace

const Clip& chosen_clip(const std::vector<Clip>& clips, std::string_view choice, std::string_view file) {
  if (clips.empty()) throw InputError(file, "clip", "a file with an animation", "none");
  if (choice.empty() && clips.size() == 1) return clips.front();
  if (choice.empty())
    throw InputError(file, "clip", "the choice of one of its animations by --clip (" + list_of(clips) + ')', "none");
  const auto named = [&](const Clip& clip) { return clip.name == choice; };
  const auto found = std::find_if(clips.begin(), clips.end(), named);
  if (found != clips.end()) {
    if (std::find_if(found + 1, clips.end(), named) == clips.end()) return *found;
    throw InputError(file, "clip", "a number, as several have this name (" + list_of(clips) + ')',
                     '"' + printable(choice) + '"');
  }
  std::size_t number = 0;
  const char* const end = choice.data() + choice.size();
  const auto [stop, error] = std::from_chars(choice.data(), end, number);
  if (error == std::errc() && stop == end && number < clips.size()) return clips[number];
  throw InputError(file, "clip", "one of " + list_of(clips), '"' + printable(choice) + '"');
}

}  // namespace toile::internal
