// apps/cli/check_pattern.hpp: `toile check` of a sewing pattern: figures, findings, a drawing, a mended copy.
#pragma once
#include "command_line.hpp"
#include "exit_code.hpp"
#include "garment/lint.hpp"
#include "io/json_text.hpp"

#include <string>
#include <vector>

namespace toile::internal {

struct Checked {
  std::string said;        // for a person; ends with a line feed, or is empty
  std::string error = {};  // what `dress` would refuse it with; empty: nothing
  ExitCode code = ExitCode::ok;
  std::vector<LintFinding> findings = {};  // of a pattern
  std::string mended_file = {};            // that --repair has written; empty: none
  bool is_pattern = false;
};

// Writes what --svg and --repair ask for.  Members of `json` are written where nothing is wrong.
Checked check_pattern(const CommandLine& line, const std::string& path, const std::string& text, JsonText& json);

// "findings": [...], "mended_file": ...
void write_findings(const Checked& checked, JsonText& json);

// Throws Error(usage) where an option needs one pattern and the files are others.
void refuse_other_files(const CommandLine& line, bool is_pattern, const std::string& path);

}  // namespace toile::internal
