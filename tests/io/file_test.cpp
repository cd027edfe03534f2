#include "io/file.hpp"

#include "core/hash.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "io/scratch.hpp"

namespace toile::internal {
namespace {

using namespace std::string_literals;

// It is read in pieces of a mebibyte.
TEST(ReadFile, AFilesChecksumIsThatOfItsBytes) {
  const Scratch scratch;
  std::string bytes;
  for (const std::size_t size : {0UL, 1UL, 8UL, 13UL, 1UL << 20, (1UL << 20) + 3, (3UL << 20) - 1}) {
    while (bytes.size() < size) bytes += static_cast<char>(bytes.size() * 7 + bytes.size() / 251);
    bytes.resize(size);
    EXPECT_EQ(checksum_of_file(scratch.put("f", bytes)), hex_of(checksum(bytes.data(), size))) << size;
    bytes.clear();
  }
}

TEST(ReadFile, ReturnsEveryByte) {
  const Scratch scratch;
  std::string bytes;
  for (int i = 0; i < 100'000; ++i) bytes += static_cast<char>(i % 251);
  bytes += "\0\r\n\x1a"s;
  EXPECT_EQ(read_file(scratch.put("bytes", bytes)), bytes);
  EXPECT_EQ(read_file(scratch.put("empty", "")), "");
}

TEST(ReadFile, RefusesMoreThanTheLimit) {
  const Scratch scratch;
  const std::string path = scratch.put("five", "12345");
  EXPECT_EQ(read_file(path, 5), "12345");
  EXPECT_EQ(message_of<InputError>([&] { read_file(path, 4); }), path + ": expected a file of at most 4 bytes, got 5");
}

TEST(ReadFile, NamesThePathAndTheReason) {
  const Scratch scratch;
  EXPECT_EQ(message_of<IoError>([&] { read_file(scratch / "none"); }),
            scratch / "none" + ": cannot open: No such file or directory");
  EXPECT_EQ(message_of<IoError>([&] { read_file(scratch.directory()); }),
            scratch.directory() + ": cannot open: Is a directory");
  EXPECT_EQ(message_of<IoError>([] { read_file(""); }), ": cannot open: the name is empty");
  EXPECT_THROW(read_file(scratch.put("a", "x") + "\0.obj"s), IoError);
}

TEST(ReadFile, ReadsNoPipesAndNoDevices) {
  const Scratch scratch;
  ASSERT_EQ(::mkfifo((scratch / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(message_of<IoError>([&] { read_file(scratch / "pipe"); }),
            scratch / "pipe" + ": cannot open: not a regular file");
  EXPECT_THROW(read_file("/dev/zero"), IoError);
}

TEST(ReadFile, ReadsFilesThatTellNoSize) {
  if (!std::filesystem::exists("/proc/self/status")) GTEST_SKIP() << "no /proc on this machine";
  EXPECT_NE(read_file("/proc/self/status").find("Pid:"), std::string::npos);
  EXPECT_THROW(read_file("/proc/self/status", 10), InputError);
}

TEST(AtomicFile, AppearsWhenCommitted) {
  const Scratch scratch;
  AtomicFile file(scratch / "a");
  file.write("one ");
  file.write("");
  file.write("two");
  EXPECT_FALSE(std::filesystem::exists(scratch / "a"));
  file.commit();
  EXPECT_EQ(scratch.get("a"), "one two");
  EXPECT_EQ(scratch.file_count(), 1u);
}

TEST(AtomicFile, LeavesNothingWhenNotCommitted) {
  const Scratch scratch;
  {
    AtomicFile file(scratch / "a");
    file.write("half");
  }
  EXPECT_EQ(scratch.file_count(), 0u);
}

TEST(AtomicFile, KeepsTheOldFileUntilCommitted) {
  const Scratch scratch;
  scratch.put("a", "old");
  {
    AtomicFile file(scratch / "a");
    file.write("half of the new one");
  }
  EXPECT_EQ(scratch.get("a"), "old");
  AtomicFile file(scratch / "a");
  file.write("new");
  EXPECT_EQ(scratch.get("a"), "old");
  file.commit();
  EXPECT_EQ(scratch.get("a"), "new");
}

TEST(AtomicFile, HasNoNameThatCouldBePlantedOrShared) {
  const Scratch scratch;
  scratch.put("victim", "precious");
  std::filesystem::create_symlink(scratch / "victim", scratch / "a.tmp");
  AtomicFile one(scratch / "a"), other(scratch / "a");
  one.write("one");
  other.write("other");
  EXPECT_EQ(scratch.file_count(), 2u) << "the victim and the link";
  one.commit();
  EXPECT_EQ(scratch.get("a"), "one");
  other.commit();
  EXPECT_EQ(scratch.get("a"), "other");
  EXPECT_EQ(scratch.get("victim"), "precious");
  EXPECT_EQ(scratch.file_count(), 3u);
}

TEST(AtomicFile, ReplacesALinkAndNotWhatItLeadsTo) {
  const Scratch scratch;
  scratch.put("victim", "precious");
  std::filesystem::create_symlink(scratch / "victim", scratch / "a");
  AtomicFile file(scratch / "a");
  file.write("new");
  file.commit();
  EXPECT_EQ(scratch.get("victim"), "precious");
  EXPECT_EQ(scratch.get("a"), "new");
  EXPECT_FALSE(std::filesystem::is_symlink(scratch / "a"));
}

TEST(AtomicFile, NamesThePathAndTheReason) {
  const Scratch scratch;
  const std::string missing = scratch / "none/a";
  EXPECT_EQ(message_of<IoError>([&] { AtomicFile file(missing); }),
            missing + ": cannot create: No such file or directory");
  std::filesystem::create_directory(scratch / "d");
  EXPECT_EQ(message_of<IoError>([&] { AtomicFile file(scratch / "d"); }),
            scratch / "d" + ": cannot create: Is a directory");
}

// The superuser may write anywhere: while this lives, such a process is nobody.
class OrdinaryUser {
 public:
  OrdinaryUser() : before_(::geteuid()), dropped_(before_ == 0 && ::seteuid(65534) == 0) {}
  ~OrdinaryUser() {
    if (dropped_ && ::seteuid(before_) != 0) std::abort();
  }

 private:
  uid_t before_;
  bool dropped_;
};

TEST(AtomicFile, NamesTheDirectoryThatMayNotBeWritten) {
  const Scratch scratch;
  std::filesystem::create_directory(scratch / "d");
  std::filesystem::permissions(scratch / "d", std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec |
                                                  std::filesystem::perms::others_exec);
  {
    const OrdinaryUser user;
    EXPECT_EQ(message_of<IoError>([&] { AtomicFile file(scratch / "d/a"); }),
              scratch / "d/a" + ": cannot create: Permission denied");
    EXPECT_EQ(message_of<IoError>([&] { make_directories(scratch / "d/e"); }),
              scratch / "d/e" + ": cannot create the directory: Permission denied");
  }
  std::filesystem::permissions(scratch / "d", std::filesystem::perms::owner_all);
}

// While it lives, no file of this process may grow beyond `bytes`: the nearest thing to a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limited{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limited);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  void (*handler_)(int);
  rlimit before_{};
};

TEST(AtomicFile, ReportsAWriteThatFailsAndKeepsTheOldFile) {
  const Scratch scratch;
  scratch.put("a", "old");
  {
    AtomicFile file(scratch / "a");
    const FileSizeLimit limit(1 << 16);
    const std::string megabyte(1 << 20, 'x');
    EXPECT_EQ(message_of<IoError>([&] { file.write(megabyte); }), scratch / "a" + ": cannot write: File too large");
  }
  EXPECT_EQ(scratch.get("a"), "old");
  EXPECT_EQ(scratch.file_count(), 1u);
}

TEST(AtomicFile, ReportsAWriteThatFailsAsLateAsInCommit) {
  const Scratch scratch;
  {
    AtomicFile file(scratch / "a");
    const FileSizeLimit limit(10);
    file.write("more than ten bytes, in the buffer");
    EXPECT_EQ(message_of<IoError>([&] { file.commit(); }), scratch / "a" + ": cannot write: File too large");
  }
  EXPECT_EQ(scratch.file_count(), 0u);
}

TEST(AtomicFile, ReportsAFailingRenameAndLeavesNothing) {
  const Scratch scratch;
  {
    AtomicFile file(scratch / "a");
    file.write("new");
    std::filesystem::create_directories(scratch / "a/b");  // a directory came into the way meanwhile
    EXPECT_EQ(message_of<IoError>([&] { file.commit(); }).substr(0, (scratch / "a").size() + 2), scratch / "a" + ": ");
  }
  EXPECT_FALSE(std::filesystem::exists(scratch / "a.tmp"));
}

TEST(AtomicFile, TakesNothingAfterItsEnd) {
  const Scratch scratch;
  AtomicFile file(scratch / "a");
  file.commit();
  EXPECT_THROW(file.write("x"), IoError);
  EXPECT_THROW(file.commit(), IoError);
  EXPECT_EQ(scratch.get("a"), "");
}

TEST(GrowingFile, KeepsWhatWasWrittenWhenAWriteFails) {
  const Scratch scratch;
  GrowingFile file(scratch / "a", GrowingFile::Open::create);
  file.append("0123456789", 10);
  file.overwrite(2, "xy", 2);
  EXPECT_EQ(scratch.get("a"), "01xy456789");
  EXPECT_THROW(file.overwrite(9, "xy", 2), IoError);
  {
    const FileSizeLimit limit(12);
    EXPECT_EQ(message_of<IoError>([&] { file.append("abcdef", 6); }), scratch / "a" + ": cannot write: File too large");
  }
  EXPECT_EQ(file.size(), 10u);
  file.append("z", 1);
  file.truncate(11);
  EXPECT_EQ(scratch.get("a"), "01xy456789z");
  EXPECT_THROW(GrowingFile(scratch / "a", GrowingFile::Open::create), IoError);
  EXPECT_THROW(GrowingFile(scratch / "none", GrowingFile::Open::existing), IoError);
  std::filesystem::create_symlink(scratch / "a", scratch / "link");
  EXPECT_THROW(GrowingFile(scratch / "link", GrowingFile::Open::existing), IoError);
  EXPECT_THROW(GrowingFile(scratch.directory(), GrowingFile::Open::existing), IoError);
}

TEST(MakeDirectories, CreatesAllParents) {
  const Scratch scratch;
  make_directories(scratch / "a/b/c");
  EXPECT_TRUE(std::filesystem::is_directory(scratch / "a/b/c"));
  make_directories(scratch / "a/b/c");
  make_directories(scratch / "a/d/");
  EXPECT_TRUE(std::filesystem::is_directory(scratch / "a/d"));
  make_directories("");
}

TEST(MakeDirectories, NamesThePathAndTheReason) {
  const Scratch scratch;
  scratch.put("file", "x");
  EXPECT_EQ(message_of<IoError>([&] { make_directories(scratch / "file"); }),
            scratch / "file" + ": cannot create the directory: Not a directory");
  EXPECT_EQ(message_of<IoError>([&] { make_directories(scratch / "file/below"); }),
            scratch / "file/below" + ": cannot create the directory: Not a directory");
}

}  // namespace
}  // namespace toile::internal
