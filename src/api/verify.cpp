#include "toile/verify.hpp"

#include "api/parts.hpp"
#include "api/verdict.hpp"
#include "garment/lint.hpp"
#include "io/file.hpp"
#include "io/json.hpp"

#include <fmt/printf.h>

namespace toile {
namespace {

std::vector<Reason> reasons_of(const std::vector<internal::Reason>& from) {
  std::vector<Reason> to;
  for (const internal::Reason& reason : from) to.push_back({reason.code, reason.detail});
  return to;
}

}  // namespace

Verdict verdict_of(const internal::VerifyReport& audit, const internal::Verdict& judged) {
  Verdict verdict;
  verdict.pass = judged.pass;
  verdict.reasons = reasons_of(judged.reasons);
  verdict.qualifications = reasons_of(judged.qualifications);
  verdict.frames = audit.frames;
  verdict.last = {audit.cloth_body_edges.last, audit.cloth_cloth_edges.last};
  verdict.most = {audit.cloth_body_edges.max, audit.cloth_cloth_edges.max};
  verdict.stretch_p99 = audit.stretch.gauge_p99;
  verdict.stretch_max = audit.stretch.gauge_max;
  verdict.still_mm_per_s_p99 = audit.still_mm_per_s_p99;
  return verdict;
}

Verdict verify(const std::string& folder) {
  return translated([&] {
    const internal::VerifyReport audit = internal::verify_directory(folder);
    internal::Limits limits;
    limits.must_be_still = audit.must_be_still;
    return verdict_of(audit, internal::judge(audit, limits));
  });
}

std::string Verdict::explain() const {
  std::string text = pass ? "pass" : "fail";
  for (const Reason& reason : reasons) text += '\n' + reason.code + ": " + reason.detail;
  for (const Reason& reason : qualifications) text += "\nwith the reservation " + reason.code + ": " + reason.detail;
  text += fmt::sprintf(
      "\n%d frames; in the last %d edges between cloth and body and %d of the cloth with itself cross; stretch p99 "
      "%.2f "
      "%%, max %.2f %%",
      frames, last.cloth_body_edges, last.cloth_cloth_edges, 100 * stretch_p99, 100 * stretch_max);
  return text;
}

CheckReport check_pattern(const std::string& path) {
  return translated([&] {
    const internal::LintReport lint =
        internal::lint_pattern(internal::read_file(path, internal::Json::text_limit), internal::printable(path));
    CheckReport report;
    report.usable = lint.usable;
    report.mended_text = lint.mended_text;
    for (const internal::LintFinding& found : lint.findings)
      report.findings.push_back({std::string(found.code), std::string(internal::to_string(found.severity)), found.where,
                                 found.place, found.expected, found.got, found.repair, found.mended});
    return report;
  });
}

std::string CheckReport::explain() const {
  std::string text = usable ? "usable" : "not usable";
  for (const Finding& found : findings)
    text += '\n' + found.where + ": " + found.severity + ": " + found.code + ": " + found.place + ": expected " +
            found.expected + ", got " + found.got;
  return text;
}

}  // namespace toile
