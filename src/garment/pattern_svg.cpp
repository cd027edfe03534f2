// garment/pattern_svg.cpp: see the header.
//
// Easily got wrong: SVG has y down.  A point (x, y) is drawn at (x, -y), and an arc that turns counter-clockwise with y up has
// the sweep flag 0 there.
#include "garment/pattern_svg.hpp"

#include "core/error.hpp"
#include "garment/pattern_check.hpp"
#include "garment/svg_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace toile::internal {
namespace {

constexpr std::string_view mark_colour = "#d00000", note_colour = "#3060c0", line_colour = "#303030",
                           text_colour = "#606060";
constexpr double usual_cm = 70;  // a panel's height for which texts are made; of larger ones they grow with it

// Colours that differ from one seam to the next, and from the red of marks: golden section steps along the hues.
std::string seam_colour(std::size_t seam) {
  const double turns = 0.6180339887 * static_cast<double>(seam), hue = 0.07 + 0.86 * (turns - std::floor(turns));
  constexpr double light = 0.36, spread = 0.30;
  std::string colour = "#";
  for (const double offset : {0.0, 8.0, 4.0}) {  // f(n) = l - a max(-1, min(k - 3, 9 - k, 1)), k = (n + 12 h) mod 12
    const double sum = offset + 12 * hue, k = sum - 12 * std::floor(sum / 12);
    const double value = light - spread * std::max(-1.0, std::min({k - 3, 9 - k, 1.0}));
    const int byte = std::clamp(static_cast<int>(std::lround(255 * value)), 0, 255);
    constexpr char hex[] = "0123456789abcdef";
    colour += hex[byte >> 4];
    colour += hex[byte & 15];
  }
  return colour;
}

std::string numbered(std::string_view letter, Index number) {
  return std::string(letter).append(std::to_string(number));
}

bool is_drawn(const PanelEdge& edge) { return edge.start >= 0 && edge.end >= 0 && edge.start != edge.end; }

class Drawing {
 public:
  Drawing(const Pattern& pattern, std::span<const LintFinding> findings) : pattern_(pattern), findings_(findings) {}

  std::string run() {
    measure();
    arrange();
    seams_of_edges();
    for (std::size_t p = 0; p < pattern_.panels.size(); ++p) draw_panel(p);
    for (std::size_t f = 0; f < findings_.size(); ++f) mark(f);
    legend();
    SvgText head;
    head.open(width_, height_, unit_);
    return head.str() + svg_.str() + "</svg>\n";
  }

 private:
  struct Cell {
    Vec2 low{0, 0}, high{0, 0};  // of the panel, in its plane, cm
    Vec2 origin{0, 0};           // where its plane's origin is drawn
    bool closed = false, clockwise = false;
    std::vector<std::vector<Vec2>> points;  // [edge] cm
  };

  // ---- layout of the drawing ----------------------------------------------------------------------------------------

  void measure() {
    double largest = 1e-3;
    for (const Panel& panel : pattern_.panels) {
      Cell cell;
      cell.low = Vec2::Constant(std::numeric_limits<double>::infinity());
      cell.high = -cell.low;
      const auto add = [&](const Vec2& p) {
        cell.low = cell.low.cwiseMin(p);
        cell.high = cell.high.cwiseMax(p);
      };
      for (const Vec2& c : panel.corners)
        if (std::isfinite(c.x() + c.y())) add(100 * c);
      double twice_area = 0;
      cell.closed = !panel.edges.empty();
      for (std::size_t e = 0; e < panel.edges.size(); ++e) {
        const PanelEdge &edge = panel.edges[e], &next = panel.edges[(e + 1) % panel.edges.size()];
        cell.closed = cell.closed && is_drawn(edge) && edge.end == next.start;
        cell.points.emplace_back();
        if (!is_drawn(edge)) continue;
        cell.points.back() = sample_edge(panel, edge, edge.kind == CurveKind::line ? 2 : 24);
        for (Vec2& p : cell.points.back()) add(p *= 100);
        const std::vector<Vec2>& p = cell.points.back();
        for (std::size_t k = 0; k + 1 < p.size(); ++k)
          twice_area += (p[k] - p[0]).x() * (p[k + 1] - p[0]).y() - (p[k] - p[0]).y() * (p[k + 1] - p[0]).x() +
                        p[0].x() * (p[k + 1] - p[k]).y() - p[0].y() * (p[k + 1] - p[k]).x();
      }
      if (!(cell.low.x() <= cell.high.x())) cell.low = cell.high = Vec2::Zero();
      cell.clockwise = twice_area < 0;
      largest = std::max(largest, (cell.high - cell.low).maxCoeff());
      cells_.push_back(std::move(cell));
    }
    unit_ = largest / usual_cm;
  }

