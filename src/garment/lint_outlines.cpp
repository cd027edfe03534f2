// garment/lint_outlines.cpp: do the edges of each panel form one closed outline that does not cross itself?
//
// Edges of a file are lines between corners, and a loop passes every corner once, in one direction.  Where it does not, the corners show it:
// undirected, an outline has two edges at each; one where it is open, three or more where extra edges branch off.
#include "garment/lint_context.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::internal {
namespace {

// Ends of an outline this near were meant to be one corner: 2 mm is a pencil line and a rounded file; 1 % of the outline is the error
// of digitising by hand on a large panel.  But never half of the shorter edge that ends there.
constexpr double gap_m = 0.002, gap_of_outline = 0.01, gap_of_edge = 0.5;
// A choice is taken when it makes the seams fit this much better than the next best one.
constexpr double clearly_dearer = 1.2;

class OutlineLint {
 public:
  OutlineLint(LintContext& context, Index index)
      : context_(context),
        index_(index),
        panel_(context.pattern.panels[at(index)]),
        source_(context.reading.sources[at(index)]),
        edges_(panel_.edges.size()) {
    for (std::size_t place = 0; place < panel_.edges.size(); ++place)
      edges_[at(panel_.file_number(static_cast<Index>(place)))] = panel_.edges[place];
  }

  void run() {
    if (!source_.is_loop && !context_.wild[at(index_)]) {
      if (check_ends() && check_repeated()) check_graph();
      return;
    }
    if (!context_.wild[at(index_)]) check_order();
    for (const PatternFault& fault : context_.faults)
      if (fault.panel == index_) explain(fault);
  }

 private:
  const Json& json_of_edge(Index number) const { return source_.panel->at("edges").array()[at(number)]; }
  bool is_sewn(Index number) const { return context_.sewn.contains({index_, source_.place_of_edge[at(number)]}); }
  std::string name_of(Index number) const {
    return "panel \"" + printable(panel_.name) + "\", edge " + std::to_string(number);
  }
  LintMark mark(Index number) const { return context_.mark_edge(index_, source_.place_of_edge[at(number)]); }

  LintProblem& add_at_edge(std::string_view code, Severity severity, Index number, std::string expected,
                           std::string got) {
    const LintMark where = mark(number);
    LintProblem& problem =
        context_.add(code, severity, json_of_edge(number), name_of(number) + ", at " + point_cm(where.at_m),
                     std::move(expected), std::move(got));
    problem.finding.marks = {where};
    return problem;
  }

  // ---- a panel that is no loop --------------------------------------------------------------------------------------

  // Edges that name a missing corner, or one corner twice.
  bool check_ends() {
    bool good = true;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const auto number = static_cast<Index>(e);
      const PanelEdge& edge = edges_[e];
      if (edge.start >= 0 && edge.end >= 0 && edge.start != edge.end) continue;
      good = false;
      const std::string last = std::to_string(static_cast<long long>(panel_.corners.size()) - 1);
      LintProblem& problem =
          add_at_edge(reason::edge_ends, Severity::error, number, "two different corners, 0 to " + last,
                      edge.start == edge.end && edge.start >= 0 ? "corner " + std::to_string(edge.start) + " twice"
                                                                : "a corner that is not there");
      if (edge.start == edge.end && edge.start >= 0) {
        if (is_sewn(number)) {
          problem.finding.repair = "refused: the edge has no length, but is sewn";
          continue;
        }
        problem.finding.repair = "the edge is taken out: it has no length and nothing is sewn to it";
        problem.mend = [panel = panel_.name, number](PatternRepair& repair) { repair.remove_edge(panel, number); };
        continue;
      }
      const Index end = only_open_corner(number);
      if (end < 0) {
        problem.finding.repair = "refused: more than one corner could be meant";
        continue;
      }
      problem.finding.repair = "ends at corner " + std::to_string(end) + ", where alone the outline is open";
      const Index start = edge.start >= 0 ? edge.start : end, finish = edge.start >= 0 ? end : edge.end;
      problem.mend = [panel = panel_.name, number, start, finish](PatternRepair& repair) {
        repair.set_ends(panel, number, start, finish);
      };
    }
    return good;
  }

