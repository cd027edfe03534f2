#include "io/bvh.hpp"

#include "core/error.hpp"
#include "io/file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace toile::internal {
namespace {

constexpr std::size_t most_joints = 10'000, most_channels = 6, bvh_limit = std::size_t{1} << 30;
constexpr double longest_frame_s = 10, shortest_frame_s = 1e-4;
constexpr double farthest = 1e9;  // of an offset or a position: no unit makes that a body
constexpr double most_degrees = 1e6;

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }
bool same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return lower(x) == lower(y); });
}
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v'; }

// The words of the text, with their lines.
class BvhWords {
 public:
  BvhWords(std::string_view text, std::string_view file) : text_(text), file_(file) {
    if (text_.starts_with("\xef\xbb\xbf")) text_.remove_prefix(3);
  }

  // Empty at the end.
  std::string_view next() {
    skip_spaces();
    word_line_ = line_;
    const std::size_t first = place_;
    while (place_ < text_.size() && !is_space(text_[place_])) ++place_;
    return text_.substr(first, place_ - first);
  }

  void expect(std::string_view word) {
    const std::string_view got = next();
    if (!same_word(got, word)) fail(word, got);
  }

  double number(double most) {
    std::string_view word = next();
    const std::string_view got = word;
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) fail("a number", got);
    if (!(std::abs(value) <= most)) fail("a number within " + std::to_string(static_cast<long long>(most)), got);
    return value;
  }

  std::size_t count(std::size_t most) {
    const std::string_view word = next();
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || value > most)
      fail("a whole number up to " + std::to_string(most), word);
    return value;
  }

  // What is left of the line, up to a brace.
  std::string name() {
    const std::size_t end = std::min(text_.find_first_of("{\r\n", place_), text_.size());
    std::string_view name = text_.substr(place_, end - place_);
    place_ = end;
    while (!name.empty() && is_space(name.front())) name.remove_prefix(1);
    while (!name.empty() && is_space(name.back())) name.remove_suffix(1);
    word_line_ = line_;
    if (name.empty()) fail("a joint's name", "");
    return std::string(name);
  }

  [[noreturn]] void fail(std::string_view expected, std::string_view got) const {
    const std::string cut(got.substr(0, 40));
    throw InputError(std::string(file_) + ':' + std::to_string(word_line_), "", expected,
                     got.empty() ? std::string("the end of the line or the file") : '"' + printable(cut) + '"');
  }

 private:
  void skip_spaces() {
    for (; place_ < text_.size() && is_space(text_[place_]); ++place_)
      if (text_[place_] == '\n') ++line_;
  }

  std::string_view text_, file_;
  std::size_t place_ = 0;
  int line_ = 1, word_line_ = 1;
};

struct Channel {
  Index joint = 0;
  bool turns = false;
  Eigen::Index axis = 0;
};

class BvhReader {
 public:
  BvhReader(std::string_view text, std::string_view file) : words_(text, file), file_(file) {}

  BvhMotion read() {
    read_hierarchy();
    Figure& figure = motion_.figure;
    figure.order = parents_first(figure.nodes, file_);
    read_frames();
    return std::move(motion_);
  }

 private:
  Index add_node(std::string name, Index parent) {
    Figure& figure = motion_.figure;
    if (figure.nodes.size() == most_joints) words_.fail("at most " + std::to_string(most_joints) + " joints", "more");
    figure.nodes.push_back({std::move(name), parent});
    figure.rest.nodes.emplace_back();
    return static_cast<Index>(figure.nodes.size()) - 1;
  }

  void read_hierarchy() {
    words_.expect("HIERARCHY");
    std::vector<Index> open;  // from a root to the joint whose braces are open
    for (;;) {
      const std::string_view word = words_.next();
      if (open.empty() && same_word(word, "MOTION") && !motion_.figure.nodes.empty()) return;
      if (same_word(word, open.empty() ? "ROOT" : "JOINT")) {
        open.push_back(add_node(words_.name(), open.empty() ? -1 : open.back()));
        read_joint(open.back());
      } else if (!open.empty() && same_word(word, "End")) {
        words_.expect("Site");
        const Index end = add_node({}, open.back());
        words_.expect("{");
        words_.expect("OFFSET");
        read_offset(end);
        words_.expect("}");
      } else if (!open.empty() && word == "}") {
        open.pop_back();
      } else {
        words_.fail(open.empty() ? "ROOT or MOTION" : "JOINT, End Site or }", word);
      }
    }
  }

  void read_joint(Index joint) {
    words_.expect("{");
    words_.expect("OFFSET");
    read_offset(joint);
    words_.expect("CHANNELS");
    for (std::size_t left = words_.count(most_channels); left > 0; --left) channels_.push_back(read_channel(joint));
  }

  void read_offset(Index joint) {
    for (Eigen::Index k = 0; k < 3; ++k) motion_.figure.rest.nodes[at(joint)].translation[k] = words_.number(farthest);
  }

  Channel read_channel(Index joint) {
    const std::string_view word = words_.next();
    const bool turns = same_word(word.substr(word.empty() ? 0 : 1), "rotation");
    const Eigen::Index axis = word.empty() ? -1 : lower(word.front()) - 'x';
    if (axis < 0 || axis > 2 || (!turns && !same_word(word.substr(1), "position")))
      words_.fail("Xposition, Yrotation or the like", word);
    return {joint, turns, axis};
  }

  void read_frames() {
    words_.expect("Frames:");
    const std::size_t frames = words_.count(std::size_t{1} << 30);
    if (frames == 0) words_.fail("at least one frame", "0");
    words_.expect("Frame");
    words_.expect("Time:");
    const double seconds = words_.number(longest_frame_s);
    if (!(seconds >= shortest_frame_s)) words_.fail("a time of at least 0.0001 s", std::to_string(seconds));
    if (channels_.empty()) words_.fail("at least one channel", "none");
    check_track_size(static_cast<double>(frames), motion_.figure.nodes.size(), file_);
    motion_.track.rate_hz = 1 / seconds;
    for (std::size_t frame = 0; frame < frames; ++frame) motion_.track.poses.push_back(read_frame());
    if (const std::string_view more = words_.next(); !more.empty())
      words_.fail("the end after " + std::to_string(frames) + " frames", more);
  }

  FigurePose read_frame() {
    static const std::array<Vec3, 3> axes = {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
    FigurePose pose = motion_.figure.rest;
    for (const Channel& channel : channels_) {
      NodePose& node = pose.nodes[at(channel.joint)];
      if (channel.turns) {
        const double degrees = words_.number(most_degrees);
        node.turn =
            node.turn * rotation_about(axes[at(static_cast<Index>(channel.axis))], degrees * std::numbers::pi / 180);
      } else {
        node.translation[channel.axis] = words_.number(farthest);
      }
    }
    return pose;
  }

  BvhWords words_;
  std::string_view file_;
  BvhMotion motion_;
  std::vector<Channel> channels_;
};

}  // namespace

BvhMotion parse_bvh(std::string_view text, std::string_view file) { return BvhReader(text, file).read(); }

BvhMotion load_bvh(const std::string& path, std::string& text) {
  text = read_file(path, bvh_limit);
  return parse_bvh(text, printable(path));
}

bool has_bvh_ending(std::string_view path) {
  return path.size() >= 4 && same_word(path.substr(path.size() - 4), ".bvh");
}

}  // namespace toile::internal