  // Rows from left to right, about as wide as all is high.
  void arrange() {
    const double side = 5 * unit_, title = 4 * unit_;
    double area = 0, widest = 60 * unit_;
    std::vector<double> widths;
    for (std::size_t p = 0; p < cells_.size(); ++p) {
      const Vec2 size = cells_[p].high - cells_[p].low;
      const double name = 1.15 * unit_ * static_cast<double>(printable(pattern_.panels[p].name).size());
      widths.push_back(std::max(size.x(), name) + 2 * side);
      area += widths.back() * (size.y() + 2 * side + title);
      widest = std::max(widest, widths.back());
    }
    const double row_width = std::max(widest, 1.25 * std::sqrt(area));
    double x = 0, y = 0, row_height = 0;
    for (std::size_t p = 0; p < cells_.size(); ++p) {
      Cell& cell = cells_[p];
      const Vec2 size = cell.high - cell.low;
      if (x > 0 && x + widths[p] > row_width) {
        x = 0;
        y += row_height;
        row_height = 0;
      }
      cell.origin = Vec2(x + 0.5 * (widths[p] - size.x()) - cell.low.x(), y + side + title + cell.high.y());
      x += widths[p];
      row_height = std::max(row_height, size.y() + 2 * side + title);
      width_ = std::max(width_, x);
    }
    width_ = std::max(width_, 60 * unit_);
    height_ = y + row_height;
  }

  void seams_of_edges() {
    for (const Panel& panel : pattern_.panels) seam_.emplace_back(panel.edges.size(), -1);
    for (std::size_t s = 0; s < pattern_.stitches.size(); ++s)
      for (const StitchSide& side : {pattern_.stitches[s].a, pattern_.stitches[s].b})
        if (side.panel >= 0 && side.edge >= 0 && at(side.edge) < seam_[at(side.panel)].size())
          seam_[at(side.panel)][at(side.edge)] = static_cast<Index>(s);
  }

  Vec2 drawn(std::size_t panel, const Vec2& p_cm) const {
    return {cells_[panel].origin.x() + p_cm.x(), cells_[panel].origin.y() - p_cm.y()};
  }

  // ---- panels -----------------------------------------------------------------------------------------------------------

  std::string path_of(std::size_t p, const PanelEdge& edge, bool begin) const {
    const Panel& panel = pattern_.panels[p];
    const Vec2 from = drawn(p, 100 * panel.corners[at(edge.start)]), to = drawn(p, 100 * panel.corners[at(edge.end)]);
    std::string d = begin ? std::string("M").append(svg_point(from)) : std::string();
    const Vec2 c0 = drawn(p, 100 * edge.control[0]), c1 = drawn(p, 100 * edge.control[1]);
    switch (edge.kind) {
      case CurveKind::line:
        return d.append("L").append(svg_point(to));
      case CurveKind::quadratic:
        return d + "Q" + svg_point(c0) + " " + svg_point(to);
      case CurveKind::cubic:
        return d + "C" + svg_point(c0) + " " + svg_point(c1) + " " + svg_point(to);
      case CurveKind::circle:
        break;
    }
    const std::string radius = svg_number(100 * edge.radius_m);
    return d + "A" + radius + " " + radius + " 0 " + (edge.large_arc ? "1 " : "0 ") + (edge.sweep ? "0 " : "1 ") +
           svg_point(to);
  }

