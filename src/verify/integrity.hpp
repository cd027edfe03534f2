// verify/integrity.hpp: whether the files of a run are unchanged, by the checksums of its report.
//
// A checksum is not a signature: it detects a disk error, a truncated file or a stray edit, not a forgery.
#pragma once
#include "io/json.hpp"
#include "io/pc2.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

class Integrity {
 public:
  // `text` is that of report.json, `report` the same parsed.  Files of `directory` that are checked whole are read here.
  Integrity(const std::string& directory, std::string_view text, const Json& report);

  // Checks the frame that the reader of cache `name` has just read.
  void check_frame(std::string_view name, int frame, const Pc2Reader& reader);
  // Call before its frames: checks header and number.
  void check_header(std::string_view name, const Pc2Reader& reader);
  // Reads and checks a cache that is not read otherwise.
  void check_cache(const std::string& directory, std::string_view name);

  // One sentence each, for the user.
  const std::vector<std::string>& changes() const { return changes_; }

  // The input files of the run, which are not in its folder.
  struct Inputs {
    int known = 0, missing = 0;        // in the report; no longer at their paths
    std::vector<std::string> changed;  // their paths
  };
  static Inputs check_inputs(const std::string& directory, const Json& report);

 private:
  const Json* entry(std::string_view name) const;

  const Json* files_ = nullptr;
  std::vector<std::string> changes_;
};

}  // namespace toile::internal
