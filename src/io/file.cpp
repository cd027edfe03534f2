#include "io/file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "core/error.hpp"

namespace toile {
namespace {

// "cannot open: No such file or directory"
std::string reason(std::string_view what, int error) {
  return std::string(what) + ": " + std::generic_category().message(error);
}

// The name that the system would see ends at a NUL byte: another file than the one asked for.
void check_name(const std::string& path) {
  if (path.empty()) throw IoError(path, "cannot open: the name is empty");
  if (path.find('\0') != std::string::npos) throw IoError(path, "cannot open: the name has a NUL byte");
}

// fsync, repeated when a signal interrupts it; returns errno, 0 when done or when the file system has no such thing.
int synchronize(int descriptor) {
  int result;
  do {
    result = ::fsync(descriptor);
  } while (result != 0 && errno == EINTR);
  if (result == 0 || errno == EINVAL || errno == ENOTSUP || errno == EROFS) return 0;
  return errno;
}

// The new name itself is in the directory.  A directory that may not be read cannot be synchronized; the file is there
// all the same.
int synchronize_directory_of(const std::string& path) {
  const std::string parent = std::filesystem::path(path).parent_path().string();
  const int directory = ::open(parent.empty() ? "." : parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (directory < 0) return 0;
  const int error = synchronize(directory);
  ::close(directory);
  return error;
}

}  // namespace

std::FILE* open_regular_file(const std::string& path, std::uint64_t& size_bytes) {
  check_name(path);
  // O_NONBLOCK: opening a pipe that nobody writes to would wait forever.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) throw IoError(path, reason("cannot open", errno));
  struct stat status {};
  const int error = ::fstat(descriptor, &status) == 0 ? 0 : errno;
  if (error != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor);
    if (error != 0) throw IoError(path, reason("cannot open", error));
    if (S_ISDIR(status.st_mode)) throw IoError(path, reason("cannot open", EISDIR));
    throw IoError(path, "cannot open: not a regular file");
  }
  std::FILE* file = ::fdopen(descriptor, "rb");
  if (!file) {
    const int fdopen_error = errno;
    ::close(descriptor);
    throw IoError(path, reason("cannot open", fdopen_error));
  }
  size_bytes = static_cast<std::uint64_t>(status.st_size);
  return file;
}

std::string read_file(const std::string& path, std::size_t limit_bytes) {
  const auto too_large = [&](const std::string& size) {
    throw InputError(printable(path), "", "a file of at most " + std::to_string(limit_bytes) + " bytes", size);
  };
  struct Closed {
    std::FILE* file;
    ~Closed() { std::fclose(file); }
  };
  std::uint64_t size = 0;
  const Closed closed{open_regular_file(path, size)};
  if (size > limit_bytes) too_large(std::to_string(size));

  // The size is only a hint: some files tell none (/proc), others grow meanwhile.
  std::string text;
  std::size_t count = 0;
  text.resize(static_cast<std::size_t>(size) + 1);
  for (;;) {
    const std::size_t got = std::fread(text.data() + count, 1, text.size() - count, closed.file);
    count += got;
    if (count > limit_bytes) too_large("more");
    if (count < text.size()) break;
    text.resize(text.size() + std::max<std::size_t>(text.size() / 2, 4096));
  }
  if (std::ferror(closed.file)) throw IoError(path, reason("cannot read", errno));
  text.resize(count);
  return text;
}

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)), temporary_(path_ + ".tmp") {
  check_name(path_);
  // Better now than at the end of a long run.
  struct stat status {};
  if (::stat(path_.c_str(), &status) == 0 && S_ISDIR(status.st_mode)) fail("cannot create", EISDIR);
  // What a killed run has left, or a link that somebody has planted.
  if (::unlink(temporary_.c_str()) != 0 && errno != ENOENT) fail("cannot create", errno);
  const int descriptor =
      ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);  // less the umask
  if (descriptor < 0) fail("cannot create", errno);
  file_ = ::fdopen(descriptor, "wb");
  if (!file_) {
    const int error = errno;
    ::close(descriptor);
    ::unlink(temporary_.c_str());
    fail("cannot create", error);
  }
}

AtomicFile::~AtomicFile() {
  if (!file_) return;
  std::fclose(file_);
  ::unlink(temporary_.c_str());
}

void AtomicFile::fail(std::string_view what, int error) const {
  std::string text = reason(what, error);
  if (error == ENOSPC) {
    std::error_code ignored;
    const auto parent = std::filesystem::path(path_).parent_path();
    const auto space = std::filesystem::space(parent.empty() ? "." : parent, ignored);
    if (!ignored) {
      text += " (" + std::to_string(size_) + " bytes written, " + std::to_string(space.available) + " bytes free)";
    }
  }
  throw IoError(path_, text);
}

void AtomicFile::write(const void* data, std::size_t size) {
  if (!file_) fail("cannot write", EBADF);
  if (size == 0) return;
  if (std::fwrite(data, 1, size, file_) != size) fail("cannot write", errno);
  size_ += size;
}

void AtomicFile::overwrite(std::size_t offset, const void* data, std::size_t size) {
  if (!file_) fail("cannot write", EBADF);
  if (offset > size_ || size > size_ - offset) fail("cannot overwrite what was not written", EINVAL);
  if (::fseeko(file_, static_cast<off_t>(offset), SEEK_SET) != 0) fail("cannot write", errno);
  if (size > 0 && std::fwrite(data, 1, size, file_) != size) fail("cannot write", errno);
  if (::fseeko(file_, 0, SEEK_END) != 0) fail("cannot write", errno);
}

void AtomicFile::commit() {
  if (!file_) fail("cannot write", EBADF);
  if (std::fflush(file_) != 0) fail("cannot write", errno);
  if (const int error = synchronize(::fileno(file_))) fail("cannot write", error);
  std::FILE* const file = file_;
  file_ = nullptr;  // from here the destructor has nothing to do
  if (std::fclose(file) != 0) {
    const int error = errno;
    ::unlink(temporary_.c_str());
    fail("cannot write", error);
  }
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) {
    const int error = errno;
    ::unlink(temporary_.c_str());
    fail("cannot rename the finished file", error);
  }
  if (const int error = synchronize_directory_of(path_)) fail("cannot write the directory", error);
}

void make_directories(const std::string& path) {
  if (path.empty()) return;
  check_name(path);
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (!error && !std::filesystem::is_directory(path, error) && !error) {
    error = std::make_error_code(std::errc::not_a_directory);
  }
  if (error) throw IoError(path, "cannot create the directory: " + error.message());
}

}  // namespace toile