  // Unit vector from the middle of an edge into the panel, as drawn.
  Vec2 inward(std::size_t p, std::size_t e) const {
    const std::vector<Vec2>& points = cells_[p].points[e];
    const std::size_t k = points.size() / 2;
    Vec2 along = points[k] - points[k - 1];
    if (k + 1 < points.size()) along = points[k + 1] - points[k - 1];
    if (along.norm() == 0) return {0, -1};
    along.normalize();
    Vec2 left(-along.y(), along.x());
    const bool flip =
        cells_[p].closed ? cells_[p].clockwise : left.dot(0.5 * (cells_[p].low + cells_[p].high) - points[k]) < 0;
    if (flip) left = -left;
    return {left.x(), -left.y()};
  }

  // Numbers on both sides of a gap, or of a narrow panel, have room: a share of the way to the next edge, or `usual` units.
  double letter_size(std::size_t p, std::size_t e, const Vec2& toward, double usual, double share) const {
    const Vec2 from = cells_[p].points[e][cells_[p].points[e].size() / 2], way(toward.x(), -toward.y());
    double room = usual * unit_ / share;
    for (std::size_t other = 0; other < cells_[p].points.size(); ++other) {
      const std::vector<Vec2>& points = cells_[p].points[other];
      for (std::size_t k = 0; other != e && k + 1 < points.size(); ++k) {
        const Vec2 a = points[k] - from, along = points[k + 1] - points[k];
        const double across = way.x() * along.y() - way.y() * along.x();
        if (across == 0) continue;
        const double distance = (a.x() * along.y() - a.y() * along.x()) / across;
        const double part = (a.x() * way.y() - a.y() * way.x()) / across;
        if (distance > 0 && part >= 0 && part <= 1) room = std::min(room, distance);
      }
    }
    return std::max(share * room, 0.4 * unit_);
  }

  void draw_panel(std::size_t p) {
    const Panel& panel = pattern_.panels[p];
    const Cell& cell = cells_[p];
    svg_.open_group(printable(panel.name));
    if (cell.closed) {
      std::string outline;
      for (std::size_t e = 0; e < panel.edges.size(); ++e) outline += path_of(p, panel.edges[e], e == 0);
      svg_.path(outline + "Z", {"none", "#f4f1ea", 0});
    }
    for (const PanelFold& fold : panel.folds)
      if (is_drawn(fold.line)) svg_.path(path_of(p, fold.line, true), {text_colour, "none", 0.2 * unit_, 1.2 * unit_});
    draw_grain(p);
    for (std::size_t e = 0; e < panel.edges.size(); ++e) {
      if (!is_drawn(panel.edges[e])) continue;
      const Index seam = seam_[p][e];
      const std::string colour = seam < 0 ? std::string(line_colour) : seam_colour(at(seam));
      svg_.path(path_of(p, panel.edges[e], true), {colour, "none", (seam < 0 ? 0.25 : 0.5) * unit_});
      const Vec2 middle = drawn(p, cell.points[e][cell.points[e].size() / 2]), in = inward(p, e);
      const double letter = letter_size(p, e, in, 1.3, 0.3);
      svg_.text(middle + 1.1 * letter * in, std::to_string(panel.file_number(static_cast<Index>(e))),
                {letter, text_colour});
      if (seam < 0 || draw_dart(p, e)) continue;
      const double outside = letter_size(p, e, -in, 1.2, 0.2);
      svg_.text(middle - 1.25 * outside * in, numbered("s", seam), {outside, colour});
    }
    if (!cell.closed)
      for (std::size_t c = 0; c < panel.corners.size(); ++c) {
        svg_.circle(drawn(p, 100 * panel.corners[c]), 0.4 * unit_, line_colour, "none", 0);
        svg_.text(drawn(p, 100 * panel.corners[c]) + Vec2(1.2, -1.0) * unit_, numbered("c", static_cast<Index>(c)),
                  {1.1 * unit_, line_colour});
      }
    const Vec2 top = drawn(p, Vec2(0.5 * (cell.low.x() + cell.high.x()), cell.high.y()));
    svg_.text(top - Vec2(0, 7.2 * unit_), printable(panel.name), {2.0 * unit_, "#000000", true});
    svg_.close_group();
  }

