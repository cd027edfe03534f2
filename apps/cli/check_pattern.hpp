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
  std::string said;        // text for a person; ends with a line feed, or is empty
  std::string error = {};  // the error of `dress`; empty: none
  ExitCode code = ExitCode::ok;
  std::vector<LintFinding> findings = {};  // of a pattern
  std::string mended_file = {};            // written by --repair; empty: none
  bool is_pattern = false;
};

// Writes the files of --svg and --repair.  Members of `json` are only written without errors.
Checked check_pattern(const CommandLine& line, const std::string& path, const std::string& text, JsonText& json);

// "findings": [...], "mended_file": ...
void write_findings(const Checked& checked, JsonText& json);

// Throws Error(usage) where an option needs a single pattern and the files are not.
void refuse_other_files(const CommandLine& line, bool is_pattern, const std::string& path);

}  // namespace toile::internal
