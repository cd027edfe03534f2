// garment/lint.cpp: runs the parts of the linter, and mends one thing after the other.
//
// Easily got wrong: a repair may renumber edges and corners.  So only one is made at a time, on a file that is read again, and findings of
// two rounds are identified by code and panel.
#include "garment/lint.hpp"

#include "garment/lint_context.hpp"
#include "garment/pleats.hpp"
#include "io/json_value.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace toile::internal {
namespace {

// A round mends one fault, in time proportional to the number of edges; of a file with more faults those found so far are reported.
constexpr std::size_t most_edge_rounds = 200'000, least_rounds = 5, most_rounds = 200;

// Identifies a problem although the numbers in the file may have changed.
using Kind = std::pair<std::string_view, std::string>;
Kind kind_of(const LintFinding& finding, const Pattern& pattern) {
  return {finding.code, finding.marks.empty() ? std::string() : pattern.panels[at(finding.marks.front().panel)].name};
}

int rank(Severity severity) { return static_cast<int>(severity); }

struct Round {
  std::vector<LintProblem> problems;
  Pattern pattern;
};

Round look(const Json& root, std::string_view file, const std::optional<BodyFigures>& body) {
  LintContext context(root, file, body);
  lint_outlines(context);
  lint_flips(context);
  lint_seams(context);
  lint_size(context);
  lint_openings(context);
  for (std::size_t p = 0; p < context.wild.size(); ++p)
    if (context.wild[p]) {  // there is nothing to draw
      context.reading.pattern.panels[p].corners.clear();
      context.reading.pattern.panels[p].edges.clear();
      context.reading.pattern.panels[p].folds.clear();
    }
  return {std::move(context.problems), std::move(context.reading.pattern)};
}

// Why the file cannot be read at all.
LintFinding finding_of(const InputError& error, std::string_view file) {
  LintFinding finding;
  finding.code = reason::unreadable;
  finding.repair = "refused: what is meant cannot be known";
  finding.where = error.where().empty() ? std::string(file) : error.where();
  finding.place = error.place().empty() ? "file" : error.place();
  if (error.place().starts_with('/')) finding.pointer = error.place();
  finding.expected = error.expected();
  finding.got = error.got();
  return finding;
}

}  // namespace

std::string fixed_text(double value, int digits) {
  char buffer[64];
  const auto end =
      std::to_chars(buffer, buffer + sizeof buffer, value == 0 ? 0.0 : value, std::chars_format::fixed, digits).ptr;
  std::string text(buffer, end);
  return text.find_first_not_of("-0.") == std::string::npos && text[0] == '-' ? text.substr(1) : text;
}

std::string cm_text(double length_m) { return fixed_text(100 * length_m, 1) + " cm"; }
std::string point_cm(const Vec2& p) {
  return "(" + fixed_text(100 * p.x(), 1) + ", " + fixed_text(100 * p.y(), 1) + ") cm";
}

std::string_view to_string(Severity severity) {
  return severity == Severity::error ? "error" : severity == Severity::warning ? "warning" : "note";
}

bool LintReport::has_errors() const {
  return std::any_of(findings.begin(), findings.end(), [](const auto& f) { return f.severity == Severity::error; });
}

LintContext::LintContext(const Json& file_root, std::string_view file, const std::optional<BodyFigures>& figures)
    : root(file_root), reading(read_pattern_leniently(file_root, file)), pattern(reading.pattern), body(figures) {
  const std::size_t panels = pattern.panels.size();
  for (const PanelSource& source : reading.sources) closed.push_back(source.is_loop);
  wild.assign(panels, 0);
  sound = closed;
  fitted.assign(pattern.stitches.size(), 1);
  for (PatternFault& fault : find_faults(pattern)) {
    const bool numbers = fault.code == reason::beyond_limits;
    if (fault.panel >= 0 && numbers) wild[at(fault.panel)] = 1;
    // Loops are checked more closely elsewhere.
    if (fault.panel >= 0 && !numbers && !reading.sources[at(fault.panel)].is_loop) continue;
    if (fault.panel >= 0) sound[at(fault.panel)] = 0;
    if (fault.part == PatternFault::Part::stitch) fitted[at(fault.index)] = 0;
    faults.push_back(std::move(fault));
  }
  for (std::size_t p = 0; p < panels; ++p)
    if (wild[p]) closed[p] = 0;
  length_m.resize(panels);
  for (std::size_t p = 0; p < panels; ++p) {
    if (!closed[p]) continue;
    for (const PanelEdge& edge : pattern.panels[p].edges) length_m[p].push_back(edge_length_m(pattern.panels[p], edge));
  }
  const bool joined = std::none_of(faults.begin(), faults.end(), [](const PatternFault& fault) {
    return fault.code == reason::seam_missing || fault.code == reason::seam_twice ||
           fault.code == reason::seam_to_itself || fault.code == reason::beyond_limits;
  });
  if (joined && std::all_of(closed.begin(), closed.end(), [](char c) { return c != 0; }))
    boundary = find_boundary(resolve_pleats(pattern).pattern);
  inner_layer.assign(pattern.stitches.size(), 0);
  if (boundary)
    for (const Pleat& pleat : pleats_of(pattern)) inner_layer[pleat.under] = inner_layer[pleat.inner] = 1;
  for (std::size_t s = 0; s < pattern.stitches.size(); ++s) {
    if (inner_layer[s]) fitted[s] = 0;
    for (const StitchSide& side : {pattern.stitches[s].a, pattern.stitches[s].b}) {
      if (side.edge >= 0) sewn.insert({side.panel, side.edge});
      if (side.edge < 0 || !sound[at(side.panel)]) fitted[s] = 0;
    }
  }
}