  // The seam of a dart has its number beyond the tip, once: its sides are too near each other for two.
  bool draw_dart(std::size_t p, std::size_t e) {
    const Stitch& stitch = pattern_.stitches[at(seam_[p][e])];
    if (stitch.a.edge < 0 || stitch.b.edge < 0 || !is_dart(pattern_, stitch)) return false;
    const std::vector<PanelEdge>& edges = pattern_.panels[p].edges;
    if (!is_drawn(edges[at(stitch.a.edge)]) || !is_drawn(edges[at(stitch.b.edge)])) return false;
    if (at(stitch.a.edge) != e) return true;
    const Panel& panel = pattern_.panels[p];
    const PanelEdge &a = panel.edges[at(stitch.a.edge)], &b = panel.edges[at(stitch.b.edge)];
    const bool forward = a.end == b.start;
    const Vec2 tip = panel.corners[at(forward ? a.end : a.start)];
    const Vec2 mouth =
        0.5 * (panel.corners[at(forward ? a.start : a.end)] + panel.corners[at(forward ? b.end : b.start)]);
    const Vec2 along = (tip - mouth).norm() > 0 ? Vec2((tip - mouth).normalized()) : Vec2(0, -1);
    svg_.text(drawn(p, 100 * tip + 1.6 * unit_ * along), numbered("s", seam_[p][e]),
              {1.2 * unit_, seam_colour(at(seam_[p][e]))});
    return true;
  }

  // Where the outline crosses a line x = c or y = c (axis 0 or 1), in order, on the other axis.
  static std::vector<double> crossings(const Cell& cell, int axis, double c) {
    std::vector<double> found;
    for (const auto& points : cell.points)
      for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        const Vec2 &a = points[k], &b = points[k + 1];
        if ((a[axis] > c) == (b[axis] > c)) continue;
        found.push_back(a[1 - axis] + (c - a[axis]) / (b[axis] - a[axis]) * (b[1 - axis] - a[1 - axis]));
      }
    std::sort(found.begin(), found.end());
    return found;
  }

  // The arrow stands where the panel is widest, of some heights, beside the middle, where numbers of edges are.
  void draw_grain(std::size_t p) {
    const Cell& cell = cells_[p];
    if (!cell.closed) return;
    constexpr double beside = 0.6;
    double widest = 0;
    Vec2 place{0, 0};
    for (const double part : {0.5, 0.4, 0.6, 0.3, 0.7}) {
      const double y = cell.low.y() + part * (cell.high.y() - cell.low.y());
      const std::vector<double> found = crossings(cell, 1, y);
      for (std::size_t k = 0; k + 1 < found.size(); k += 2) {
        if (found[k + 1] - found[k] <= 1.05 * widest) continue;
        widest = found[k + 1] - found[k];
        place = Vec2(found[k] + beside * widest, y);
      }
    }
    const std::vector<double> found = crossings(cell, 0, place.x());
    double half = 0;
    for (std::size_t k = 0; k + 1 < found.size(); k += 2) {
      if (found[k] > place.y() || found[k + 1] < place.y()) continue;
      half = std::min(6 * unit_, 0.28 * (found[k + 1] - found[k]));
      place.y() = 0.5 * (found[k] + found[k + 1]);
    }
    const double head = std::min(0.9 * unit_, 0.4 * half);
    if (half <= 0 || widest < 2 * head) return;
    const Vec2 low = drawn(p, place - Vec2(0, half)), high = drawn(p, place + Vec2(0, half));
    svg_.path(std::string("M").append(svg_point(low)) + "L" + svg_point(high) + "M" +
                  svg_point(high + Vec2(-0.5 * head, head)) + "L" + svg_point(high) + "L" +
                  svg_point(high + Vec2(0.5 * head, head)),
              {"#909090", "none", 0.2 * unit_});
  }

  // ---- the findings --------------------------------------------------------------------------------------------------------

  std::string_view colour_of(const LintFinding& finding) const {
    return finding.severity == Severity::note ? note_colour : mark_colour;
  }

