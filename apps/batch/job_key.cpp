#include "job_key.hpp"

#include "commands.hpp"
#include "core/hash.hpp"
#include "sim/report.hpp"
#include "sim/scene_inputs.hpp"
#include "sim/setup.hpp"

#include <span>

namespace toile::internal {

std::string job_key(const Job& job) {
  try {
    const Scene scene = scene_of(job.command).scene;
    Hash key;
    key.add_text(toile_version());
    const std::uint64_t settings = settings_hash(scene);
    key.add(std::span(&settings, 1));
    if (job.command.command != CommandLine::Command::demo)  // whose files are built in
      for (const InputFile& input : checksums_of_inputs(input_paths(scene), ".")) key.add_text(input.checksum);
    return key.hex();
  } catch (const Error&) {
    return {};
  }
}

}  // namespace toile::internal
