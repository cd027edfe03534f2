// preview/film.cpp: pictures as a film.
//
// Mind: ffmpeg learns the size from the first picture, so it starts after that one was made; that the program is there at all
// is looked up before, since a picture may take seconds.
#include "core/error.hpp"
#include "preview/ffmpeg_process.hpp"
#include "preview/preview.hpp"

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <optional>

namespace toile {
namespace {

// Removes the file when it was not renamed to its final name.
class TemporaryFilm {
 public:
  explicit TemporaryFilm(const std::string& path) : path_(path), temporary_(path + ".tmp") {}
  ~TemporaryFilm() {
    if (!renamed_) std::remove(temporary_.c_str());
  }
  TemporaryFilm(const TemporaryFilm&) = delete;
  TemporaryFilm& operator=(const TemporaryFilm&) = delete;

  const std::string& name() const { return temporary_; }
  // Opens it once for writing: a folder that is missing or closed to us is told before the first picture, in the system's words.
  void probe() const {
    std::FILE* file = std::fopen(temporary_.c_str(), "wb");
    if (!file) throw IoError(path_, std::string("cannot write the film: ") + std::strerror(errno));
    std::fclose(file);
  }
  void rename() {
    if (std::rename(temporary_.c_str(), path_.c_str()) != 0) {
      throw IoError(path_, std::string("cannot rename the finished film: ") + std::strerror(errno));
    }
    renamed_ = true;
  }

 private:
  std::string path_, temporary_;
  bool renamed_ = false;
};

std::string size_of(const Image& image) { return std::to_string(image.width) + " x " + std::to_string(image.height); }

}  // namespace

void write_mp4(const std::string& path, int count, double fps, const std::function<Image(int)>& picture,
               const std::function<bool()>& stop) {
  if (count < 1) throw InputError(path, "film", "at least one picture", std::to_string(count));
  if (!(fps > 0 && fps <= 1000))
    throw InputError(path, "film", "a frame rate in (0, 1000] per second", std::to_string(fps));
  const std::string program = find_ffmpeg();

  TemporaryFilm film(path);
  film.probe();
  std::optional<FfmpegProcess> ffmpeg;  // after `film`: on the way out the child is ended first, then its file removed
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
    if (!ffmpeg) ffmpeg.emplace(program, path, film.name(), width, height, fps);
    ffmpeg->write(image.rgb);
  }
  ffmpeg->finish(stop);
  film.rename();
}

}  // namespace toile
