#include "io/file.hpp"

#include "core/error.hpp"
#include "core/hash.hpp"

#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <vector>

namespace toile::internal {
namespace {

// "cannot open: No such file or directory"
std::string reason(std::string_view what, int error) {
  return std::string(what) + ": " + std::generic_category().message(error);
}

// For the system the name would end at a NUL byte: another file than the one asked for.
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

std::string folder_of(const std::string& path) {
  const std::string parent = std::filesystem::path(path).parent_path().string();
  return parent.empty() ? "." : parent;
}

// A directory that may not be read cannot be synchronized; the file is there all the same.
int synchronize_folder(const std::string& folder) {
  const int directory = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (directory < 0) return 0;
  const int error = synchronize(directory);
  ::close(directory);
  return error;
}

// "<path>.<16 digits>.tmp", unpredictable.
std::string unguessable_name(const std::string& path) {
  std::uint64_t number = 0;
  if (::getrandom(&number, sizeof number, 0) != static_cast<ssize_t>(sizeof number))
    throw IoError(path, reason("cannot name a temporary file", errno));
  return path + '.' + hex_of(number) + ".tmp";
}

std::string free_space(const std::string& path, std::uint64_t written) {
  std::error_code ignored;
  const auto space = std::filesystem::space(folder_of(path), ignored);
  if (ignored) return "";
  return " (" + std::to_string(written) + " bytes written, " + std::to_string(space.available) + " bytes free)";
}

}  // namespace

std::FILE* open_regular_file(const std::string& path, std::uint64_t& size_bytes) {
  check_name(path);
  // O_NONBLOCK: opening a pipe without a writer would wait forever.
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

namespace {

struct Closed {
  std::FILE* file;
  ~Closed() { std::fclose(file); }
};

}  // namespace

std::string read_file(const std::string& path, std::size_t limit_bytes) {
  const auto too_large = [&](const std::string& size) {
    throw InputError(printable(path), "", "a file of at most " + std::to_string(limit_bytes) + " bytes", size);
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

std::string checksum_of_file(const std::string& path) {
  std::uint64_t size = 0;
  const Closed closed{open_regular_file(path, size)};
  Checksum sum(size);
  std::vector<char> piece(std::size_t{1} << 20);
  for (;;) {
    const std::size_t got = std::fread(piece.data(), 1, piece.size(), closed.file);
    sum.add(piece.data(), got);
    if (got < piece.size()) break;
  }
  if (std::ferror(closed.file)) throw IoError(path, reason("cannot read", errno));
  return hex_of(sum.value());
}

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
  check_name(path_);
  // Better now than at the end of a long run.
  struct stat status {};
  if (::stat(path_.c_str(), &status) == 0 && S_ISDIR(status.st_mode)) fail("cannot create", EISDIR);
  int descriptor = ::open(folder_of(path_).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);  // less the umask
  if (descriptor < 0 && (errno == EOPNOTSUPP || errno == EISDIR || errno == EINVAL)) {
    temporary_ = unguessable_name(path_);
    descriptor = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  }
  if (descriptor < 0) fail("cannot create", errno);
  file_ = ::fdopen(descriptor, "wb");
  if (!file_) {
    const int error = errno;
    ::close(descriptor);
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
    fail("cannot create", error);
  }
}

AtomicFile::~AtomicFile() {
  if (file_) std::fclose(file_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

int AtomicFile::descriptor() const {
  if (!file_) fail("cannot write", EBADF);
  return ::fileno(file_);
}

void AtomicFile::fail(std::string_view what, int error) const {
  std::string text = reason(what, error);
  if (error == ENOSPC) text += free_space(path_, size_);
  throw IoError(path_, text);
}

void AtomicFile::write(const void* data, std::size_t size) {
  if (!file_) fail("cannot write", EBADF);
  if (size == 0) return;
  if (std::fwrite(data, 1, size, file_) != size) fail("cannot write", errno);
  size_ += size;
}

// The file gets its name directly if no file has it; else a temporary name, which is renamed over the old file.
void AtomicFile::give_name() {
  const std::string itself = "/proc/self/fd/" + std::to_string(::fileno(file_));
  const auto link_to = [&](const std::string& name) {
    return ::linkat(AT_FDCWD, itself.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0 ? 0 : errno;
  };
  int error = link_to(path_);
  if (error == 0) return;
  if (error != EEXIST) fail("cannot name the finished file", error);
  const std::string between = unguessable_name(path_);
  error = link_to(between);
  if (error != 0) fail("cannot name the finished file", error);
  temporary_ = between;
}

void AtomicFile::commit() {
  if (!file_) fail("cannot write", EBADF);
  if (std::fflush(file_) != 0) fail("cannot write", errno);
  if (const int error = synchronize(::fileno(file_))) fail("cannot write", error);
  if (temporary_.empty()) give_name();
  std::FILE* const file = file_;
  file_ = nullptr;
  if (std::fclose(file) != 0) fail("cannot write", errno);
  if (!temporary_.empty()) {
    if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail("cannot rename the finished file", errno);
    temporary_.clear();
  }
  if (const int error = synchronize_folder(folder_of(path_))) fail("cannot write the directory", error);
}

GrowingFile::GrowingFile(std::string path, Open how) : path_(std::move(path)) {
  check_name(path_);
  const bool create = how == Open::create;
  const char* const what = create ? "cannot create" : "cannot open";
  descriptor_ = ::open(path_.c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK | (create ? O_CREAT | O_EXCL : 0),
                       0666);  // less the umask
  if (descriptor_ < 0) throw IoError(path_, reason(what, errno));
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor_);
    throw IoError(path_, std::string(what) + ": not a regular file");
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

GrowingFile::~GrowingFile() { ::close(descriptor_); }

void GrowingFile::write_at(std::uint64_t offset, const void* data, std::size_t size) {
  const auto* bytes = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::pwrite(descriptor_, bytes, size, static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      const int error = written < 0 ? errno : ENOSPC;
      throw IoError(path_, reason("cannot write", error) + (error == ENOSPC ? free_space(path_, size_) : ""));
    }
    bytes += written;
    offset += static_cast<std::uint64_t>(written);
    size -= static_cast<std::size_t>(written);
  }
}

void GrowingFile::append(const void* data, std::size_t size) {
  write_at(size_, data, size);
  size_ += size;
}

void GrowingFile::overwrite(std::uint64_t offset, const void* data, std::size_t size) {
  if (offset > size_ || size > size_ - offset) throw IoError(path_, "cannot overwrite what was not written");
  write_at(offset, data, size);
}

void GrowingFile::truncate(std::uint64_t size) {
  if (::ftruncate(descriptor_, static_cast<off_t>(size)) != 0) throw IoError(path_, reason("cannot shorten", errno));
  size_ = size;
}

void GrowingFile::synchronize() const {
  if (const int error = toile::internal::synchronize(descriptor_)) throw IoError(path_, reason("cannot write", error));
}

void remove_file(const std::string& path) {
  check_name(path);
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) throw IoError(path, reason("cannot remove", errno));
}

void synchronize_directory(const std::string& directory) {
  if (const int error = synchronize_folder(directory.empty() ? "." : directory))
    throw IoError(directory, reason("cannot write the directory", error));
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

}  // namespace toile::internal
