// io/run_folder.hpp: whose files a folder's files are, and who may write there.                       docs/reports.md#the-folder
//
//   report.json        of a finished run: its "files" are Toile's
//   unfinished.json    of a run that goes on, or was ended before its end: who, what was asked for, where; its files are Toile's, too
//   a lock             on the folder itself, held while a process lives: one writer at a time
//
// Nothing else is ever replaced or removed: a name of ours that neither file lists is somebody's, and the run is refused before it begins.
//
// Easily got wrong: the system takes the lock from a process that dies, so that there is no stale lock; unfinished.json stays, and says that
// there is something to go on with.
#pragma once
#include "io/json.hpp"
#include "io/json_text.hpp"

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

// Every name that Toile may use in the folder of a run.
inline constexpr std::array<std::string_view, 15> run_file_names = {
    "report.json", "cloth.obj",  "cloth.pc2",       "body.obj",       "body.pc2",
    "sewing.obj",  "sewing.pc2", "sewing_body.obj", "offenders.obj",  "preview.png",
    "preview.mp4", "frames.png", "crossings.png",   "checkpoint.bin", "unfinished.json"};
// Of these the ones that are drawn of a finished run.
inline constexpr std::array<std::string_view, 4> picture_file_names = {"preview.png", "preview.mp4", "frames.png",
                                                                       "crossings.png"};

// What unfinished.json says.
struct UnfinishedRun {
  std::vector<std::string> arguments;  // of the command, the program's name left out
  std::string working_directory;       // in which relative paths of `arguments` are meant
  std::string version;
  std::string process;  // "process 123 on host since 2026-01-31T12:00:00Z: toile run scene.json"
  // What the report would say of the caches, once there are any.
  double fps = 0;
  std::optional<Json> rest_stretch;
  int body_vertices = 0, motion_first_frame = -1;
};
// Empty when the folder has no unfinished run.  Throws InputError for a file that is none of ours.
std::optional<UnfinishedRun> read_unfinished_run(const std::string& directory);
// A living process writes to the folder.
bool is_written_to(const std::string& directory);

class RunFolder {
 public:
  enum class Use {
    new_run,   // makes the folder, and takes over what an earlier run of ours left
    resume,    // the folder of an unfinished run
    pictures,  // adds pictures to a run; takes the lock and nothing else
  };
  struct Owner {
    std::string command;  // as typed
    std::vector<std::string> arguments;
    std::string version;
  };
  // Throws IoError when another process writes there, naming it; when a file stands under a name of ours that no run of ours has listed; when one
  // of `inputs` (files or folders that exist) is the folder or a file of ours in it; when nothing can be written there.
  RunFolder(std::string directory, Use use, const Owner& owner, std::span<const std::string> inputs);
  // A new run that did not begin leaves everything as it was.
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  // Of a new run: removes what an earlier one left, its report first.
  void begin();
  // Before the first frame: what readers of an unfinished run have to know; writes members of unfinished.json.
  void set_facts(const std::function<void(JsonText&)>& facts);
  // After report.json has been written: the run is finished, or (`goes_on`) can be taken up again.
  void finish(bool goes_on);

  // An earlier run there was not finished.
  bool was_unfinished() const { return was_unfinished_; }
  const std::string& directory() const { return directory_; }
  std::string path(std::string_view name) const;

 private:
  void lock();
  void refuse_strangers(std::span<const std::string_view> names) const;
  void refuse_inputs(std::span<const std::string> inputs) const;
  void write_unfinished(const std::function<void(JsonText&)>& facts) const;
  void undo() const;

  std::string directory_, made_;  // made_: the first folder on the way that did not exist
  Use use_;
  Owner owner_;
  int lock_ = -1;
  bool begun_ = false, was_unfinished_ = false;
};

// A JSON text that notices its own change: sealed, its last member is "report_hash", the checksum of all bytes before that value.
std::string sealed(std::string json_object);
// Whether it is as it was sealed.
bool is_intact(std::string_view text);

}  // namespace toile::internal
