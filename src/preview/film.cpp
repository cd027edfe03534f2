// preview/film.cpp: pictures as a film.
//
// Mind: ffmpeg gets the size from the first picture, so it starts after that one was made; whether the program exists is
// checked before, since a picture may take seconds.
#include "core/error.hpp"
#include "io/file.hpp"
#include "preview/ffmpeg_process.hpp"
#include "preview/preview.hpp"

#include <cmath>
#include <optional>

namespace toile::internal {
namespace {

std::string size_of(const Image& image) { return std::to_string(image.width) + " x " + std::to_string(image.height); }

}  // namespace

void write_mp4(const std::string& path, int count, double fps, const std::function<Image(int)>& picture,
               const std::function<bool()>& stop) {
  if (count < 1) throw InputError(path, "film", "at least one picture", std::to_string(count));
  if (!(fps > 0 && fps <= 1000))
    throw InputError(path, "film", "a frame rate in (0, 1000] per second", std::to_string(fps));
  const std::string program = find_ffmpeg();

  AtomicFile film(path);                // a missing or unwritable folder is reported before the first picture
  std::optional<FfmpegProcess> ffmpeg;  // after `film`: on the way out the child is ended first
  int width = 0, height = 0;
  for (int i = 0; i < count; ++i) {
    const Image image = picture(i);
    if (i == 0) {
      width = image.width;
      height = image.height;
    }
    const bool whole = image.rgb.size() == 3 * static_cast<std::size_t>(std::max(image.width, 0)) *
                                               static_cast<std::size_t>(std::max(image.height, 0));
    if (image.width < 2 || image.height < 2 || image.width != width || image.height != height || !whole) {
      throw InputError(path, "film: picture " + std::to_string(i),
                       i == 0 ? "2 x 2 pixels or more" : std::to_string(width) + " x " + std::to_string(height),
                       size_of(image) + " with " + std::to_string(image.rgb.size()) + " bytes");
    }
    if (!ffmpeg) ffmpeg.emplace(program, path, film.descriptor(), width, height, fps);
    ffmpeg->write(image.rgb);
  }
  ffmpeg->finish(stop);
  film.commit();
}

}  // namespace toile::internal