  // The number of a finding, where none is yet.
  void badge(Vec2 place, std::size_t number, std::string_view colour) {
    const double size = 1.5 * unit_;
    const auto taken = [&] {
      return std::any_of(badges_.begin(), badges_.end(),
                         [&](const Vec2& b) { return (b - place).norm() < 2.1 * size; });
    };
    for (int tries = 0; tries < 40 && taken(); ++tries) place.x() += 2.2 * size;
    place.x() = std::clamp(place.x(), size, std::max(size, width_ - size));
    badges_.push_back(place);
    svg_.circle(place, size, colour, "none", 0);
    svg_.text(place, std::to_string(number), {1.6 * unit_, "#ffffff", true});
  }

  void mark(std::size_t f) {
    const LintFinding& finding = findings_[f];
    for (const LintMark& one : finding.marks) {
      if (one.panel < 0 || at(one.panel) >= cells_.size()) continue;
      const std::size_t p = at(one.panel);
      const Panel& panel = pattern_.panels[p];
      const std::string_view colour = colour_of(finding);
      if (one.whole) {
        const Vec2 low = drawn(p, Vec2(cells_[p].low.x(), cells_[p].high.y())) - Vec2(2.6, 2.6) * unit_,
                   size = cells_[p].high - cells_[p].low + Vec2(5.2, 5.2) * unit_;
        svg_.rectangle(low, size, {colour, "none", 0.35 * unit_, 1.5 * unit_});
        badge(low, f + 1, colour);
        continue;
      }
      std::size_t found = panel.edges.size();
      for (std::size_t e = 0; e < panel.edges.size(); ++e)
        if (one.edge >= 0 && is_drawn(panel.edges[e]) && panel.file_number(static_cast<Index>(e)) == one.edge)
          found = e;
      const Vec2 place = drawn(p, 100 * one.at_m);
      if (found == panel.edges.size()) {
        svg_.circle(place, 1.3 * unit_, "none", colour, 0.4 * unit_);
        badge(place + Vec2(2.2, -2.2) * unit_, f + 1, colour);
        continue;
      }
      svg_.path(path_of(p, panel.edges[found], true), {colour, "none", 0.9 * unit_});
      const Vec2 middle = drawn(p, cells_[p].points[found][cells_[p].points[found].size() / 2]);
      if ((place - middle).norm() > 0.1 * unit_) svg_.circle(place, 1.3 * unit_, "none", colour, 0.4 * unit_);
      badge(middle - 3.9 * unit_ * inward(p, found), f + 1, colour);
    }
  }

  void legend() {
    const double size = 1.7 * unit_, line = 1.35 * size, left = 2 * unit_;
    const auto letters = static_cast<std::size_t>(std::max(30.0, (width_ - left - 6 * unit_) / (0.52 * size)));
    double y = height_ + line;
    const auto write = [&](std::string_view text, bool bold) {
      for (const std::string& part : svg_wrapped(text, letters)) {
        svg_.text(Vec2(left + 4.5 * unit_, y), part, {size, "#202020", bold, true});
        y += line;
      }
    };
    if (findings_.empty()) {
      svg_.text(Vec2(left, y), "nothing found", {size, "#202020", false, true});
      y += line;
    }
    for (std::size_t f = 0; f < findings_.size(); ++f) {
      const LintFinding& finding = findings_[f];
      svg_.circle(Vec2(left + 1.5 * unit_, y), 1.5 * unit_, colour_of(finding), "none", 0);
      svg_.text(Vec2(left + 1.5 * unit_, y), std::to_string(f + 1), {1.6 * unit_, "#ffffff", true});
      write(std::string(finding.code) + " (" + std::string(to_string(finding.severity)) + "): " + finding.place, true);
      write("expected " + finding.expected + ", got " + finding.got, false);
      write((finding.mended ? "can be mended: " : "") + finding.repair, false);
      y += 0.5 * line;
    }
    height_ = y + line;
  }

  const Pattern& pattern_;
  std::span<const LintFinding> findings_;
  std::vector<Cell> cells_;
  std::vector<std::vector<Index>> seam_;  // [panel][edge]
  std::vector<Vec2> badges_;
  double unit_ = 1, width_ = 0, height_ = 0;
  SvgText svg_;
};

}  // namespace

std::string draw_pattern(const Pattern& pattern, std::span<const LintFinding> findings) {
  return Drawing(pattern, findings).run();
}

}  // namespace toile::internal