LintProblem& LintContext::add(std::string_view code, Severity severity, const Json& json, std::string place,
                              std::string expected, std::string got) {
  LintProblem problem;
  problem.finding.code = code;
  problem.finding.severity = severity;
  problem.finding.where = json.where();
  problem.finding.pointer = json.pointer();
  problem.finding.place = std::move(place);
  problem.finding.expected = std::move(expected);
  problem.finding.got = std::move(got);
  problem.finding.repair = "refused: what is meant cannot be known";
  problems.push_back(std::move(problem));
  return problems.back();
}

LintProblem& LintContext::add(const PatternFault& fault, Severity severity) {
  std::string place = place_of(pattern, fault);
  std::vector<LintMark> marks;
  using Part = PatternFault::Part;
  if (fault.part == Part::stitch) {
    const Stitch& stitch = pattern.stitches[at(fault.index)];
    for (const StitchSide& side : {stitch.a, stitch.b})
      if (side.edge >= 0) marks.push_back(mark_edge(side.panel, side.edge));
  } else if (fault.part == Part::edge) {
    marks.push_back(mark_edge(fault.panel, fault.index));
    if (fault.other >= 0 && fault.other != fault.index) marks.push_back(mark_edge(fault.panel, fault.other));
    if (fault.code == reason::outline_crosses) marks.front().at_m = fault.place_m;
  } else if (fault.part == Part::corner) {
    const bool there = !wild[at(fault.panel)];
    marks.push_back(
        {fault.panel, -1, there ? pattern.panels[at(fault.panel)].corners[at(fault.index)] : Vec2(0, 0), !there});
  } else if (fault.part == Part::panel) {
    marks.push_back(mark_panel(fault.panel));
  }
  if (!marks.empty() && fault.part != Part::panel) place += ", at " + point_cm(marks.front().at_m);
  LintProblem& problem =
      add(fault.code, severity, json_of_fault(fault, root, pattern, reading.sources, *reading.stitches),
          std::move(place), fault.expected, fault.got);
  problem.finding.marks = std::move(marks);
  return problem;
}

std::string LintContext::edge_name(const StitchSide& side) const {
  const Panel& panel = pattern.panels[at(side.panel)];
  return "edge " + std::to_string(panel.file_number(side.edge)) + " of panel \"" + printable(panel.name) + "\"";
}

LintMark LintContext::mark_edge(Index p, Index e) const {
  const Panel& panel = pattern.panels[at(p)];
  const PanelEdge& edge = panel.edges[at(e)];
  LintMark mark{p, panel.file_number(e), Vec2::Zero()};
  if (wild[at(p)]) return {p, -1, Vec2::Zero(), true};
  if (edge.start < 0 || edge.end < 0) {
    const Index known = std::max(edge.start, edge.end);
    if (known >= 0) mark.at_m = panel.corners[at(known)];
    mark.edge = -1;
  } else if (edge.start == edge.end) {
    mark.at_m = panel.corners[at(edge.start)];
    mark.edge = -1;
  } else {
    mark.at_m = sample_edge(panel, edge, 2)[1];
  }
  return mark;
}

LintMark LintContext::mark_panel(Index p) const {
  const Panel& panel = pattern.panels[at(p)];
  if (panel.corners.empty() || wild[at(p)]) return {p, -1, Vec2::Zero(), true};
  Vec2 low = panel.corners.front(), high = low;
  for (const Vec2& c : panel.corners) {
    low = low.cwiseMin(c);
    high = high.cwiseMax(c);
  }
  return {p, -1, 0.5 * (low + high), true};
}

double LintContext::edge_m(const StitchSide& side) const {
  const std::vector<double>& lengths = length_m[at(side.panel)];
  return lengths.empty() ? 0 : lengths[at(side.edge)];
}

namespace {

// Mends one fault after the other, each on the file as it is then.
class Mending {
 public:
  Mending(std::string_view text, std::string_view file, const std::optional<BodyFigures>& body)
      : current_(text), file_(file), body_(body) {}

