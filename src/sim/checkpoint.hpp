// sim/checkpoint.hpp: the whole state of a run in one file, replaced at intervals: checkpoint.bin.      docs/howto/resume.md
//
//   "TOILESTATE"  uint32 format  uint64 input hash  uint64 bytes  state ...  uint64 checksum of all before      little-endian
//
// The state is that between two frames (core/state_archive.hpp).  The file is replaced atomically, once the frames that it counts are on the disk: a
// run that is killed at any moment leaves a complete one, at most a second and a frame old.
//
// Easily got wrong: the clock decides when a state is saved, never its contents: a run that is resumed anywhere ends with the same bits.
#pragma once
#include "sim/run_writer.hpp"

#include <cstdint>
#include <future>
#include <optional>
#include <string>

namespace toile::internal {

struct CheckpointOptions {
  double every_s = 1;    // of wall time
  int every_frames = 0;  // replaces every_s when above zero
};

class Checkpoints {
 public:
  // The writer must outlive this object.
  Checkpoints(const RunWriter& writer, std::uint64_t input_hash, const CheckpointOptions& options);
  ~Checkpoints();
  Checkpoints(const Checkpoints&) = delete;
  Checkpoints& operator=(const Checkpoints&) = delete;

  // Call once after every frame.
  bool due();
  // Writes the state while the run goes on.  Throws the IoError of the previous call.
  void save(std::string state);
  // Waits until the saved state is on the disk; call before the writer begins or ends a file.  Throws IoError.
  void wait();

 private:
  const RunWriter* writer_;
  std::uint64_t input_hash_;
  CheckpointOptions options_;
  double last_s_ = 0;
  int frames_ = 0;  // since the last save
  std::future<void> pending_;
};

// The state in the folder; empty when there is none.  Throws InputError when it is incomplete, of another version, or of other inputs.
std::optional<std::string> read_checkpoint(const std::string& path, std::uint64_t input_hash);

}  // namespace toile::internal