  // The corner that an edge with one unknown end must lead to; -1: not known.
  Index only_open_corner(Index number) const {
    const PanelEdge& edge = edges_[at(number)];
    const Index known = std::max(edge.start, edge.end);
    if (known < 0) return -1;
    std::vector<int> uses(panel_.corners.size(), 0);
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (static_cast<Index>(e) == number) continue;
      if (edges_[e].start < 0 || edges_[e].end < 0) return -1;
      ++uses[at(edges_[e].start)];
      ++uses[at(edges_[e].end)];
    }
    Index found = -1;
    for (std::size_t c = 0; c < uses.size(); ++c) {
      if (uses[c] >= 2 || static_cast<Index>(c) == known) continue;
      if (found >= 0) return -1;
      found = static_cast<Index>(c);
    }
    return found;
  }

  // The same edge twice.
  bool check_repeated() {
    for (std::size_t later = 1; later < edges_.size(); ++later) {
      for (std::size_t earlier = 0; earlier < later; ++earlier) {
        const PanelEdge &a = edges_[earlier], &b = edges_[later];
        const bool same = a.start == b.start && a.end == b.end, back = a.start == b.end && a.end == b.start;
        const bool lines = a.kind == CurveKind::line && b.kind == CurveKind::line;
        if (!(same && a.kind == b.kind) && !((same || back) && lines)) continue;
        if (same && !lines && sample_edge(panel_, a, 2)[1] != sample_edge(panel_, b, 2)[1]) continue;
        const auto first = static_cast<Index>(earlier), second = static_cast<Index>(later);
        LintProblem& problem =
            add_at_edge(reason::edge_twice, Severity::error, second, "each edge once",
                        "edge " + std::to_string(second) + " between the corners of edge " + std::to_string(first));
        const Index gone = is_sewn(second) ? first : second;
        if (is_sewn(first) && is_sewn(second)) {
          problem.finding.repair = "refused: both are sewn";
          return false;
        }
        problem.finding.repair =
            "edge " + std::to_string(gone) + " is taken out" + (gone == first ? ": the other one is sewn" : "");
        problem.mend = [panel = panel_.name, gone](PatternRepair& repair) { repair.remove_edge(panel, gone); };
        return false;
      }
    }
    return true;
  }

  void check_graph() {
    std::vector<std::vector<Index>> at_corner(panel_.corners.size());
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      at_corner[at(edges_[e].start)].push_back(static_cast<Index>(e));
      at_corner[at(edges_[e].end)].push_back(static_cast<Index>(e));
    }
    if (edges_.empty()) {
      LintProblem& problem = context_.add(reason::loop_open, Severity::error, source_.panel->at("edges"),
                                          "panel \"" + printable(panel_.name) + "\"",
                                          "at least 3 edges, or 2 of which one is curved", "0");
      problem.finding.marks = {context_.mark_panel(index_)};
      problem.finding.repair = "refused: there is no outline";
      return;
    }
    std::vector<Index> ends;
    for (std::size_t c = 0; c < at_corner.size(); ++c) {
      if (at_corner[c].size() > 2) {
        LintProblem& problem = add_at_edge(
            reason::loop_several, Severity::error, at_corner[c][2], "an outline that passes each corner once",
            std::to_string(at_corner[c].size()) + " edges at corner " + std::to_string(c));
        problem.finding.marks = {{index_, -1, panel_.corners[c]}};
        return;
      }
      if (at_corner[c].size() == 1) ends.push_back(static_cast<Index>(c));
    }
    if (!ends.empty()) return check_gaps(ends, at_corner);
    follow(at_corner);
  }

  // ---- open ---------------------------------------------------------------------------------------------------------

  void check_gaps(std::vector<Index> ends, const std::vector<std::vector<Index>>& at_corner) {
    double outline_m = 0;
    for (const PanelEdge& edge : edges_) outline_m += edge_length_m(panel_, edge);
    const auto gap = [&](Index a, Index b) { return (panel_.corners[at(a)] - panel_.corners[at(b)]).norm(); };
    while (ends.size() >= 2) {
      std::size_t first = 0, second = 1;
      for (std::size_t i = 0; i < ends.size(); ++i)
        for (std::size_t j = i + 1; j < ends.size(); ++j)
          if (gap(ends[i], ends[j]) < gap(ends[first], ends[second])) first = i, second = j;
      const Index kept = ends[first], merged = ends[second];
      const double open_m = gap(kept, merged);
      double shortest_m = std::numeric_limits<double>::infinity();
      for (const Index c : {kept, merged})
        shortest_m = std::min(shortest_m, edge_length_m(panel_, edges_[at(at_corner[at(c)].front())]));
      const Index edge = at_corner[at(merged)].front();
      LintProblem& problem = add_at_edge(reason::loop_open, Severity::error, edge, "a closed outline",
                                         "a gap of " + cm_text(open_m) + " between corner " + std::to_string(kept) +
                                             " and corner " + std::to_string(merged));
      problem.finding.marks.front().at_m = panel_.corners[at(merged)];
      problem.finding.place = name_of(edge) + ", at " + point_cm(panel_.corners[at(merged)]);
      const bool near = open_m <= std::max(gap_m, gap_of_outline * outline_m) && open_m <= gap_of_edge * shortest_m;
      if (near && at_corner[at(merged)].front() != at_corner[at(kept)].front()) {
        problem.finding.repair = "corner " + std::to_string(merged) + " is put on corner " + std::to_string(kept);
        problem.mend = [panel = panel_.name, merged, kept](PatternRepair& repair) {
          repair.merge_corner(panel, merged, kept);
        };
      } else {
        problem.finding.repair = "refused: the gap is too large to be an error of drawing; an edge may be missing";
      }
      ends.erase(ends.begin() + static_cast<std::ptrdiff_t>(second));
      ends.erase(ends.begin() + static_cast<std::ptrdiff_t>(first));
    }
  }

  // ---- closed, but not one way round ----------------------------------------------------------------------------------

  void follow(const std::vector<std::vector<Index>>& at_corner) {
    std::vector<int> way(edges_.size(), 0);  // 1: along, -1: against the walk
    Index edge = 0, corner = edges_.front().start;
    std::size_t passed = 0;
    while (way[at(edge)] == 0) {
      const PanelEdge& here = edges_[at(edge)];
      way[at(edge)] = here.start == corner ? 1 : -1;
      ++passed;
      corner = here.start == corner ? here.end : here.start;
      const std::vector<Index>& both = at_corner[at(corner)];
      edge = both[0] == edge ? both[1] : both[0];
    }
    if (passed < edges_.size()) {
      const auto left = static_cast<Index>(std::find(way.begin(), way.end(), 0) - way.begin());
      LintProblem& problem = add_at_edge(reason::loop_several, Severity::error, left, "one closed outline",
                                         "edge " + std::to_string(left) + " outside of the loop of edge 0");
      problem.finding.repair = "refused: a panel has one outline, and no holes";
      return;
    }
    const auto along = std::count(way.begin(), way.end(), 1), against = std::count(way.begin(), way.end(), -1);
    int right_way = along > against ? 1 : -1;
    bool known = along != against;
    if (!known) {  // the seams determine the direction
      const double cost = twist_cost(way, 1), other = twist_cost(way, -1);
      known = std::max(cost, other) > clearly_dearer * std::min(cost, other);
      right_way = cost < other ? 1 : -1;
    }
    std::vector<Index> reversed;
    for (std::size_t e = 0; e < way.size(); ++e)
      if (way[e] != right_way) reversed.push_back(static_cast<Index>(e));
    std::string list;
    for (const Index e : reversed) list += (list.empty() ? "" : ", ") + std::to_string(e);
    LintProblem& problem =
        add_at_edge(reason::loop_reversed, Severity::error, reversed.front(), "edges that all run the same way round",
                    reversed.size() == 1 ? "edge " + list + " running against the others"
                                         : "edges " + list + " running against the others");
    problem.finding.marks.clear();
    for (const Index e : reversed) problem.finding.marks.push_back(mark(e));
    if (!known) {
      problem.finding.repair = "refused: as many edges run the one way round as the other";
      return;
    }
    problem.finding.repair = "turned round, each with its curve";
    problem.mend = [panel = panel_.name, reversed](PatternRepair& repair) {
      for (const Index e : reversed) repair.reverse_edge(panel, e);
    };
  }

  // How far apart the ends of the panel's seams lie when the outline runs the given way.
  double twist_cost(const std::vector<int>& way, int right_way) const {
    double cost = 0;
    for (const Stitch& stitch : context_.pattern.stitches) {
      for (int side = 0; side < 2; ++side) {
        const StitchSide &mine = side == 0 ? stitch.a : stitch.b, &theirs = side == 0 ? stitch.b : stitch.a;
        if (mine.panel != index_ || mine.edge < 0 || theirs.edge < 0 || theirs.panel == index_ ||
            !context_.closed[at(theirs.panel)])
          continue;
        const Panel& other = context_.pattern.panels[at(theirs.panel)];
        PanelEdge edge = panel_.edges[at(mine.edge)];
        if (way[at(mine.edge)] != right_way) std::swap(edge.start, edge.end);
        const PanelEdge& partner = other.edges[at(theirs.edge)];
        const Vec3 a0 = panel_.place(panel_.corners[at(edge.start)]), a1 = panel_.place(panel_.corners[at(edge.end)]);
        const Vec3 b0 = other.place(other.corners[at(stitch.right_wrong ? partner.start : partner.end)]);
        const Vec3 b1 = other.place(other.corners[at(stitch.right_wrong ? partner.end : partner.start)]);
        cost += (a0 - b0).norm() + (a1 - b1).norm();
      }
    }
    return cost;
  }

  // ---- a loop ---------------------------------------------------------------------------------------------------------

  void check_order() {
    const auto moved = std::find_if(panel_.edges.begin(), panel_.edges.end(), [&](const PanelEdge& edge) {
      return edge.file_number != static_cast<Index>(&edge - panel_.edges.data());
    });
    if (moved == panel_.edges.end()) return;
    std::vector<Index> order;
    for (const PanelEdge& edge : panel_.edges) order.push_back(edge.file_number);
    LintProblem& problem = add_at_edge(
        reason::loop_order, Severity::note, moved->file_number, "edges in the order in which they follow each other",
        "edge " + std::to_string(moved->file_number) + " after edge " + std::to_string((moved - 1)->file_number));
    problem.finding.repair = "put in order; stitches name them by their new numbers";
    problem.mend = [panel = panel_.name, order](PatternRepair& repair) { repair.reorder_edges(panel, order); };
  }

  void explain(const PatternFault& fault) {
    if (fault.code == reason::unit_doubtful) return;  // of all panels together
    LintProblem& problem = context_.add(fault, Severity::error);
    if (fault.code == reason::corner_unused) {
      problem.finding.repair = "the corner is taken out";
      problem.mend = [panel = panel_.name, corner = fault.index](PatternRepair& repair) {
        repair.remove_corner(panel, corner);
      };
    } else if (fault.code == reason::corner_twice) {
      mend_repeated(fault, problem);
    } else if (fault.code == reason::outline_crosses && fault.other >= 0) {
      mend_crossing(fault, problem);
    }
  }

  void mend_repeated(const PatternFault& fault, LintProblem& problem) {
    for (const PanelEdge& edge : panel_.edges) {
      if (std::minmax(edge.start, edge.end) != std::minmax(fault.index, fault.other)) continue;
      if (edge.kind != CurveKind::line || is_sewn(edge.file_number)) {
        problem.finding.repair = "refused: the edge between the two is sewn or curved";
        return;
      }
      problem.finding.repair =
          "edge " + std::to_string(edge.file_number) + " and corner " + std::to_string(fault.index) + " are taken out";
      problem.mend = [panel = panel_.name, number = edge.file_number, gone = fault.index,
                      kept = fault.other](PatternRepair& repair) {
        repair.remove_edge(panel, number);
        repair.merge_corner(panel, gone, kept);
      };
      return;
    }
    problem.finding.repair = "refused: the outline touches itself there";
  }

  // An outline may cross itself because two corners have changed places.  Of the pairs among the four corners, the one is taken
  // that gives a sound panel whose seams are clearly the best.
  void mend_crossing(const PatternFault& fault, LintProblem& problem) {
    problem.finding.repair = "refused: no two corners whose exchange clearly mends it";
    if (fault.index == fault.other) return;
    const PanelEdge &a = panel_.edges[at(fault.index)], &b = panel_.edges[at(fault.other)];
    std::vector<Index> corners{a.start, a.end, b.start, b.end};
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    double best = std::numeric_limits<double>::infinity(), next = best;
    std::pair<Index, Index> swapped{-1, -1};
    for (std::size_t i = 0; i < corners.size(); ++i) {
      for (std::size_t j = i + 1; j < corners.size(); ++j) {
        Pattern tried = context_.pattern;
        Panel& panel = tried.panels[at(index_)];
        std::swap(panel.corners[at(corners[i])], panel.corners[at(corners[j])]);
        if (std::any_of(panel.edges.begin(), panel.edges.end(),
                        [](const auto& e) { return e.kind != CurveKind::line; }))
          move_curves(panel);
        Pattern alone;
        alone.panels = {panel};
        if (!find_faults(alone).empty()) continue;
        const double cost = seam_cost(tried);
        if (cost < best) {
          next = best;
          best = cost;
          swapped = {corners[i], corners[j]};
        } else {
          next = std::min(next, cost);
        }
      }
    }
    if (swapped.first < 0 || !(next > clearly_dearer * best)) return;
    problem.finding.repair =
        "corners " + std::to_string(swapped.first) + " and " + std::to_string(swapped.second) + " change places";
    problem.mend = [panel = panel_.name, swapped](PatternRepair& repair) {
      repair.swap_corners(panel, swapped.first, swapped.second);
    };
  }

  // Control points given relative to their edge go with it.
  void move_curves(Panel& panel) const {
    if (context_.reading.absolute_curves) return;
    for (PanelEdge& edge : panel.edges) {
      const Vec2 from = panel_.corners[at(edge.start)], along = panel_.corners[at(edge.end)] - from;
      const Vec2 new_from = panel.corners[at(edge.start)], new_along = panel.corners[at(edge.end)] - new_from;
      for (Vec2& control : edge.control) {
        const Vec2 d = control - from;
        const double length2 = along.squaredNorm();
        const double u = d.dot(along) / length2, v = (along.x() * d.y() - along.y() * d.x()) / length2;
        control = new_from + u * new_along + v * Vec2(-new_along.y(), new_along.x());
      }
    }
  }

  // The misfit of the panel's seams, in length and in distance of their ends; infinite without seams.
  double seam_cost(const Pattern& pattern) const {
    double cost = 0;
    bool any = false;
    for (std::size_t s = 0; s < pattern.stitches.size(); ++s) {
      const Stitch& stitch = pattern.stitches[s];
      if (stitch.a.panel != index_ && stitch.b.panel != index_) continue;
      if (stitch.a.edge < 0 || stitch.b.edge < 0 || !context_.closed[at(stitch.a.panel)] ||
          !context_.closed[at(stitch.b.panel)])
        continue;
      const Panel &pa = pattern.panels[at(stitch.a.panel)], &pb = pattern.panels[at(stitch.b.panel)];
      const PanelEdge &ea = pa.edges[at(stitch.a.edge)], &eb = pb.edges[at(stitch.b.edge)];
      cost += 10 * std::abs(edge_length_m(pa, ea) - edge_length_m(pb, eb));  // lengths are more reliable than places
      const auto corner = [](const Panel& panel, Index c) { return panel.place(panel.corners[at(c)]); };
      cost += (corner(pa, ea.start) - corner(pb, stitch.right_wrong ? eb.start : eb.end)).norm() +
              (corner(pa, ea.end) - corner(pb, stitch.right_wrong ? eb.end : eb.start)).norm();
      any = true;
    }
    return any ? cost : std::numeric_limits<double>::infinity();
  }

  LintContext& context_;
  const Index index_;
  const Panel& panel_;
  const PanelSource& source_;
  std::vector<PanelEdge> edges_;  // by their numbers in the file
};

}  // namespace

void lint_outlines(LintContext& context) {
  for (const PatternFault& fault : context.faults)
    if (fault.part == PatternFault::Part::pattern) context.add(fault, Severity::error);
  for (std::size_t p = 0; p < context.pattern.panels.size(); ++p) OutlineLint(context, static_cast<Index>(p)).run();
}

}  // namespace toile::internal
