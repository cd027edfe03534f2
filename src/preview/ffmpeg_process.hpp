// preview/ffmpeg_process.hpp: the program `ffmpeg` as a child that takes raw pictures and writes a film.
//
// No shell: names of files never become part of a command line.  The parent's signal handling is not touched: pictures go
// through a socket, where writing to a dead child is an error value and no SIGPIPE.
//
// Mind: ffmpeg writes to an open file descriptor, which need not have a name yet: the caller names the file.
#pragma once
#include <cstddef>
#include <functional>
#include <span>
#include <string>

namespace toile::internal {

// The first executable file `ffmpeg` in PATH.  Throws IoError, with advice, if there is none.
std::string find_ffmpeg();

class FfmpegProcess {
 public:
  // Starts the encoder; `film` is the result's name in messages, `output` the descriptor of the file that ffmpeg writes.  Throws IoError.
  FfmpegProcess(const std::string& program, const std::string& film, int output, int width, int height, double fps);
  // A child that was not finished is killed.
  ~FfmpegProcess();
  FfmpegProcess(const FfmpegProcess&) = delete;
  FfmpegProcess& operator=(const FfmpegProcess&) = delete;

  // Blocks until the child has taken everything.  Throws IoError with the child's last line when it ended.
  void write(std::span<const unsigned char> bytes);
  // End of the film: waits for the child.  Throws IoError when it failed.  `stop`, if there is one, is asked meanwhile: true is
  // Error(interrupted).
  void finish(const std::function<bool()>& stop = {});

 private:
  [[noreturn]] void fail(const std::string& what);
  bool read_messages();
  int wait();

  std::string film_, messages_;
  int child_ = -1;   // process id
  int input_ = -1;   // our end of the child's standard input
  int errors_ = -1;  // our end of the child's standard error
};

}  // namespace toile::internal