  LintReport run() {
    std::size_t rounds = most_rounds;
    for (std::size_t number = 0; number < rounds; ++number) {
      Round round;
      std::optional<Json> root;
      try {
        root = Json::parse(current_, file_);
        round = look(*root, file_, body_);
      } catch (const InputError& error) {
        report_.findings.push_back(finding_of(error, file_));
        return std::move(report_);
      }
      if (number == 0) {
        report_.drawing = round.pattern;
        std::size_t edges = 1;
        for (const Panel& panel : round.pattern.panels) edges += panel.edges.size();
        rounds = std::clamp(most_edge_rounds / edges, least_rounds, most_rounds);
      }
      std::stable_sort(round.problems.begin(), round.problems.end(), [](const LintProblem& a, const LintProblem& b) {
        return rank(a.finding.severity) < rank(b.finding.severity);
      });
      left_.clear();
      for (const LintProblem& problem : round.problems) ++left_[kind_of(problem.finding, round.pattern)];
      if (undo_in_vain()) continue;
      tell(round, number == 0);
      report_.usable = std::none_of(round.problems.begin(), round.problems.end(),
                                    [](const auto& p) { return p.finding.severity == Severity::error; });
      // Errors first: warnings may look different after them.
      const auto next = std::find_if(round.problems.begin(), round.problems.end(), [&](const LintProblem& problem) {
        return problem.mend && !in_vain_.contains({kind_of(problem.finding, round.pattern), problem.finding.repair});
      });
      if (next == round.problems.end()) return finish(false);
      mend(*next, *root, kind_of(next->finding, round.pattern));
    }
    return finish(true);
  }

 private:
  struct Attempt {
    Kind kind;
    std::string repair, before;
    int count;         // of its kind, before the repair
    std::size_t told;  // index in the report
  };

  // If the last repair did not reduce the faults of its kind, it is undone and not tried again.
  bool undo_in_vain() {
    if (!attempt_) return false;
    const Attempt attempt = *std::exchange(attempt_, std::nullopt);
    if (left_[attempt.kind] < attempt.count) return false;
    in_vain_.insert({attempt.kind, attempt.repair});
    current_ = attempt.before;
    ++known_[attempt.kind];
    --mended_;
    if (attempt.told < report_.findings.size()) {
      report_.findings[attempt.told].mended = false;
      report_.findings[attempt.told].repair = "refused: tried, but then it is wrong in another way";
    }
    return true;
  }

  // Reports the problems that are not in the report yet.
  void tell(const Round& round, bool first) {
    std::map<Kind, int> seen;
    for (const LintProblem& problem : round.problems) {
      const Kind kind = kind_of(problem.finding, round.pattern);
      if (++seen[kind] <= known_[kind]) continue;
      ++known_[kind];
      LintFinding finding = problem.finding;
      if (!first) {  // the numbers in the file may have moved
        finding.where = file_;
        for (LintMark& mark : finding.marks) mark.edge = -1;
      }
      report_.findings.push_back(std::move(finding));
    }
  }

  void mend(const LintProblem& problem, const Json& root, const Kind& kind) {
    JsonValue changed(root);
    const PatternReading reading = read_pattern_leniently(root, file_);
    PatternRepair repair(changed, reading.absolute_curves, reading.centred_panels);
    problem.mend(repair);
    const auto told = std::find_if(report_.findings.begin(), report_.findings.end(), [&](const LintFinding& finding) {
      return !finding.mended && finding.repair == problem.finding.repair && kind_of(finding, report_.drawing) == kind;
    });
    if (told != report_.findings.end()) told->mended = true;
    attempt_ = {kind, problem.finding.repair, std::exchange(current_, to_text(changed)), left_[kind],
                static_cast<std::size_t>(told - report_.findings.begin())};
    --known_[kind];
    ++mended_;
  }

  LintReport finish(bool all_rounds) {
    for (LintFinding& finding : report_.findings) {
      if (finding.mended || finding.repair.starts_with("refused")) continue;
      finding.mended = left_[kind_of(finding, report_.drawing)]-- <= 0;  // another repair was enough
      if (!finding.mended)
        finding.repair = all_rounds ? "refused: too many faults at once; mend the mended file again"
                                    : "refused: other faults are in the way";
    }
    if (mended_ > 0) report_.mended_text = current_;
    return std::move(report_);
  }

  std::string current_;
  const std::string file_;
  const std::optional<BodyFigures>& body_;
  LintReport report_;
  std::map<Kind, int> known_;  // the number of each kind in the report that is not mended
  std::map<Kind, int> left_;   // the number of each kind in the last round
  std::set<std::pair<Kind, std::string>> in_vain_;
  std::optional<Attempt> attempt_;
  int mended_ = 0;
};

}  // namespace

LintReport lint_pattern(std::string_view text, std::string_view file, const std::optional<BodyFigures>& body) {
  return Mending(text, file, body).run();
}

}  // namespace toile::internal
