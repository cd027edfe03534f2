// io/run_folder.hpp: ownership of the files in a run folder, and its write lock.                       docs/reports.md#the-folder
//
//   report.json        of a finished run: its "files" are Toile's
//   unfinished.json    of a run in progress, or one that was stopped early: process, command, working directory; its files are Toile's, too
//   a lock             on the folder itself, held while a process lives: one writer at a time
//
// Nothing else is ever replaced or removed: a file under a name of ours that neither lists belongs to the user, and the run is refused.
//
// Easily got wrong: the system releases the lock of a process that dies, so no lock is ever stale; unfinished.json stays, and says that
// the run can be resumed.
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

// Every file name that Toile may use in a run folder.
inline constexpr std::array<std::string_view, 18> run_file_names = {
    "report.json",   "cloth.obj",       "cloth.pc2",     "body.obj",      "body.pc2",       "sewing.obj",
    "sewing.pc2",    "sewing_body.obj", "offenders.obj", "preview.png",   "preview.mp4",    "frames.png",
    "crossings.png", "thumbnail.png",   "close-up.png",  "turntable.mp4", "checkpoint.bin", "unfinished.json"};
// The pictures among them, drawn of a finished run.
inline constexpr std::array<std::string_view, 7> picture_file_names = {
    "preview.png", "preview.mp4", "frames.png", "crossings.png", "thumbnail.png", "close-up.png", "turntable.mp4"};

// The contents of unfinished.json.
struct UnfinishedRun {
  std::vector<std::string> arguments;  // of the command, without the program's name
  std::string working_directory;       // relative paths of `arguments` refer to it
  std::string version;
  std::string process;  // "process 123 on host since 2026-01-31T12:00:00Z: toile run scene.json"
  // The report's member about the caches, once there are any.
  double fps = 0;
  std::optional<Json> rest_stretch;
  int body_vertices = 0, motion_first_frame = -1;
};
// Empty when the folder has no unfinished run.  Throws InputError for a file that is not ours.
std::optional<UnfinishedRun> read_unfinished_run(const std::string& directory);
// A running process writes to the folder.
bool is_written_to(const std::string& directory);

class RunFolder {
 public:
  enum class Use {
    new_run,   // makes the folder, and replaces the files of an earlier run of ours
    resume,    // the folder of an unfinished run
    pictures,  // adds pictures to a run; takes the lock and nothing else
  };
  struct Owner {
    std::string command;  // as typed
    std::vector<std::string> arguments;
    std::string version;
  };
  // Throws IoError when another process writes there, naming it; when a file has a name of ours and no run of ours lists it; when one of
  // `inputs` (files or folders that exist) is the folder or a file of ours in it; when the folder is not writable.
  RunFolder(std::string directory, Use use, const Owner& owner, std::span<const std::string> inputs);
  // Without begin() a new run leaves everything as it was.
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  // For a new run: removes the files of an earlier one, its report first.
  void begin();
  // Call before the first frame; writes the members of unfinished.json that readers of an unfinished run need.
  void set_facts(const std::function<void(JsonText&)>& facts);
  // Call after report.json has been written: the run is finished, or (`goes_on`) can be resumed.
  void finish(bool goes_on);

  // The folder had an unfinished run.
  bool was_unfinished() const { return was_unfinished_; }
  const std::string& directory() const { return directory_; }
  std::string path(std::string_view name) const;

 private:
  void lock();
  void refuse_strangers(std::span<const std::string_view> names) const;
  void refuse_inputs(std::span<const std::string> inputs) const;
  void write_unfinished(const std::function<void(JsonText&)>& facts) const;
  void undo() const;

  std::string directory_, made_;  // made_: the outermost folder that had to be created
  Use use_;
  Owner owner_;
  int lock_ = -1;
  bool begun_ = false, was_unfinished_ = false;
};

// Seals a JSON text against changes: its last member becomes "report_hash", the checksum of all bytes before that value.
std::string sealed(std::string json_object);
// Whether the text is unchanged since it was sealed.
bool is_intact(std::string_view text);

}  // namespace toile::internal
