// io/file.hpp: whole files in; files that appear only when they are complete, and files that grow.
//
// Only regular files are read: a pipe or a device may never end.  Easily missed: a full disk is reported by whichever
// call happens to flush, often not before commit().
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace toile::internal {

// The whole file.  Throws IoError (cannot open, is a directory, read error) or InputError when larger than `limit`.
std::string read_file(const std::string& path, std::size_t limit_bytes = std::size_t{1} << 31);

// core/hash.hpp: of all its bytes, in hexadecimal digits.  Throws IoError.
std::string checksum_of_file(const std::string& path);

// Opens a regular file for reading, for the caller to close, and returns its size too.  Throws IoError.
std::FILE* open_regular_file(const std::string& path, std::uint64_t& size_bytes);

// A file that appears under its name in commit(), complete: without commit() nothing is left and an older file of that name stays.
// Until then it has no name at all (O_TMPFILE), so that nothing can be planted or shared under it and a process that is killed leaves nothing
// behind; on file systems without O_TMPFILE it has an unpredictable name, "<path>.<16 digits>.tmp", which is never followed nor reused.
// Throws IoError, naming the path and the system's reason, from every call.  The data are on the disk before the name is.
class AtomicFile {
 public:
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(const void* data, std::size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }
  // Once; nothing may be written afterwards.
  void commit();

  // For a program that writes the file itself; open until commit().
  int descriptor() const;
  const std::string& path() const { return path_; }

 private:
  [[noreturn]] void fail(std::string_view what, int error) const;
  void give_name();

  std::string path_, temporary_;  // temporary_ is empty while the file has no name
  std::FILE* file_ = nullptr;
  std::uint64_t size_ = 0;
};

// A file that is appended to while others may read it; the data written so far survive a crash of the process.
// Throws IoError as AtomicFile does.
class GrowingFile {
 public:
  enum class Open { create, existing };
  // create: there must be no file of that name.  Links are not followed.
  GrowingFile(std::string path, Open how);
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  // Appends all bytes, or throws and leaves the size as it was.
  void append(const void* data, std::size_t size);
  void overwrite(std::uint64_t offset, const void* data, std::size_t size);
  void truncate(std::uint64_t size);
  // Flushes the data written so far to the disk.  May be called while another thread appends.
  void synchronize() const;

  std::uint64_t size() const { return size_; }
  const std::string& path() const { return path_; }

 private:
  void write_at(std::uint64_t offset, const void* data, std::size_t size);

  std::string path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

// Removes a file or a link, if it exists.  Throws IoError.
void remove_file(const std::string& path);
// Flushes the folder's entries to the disk.  Throws IoError.
void synchronize_directory(const std::string& directory);

// Creates the directory and its missing parents; "" is the current one.  Throws IoError.
void make_directories(const std::string& path);

}  // namespace toile::internal
