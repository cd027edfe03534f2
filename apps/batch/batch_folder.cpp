#include "batch_folder.hpp"

#include "core/error.hpp"
#include "io/file.hpp"
#include "io/json.hpp"
#include "io/json_text.hpp"
#include "sim/report.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

namespace toile::internal {
namespace {

namespace fs = std::filesystem;

bool is_ours(const fs::path& marker) {
  try {
    return fs::exists(marker) && Json::load(marker.string()).find("toile_version") != nullptr;
  } catch (const Error&) {
    return false;
  }
}

void refuse_strangers(const fs::path& directory) {
  if (is_ours(directory / "batch.json")) return;
  for (const char* name : {"batch.json", "verdicts.jsonl", "index.sqlite", "index.html", "runs"})
    if (fs::exists(directory / name))
      throw IoError(printable((directory / name).string()),
                    "not made by an earlier batch of Toile (no batch.json there says so), and would be replaced: name "
                    "another folder with --out");
}

}  // namespace

BatchFolder::BatchFolder(std::string directory, const std::string& job_file, Use use)
    : directory_(std::move(directory)) {
  make_directories(directory_);
  lock(use);
  try {
    // Of processes that share the folder, one may write batch.json while another looks: what they see is then Toile's, too.
    refuse_strangers(directory_);
    const fs::path marker = fs::path(directory_) / "batch.json";
    if (use == Use::alone || !fs::exists(marker)) {
      JsonText json;
      json.begin_object();
      json.member("toile_version", toile_version());
      json.member("job_file", job_file);
      json.end_object();
      AtomicFile file(marker.string());
      file.write(json.str() + '\n');
      file.commit();
    }
    make_directories(directory_ + "/runs");
  } catch (...) {
    ::close(lock_);
    throw;
  }
}

BatchFolder::~BatchFolder() { ::close(lock_); }

void BatchFolder::lock(Use use) {
  lock_ = ::open(directory_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0) throw IoError(printable(directory_), std::string("cannot open: ") + std::strerror(errno));
  int result;
  do {
    result = ::flock(lock_, (use == Use::alone ? LOCK_EX : LOCK_SH) | LOCK_NB);
  } while (result != 0 && errno == EINTR);
  if (result == 0) return;
  const int error = errno;
  ::close(lock_);
  throw IoError(printable(directory_), error == EWOULDBLOCK
                                           ? std::string("another batch is at work here: wait for it, or name another "
                                                         "folder with --out")
                                           : std::string("cannot lock the folder: ") + std::strerror(error));
}

}  // namespace toile::internal
