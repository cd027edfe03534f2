// io/file.hpp: whole files in, and files that appear only when they are complete.
//
// Only regular files are read: a pipe or a device may never end.  Easily missed: a full disk is reported by whichever
// call happens to flush, often not before commit().
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace toile {

// The whole file.  Throws IoError (cannot open, is a directory, read error) or InputError when larger than `limit`.
std::string read_file(const std::string& path, std::size_t limit_bytes = std::size_t{1} << 31);

// A regular file opened for reading, for the caller to close, and its size.  Throws IoError.
std::FILE* open_regular_file(const std::string& path, std::uint64_t& size_bytes);

// Writes to "<path>.tmp" and renames in commit(); destroyed without commit, nothing is left and what stood under the
// name stays.  Throws IoError, naming the path and the system's reason, from every call.  The data are on the disk
// before the name is.  A symbolic link that waits under the temporary name is removed, not followed.
class AtomicFile {
 public:
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(const void* data, std::size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }
  // Overwrites bytes already written (a header's count), then continues at the end.
  void overwrite(std::size_t offset, const void* data, std::size_t size);
  // Once; nothing may be written afterwards.
  void commit();

  const std::string& path() const { return path_; }

 private:
  [[noreturn]] void fail(std::string_view what, int error) const;

  std::string path_, temporary_;
  std::FILE* file_ = nullptr;
  std::uint64_t size_ = 0;
};

// Creates the directory and its parents, as far as they are missing; "" is the current one.  Throws IoError.
void make_directories(const std::string& path);

}  // namespace toile
