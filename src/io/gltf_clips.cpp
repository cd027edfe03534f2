#include "io/gltf_clips.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace toile::internal {
namespace {

using Moves = ClipChannel::Moves;
using Between = ClipChannel::Between;

constexpr std::size_t most_numbers = std::size_t{1} << 25;  // in all clips: 256 MiB
constexpr double latest_s = 1e5;                            // more than a day

std::optional<Moves> moves_of(const std::string& path) {
  if (path == "translation") return Moves::translation;
  if (path == "rotation") return Moves::turn;
  if (path == "scale") return Moves::scale;
  if (path == "weights") return Moves::weights;
  return std::nullopt;
}

class ClipReader {
 public:
  ClipReader(const tinygltf::Model& model, const GltfNumbers& numbers, const Figure& figure, const std::string& file)
      : model_(&model), numbers_(&numbers), figure_(&figure), file_(&file) {}

  Clip read(std::size_t number) {
    const tinygltf::Animation& animation = model_->animations[number];
    const std::string place = "/animations/" + std::to_string(number);
    Clip clip;
    clip.name = animation.name.empty() ? std::to_string(number) : animation.name;
    clip.begin_s = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < animation.channels.size(); ++k) {
      auto channel = read_channel(animation, k, place + "/channels/" + std::to_string(k));
      if (!channel) continue;
      clip.begin_s = std::min(clip.begin_s, channel->times.front());
      clip.end_s = std::max(clip.end_s, channel->times.back());
      clip.channels.push_back(std::move(*channel));
    }
    if (clip.channels.empty()) clip.begin_s = clip.end_s = 0;
    return clip;
  }

 private:
  std::size_t width(const ClipChannel& channel) const {
    if (channel.moves == Moves::weights) return at(figure_->nodes[at(channel.node)].weights);
    return channel.moves == Moves::turn ? 4 : 3;
  }

  std::optional<ClipChannel> read_channel(const tinygltf::Animation& animation, std::size_t number,
                                          const std::string& place) {
    const tinygltf::AnimationChannel& given = animation.channels[number];
    const auto moves = moves_of(given.target_path);
    if (given.target_node < 0 || !moves) return std::nullopt;
    if (at(given.target_node) >= figure_->nodes.size())
      throw InputError(*file_, place + "/target/node", "a node below " + std::to_string(figure_->nodes.size()),
                       std::to_string(given.target_node));
    if (given.sampler < 0 || at(given.sampler) >= animation.samplers.size())
      throw InputError(*file_, place + "/sampler", "a number below " + std::to_string(animation.samplers.size()),
                       std::to_string(given.sampler));
    const tinygltf::AnimationSampler& sampler = animation.samplers[at(given.sampler)];
    ClipChannel channel;
    channel.node = given.target_node;
    channel.moves = *moves;
    if (width(channel) == 0) return std::nullopt;
    if (sampler.interpolation == "STEP")
      channel.between = Between::step;
    else if (sampler.interpolation == "CUBICSPLINE")
      channel.between = Between::cubic;
    else if (!sampler.interpolation.empty() && sampler.interpolation != "LINEAR")
      throw InputError(*file_, place, "an interpolation of LINEAR, STEP or CUBICSPLINE",
                       '"' + printable(sampler.interpolation) + '"');
    channel.times = numbers_->read(sampler.input, TINYGLTF_TYPE_SCALAR, most_numbers);
    const int type = channel.moves == Moves::weights ? TINYGLTF_TYPE_SCALAR
                     : channel.moves == Moves::turn  ? TINYGLTF_TYPE_VEC4
                                                     : TINYGLTF_TYPE_VEC3;
    channel.values = numbers_->read(sampler.output, type, most_numbers);
    check(channel, place);
    return channel;
  }

  void check(const ClipChannel& channel, const std::string& place) {
    const std::vector<double>& times = channel.times;
    if (times.empty()) throw InputError(*file_, place, "at least one key", "none");
    for (std::size_t k = 0; k < times.size(); ++k) {
      const bool ascends = k == 0 || times[k] > times[k - 1];
      if (!ascends || times[k] < 0 || times[k] > latest_s)
        throw InputError(*file_, place + ", key " + std::to_string(k), "times that ascend, from 0 to 1e5 s",
                         std::to_string(times[k]));
    }
    const std::size_t each = width(channel) * (channel.between == Between::cubic ? 3 : 1);
    if (channel.values.size() != each * times.size())
      throw InputError(
          *file_, place,
          std::to_string(each * times.size()) + " numbers for its " + std::to_string(times.size()) + " keys",
          std::to_string(channel.values.size()));
    if (channel.moves == Moves::turn) check_turns(channel, place);
    numbers_read_ += times.size() + channel.values.size();
    if (numbers_read_ > most_numbers)
      throw InputError(*file_, place, "at most " + std::to_string(most_numbers) + " numbers in all animations", "more");
  }

  void check_turns(const ClipChannel& channel, const std::string& place) const {
    const bool cubic = channel.between == Between::cubic;
    for (std::size_t k = 0; k < channel.times.size(); ++k) {
      double squares = 0;
      for (std::size_t c = 0; c < 4; ++c) {
        const double q = channel.values[4 * (cubic ? 3 * k + 1 : k) + c];
        squares += q * q;
      }
      if (!(squares > 0 && std::isfinite(squares)))
        throw InputError(*file_, place + ", key " + std::to_string(k), "a quaternion of length 1",
                         squares == 0 ? "0" : "infinity");
    }
  }

  const tinygltf::Model* model_;
  const GltfNumbers* numbers_;
  const Figure* figure_;
  const std::string* file_;
  std::size_t numbers_read_ = 0;
};

}  // namespace

std::vector<Clip> gltf_clips(const tinygltf::Model& model, const GltfNumbers& numbers, const Figure& figure,
                             const std::string& file) {
  ClipReader reader(model, numbers, figure, file);
  std::vector<Clip> clips;
  for (std::size_t k = 0; k < model.animations.size(); ++k) clips.push_back(reader.read(k));
  return clips;
}

}  // namespace toile::internal
