// garment/lint_size.cpp: does the garment have the size and place of a person, or of the body given?
//
// A pattern is placed where it is worn, above the floor: the height of its top shows the height of its wearer.
//
//   with arms       top of the neck opening = 0.76 ... 1.25 of the height (a deep neck ... the rim of a hood)
//   without         top of the upper opening = 0.56 ... 0.80 (trousers on the hips ... a strapless top)
//
// Bands of 40 %, so only large errors are found: a wrong unit (2.54, 10 or 100 times), a child's body for an adult's shirt.
#include "garment/lint_context.hpp"
#include "garment/pattern_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace toile::internal {
namespace {

struct Band {
  double low, high;
};
constexpr Band neck_levels{0.76, 1.25}, waist_levels{0.56, 0.80};  // of the height
constexpr Band people_m{0.95, 2.2};                                // heights of wearers: from three years on
// In the frame of 2021, with the pelvis at 0, only sizes are known: the garment's height and its largest opening.
constexpr Band legacy_height_m{0.2, 2.2}, legacy_girth_m{0.6, 12};
constexpr double least_waist_m = 0.5;  // of the smallest of them
constexpr double small_waist = 0.65;   // waist of the garment / of the body: elastic gives 1.4
constexpr double neck_height = 0.85;   // of the height: top of a neck opening
// Possible units, as multiples of the length read: cm for inches, m for cm, mm for cm ...
constexpr std::array<double, 6> factors{2.54, 1 / 2.54, 10, 0.1, 100, 0.01};

// At most three digits behind the point, and no zeros at the end.
std::string number(double value) {
  std::string text = fixed_text(value, 3);
  while (text.ends_with('0')) text.pop_back();
  if (text.ends_with('.')) text.pop_back();
  return text;
}

class SizeLint {
 public:
  explicit SizeLint(LintContext& context) : context_(context), pattern_(context.pattern) {}

  void run() {
    std::vector<const PatternFault*> sizes;
    for (const PatternFault& fault : context_.faults)
      if (fault.code == reason::unit_doubtful) sizes.push_back(&fault);
    // A panel that is far from the others is no evidence of the size.
    const bool far = std::any_of(context_.problems.begin(), context_.problems.end(),
                                 [](const LintProblem& problem) { return problem.finding.code == reason::panel_far; });
    const bool known = !far && find_garment();
    if ((!sizes.empty() || (known && !fits_people(1))) && tell_unit(sizes, known)) return;
    if (known && context_.body) check_body();
  }

 private:
  // The piece with most cloth, if it closes around the axis.
  bool find_garment() {
    if (!context_.boundary) return false;
    const Boundary& boundary = *context_.boundary;
    const auto largest =
        std::max_element(boundary.pieces.begin(), boundary.pieces.end(),
                         [](const GarmentPiece& a, const GarmentPiece& b) { return a.area_m2 < b.area_m2; });
    if (largest == boundary.pieces.end()) return false;
    piece_ = &*largest;
    wearing_ = find_wearing(pattern_, boundary, static_cast<Index>(largest - boundary.pieces.begin()));
    if (wearing_.top < 0) return false;
    const auto openings = wearing_.around.size() + wearing_.hands.size() + wearing_.feet.size();
    if (openings < 2) return false;  // a sheet, a cape
    top_m_ = boundary.openings[at(wearing_.top)].high_m.y();
    for (const Opening& opening : boundary.openings)
      if (opening.piece == wearing_.piece) girth_m_ = std::max(girth_m_, opening.girth_m);
    return true;
  }

  // The possible heights of its wearer, were it `factor` times as large.
  Band heights(double factor) const {
    const Band band = wearing_.has_arms ? neck_levels : waist_levels;
    return {factor * top_m_ / band.high, factor * top_m_ / band.low};
  }
  bool fits_people(double factor) const {
    if (pattern_.legacy_frame) {
      const double height = factor * (piece_->high_m.y() - piece_->low_m.y()), girth = factor * girth_m_;
      return height >= legacy_height_m.low && height <= legacy_height_m.high && girth >= legacy_girth_m.low &&
             girth <= legacy_girth_m.high;
    }
    const Band who = heights(factor);
    if (!(who.high >= people_m.low && who.low <= people_m.high)) return false;
    if (factor == 1) return true;
    const double trunk = context_.body ? context_.body->waist_girth_m : least_waist_m;
    if (factor * girth_m_ < small_waist * trunk) return false;
    if (!context_.body) return true;
    return who.low <= context_.body->height_m() && who.high >= context_.body->height_m();
  }

  const Json& json_of_units() const {
    const Json* properties = context_.root.find("properties");
    if (properties == nullptr) return context_.root;
    const Json* units = properties->find("units_in_meter");
    return units == nullptr ? *properties : *units;
  }

  bool tell_unit(const std::vector<const PatternFault*>& sizes, bool known) {
    std::vector<double> meant;
    if (known)
      for (const double factor : factors)
        if (fits_people(factor)) meant.push_back(factor);
    if (sizes.empty() && meant.empty()) return false;  // no unit gives it a person's size: the fault is another one
    context_.unit_doubtful = true;
    const Severity severity = sizes.empty() ? Severity::warning : Severity::error;
    std::string got;
    if (!sizes.empty()) {
      got = place_of(pattern_, *sizes.front()) + " of " + sizes.front()->got.substr(0, sizes.front()->got.find(": is"));
    } else if (pattern_.legacy_frame) {
      got = "a garment " + cm_text(piece_->high_m.y() - piece_->low_m.y()) + " high";
    } else {
      got = "a garment whose top is " + cm_text(top_m_) + " above the floor";
    }
    LintProblem& problem =
        context_.add(reason::unit_doubtful, severity, json_of_units(), "properties",
                     "a garment of a person's size; " + number(pattern_.units_in_meter) + " units are a metre" +
                         (pattern_.units_assumed ? " where none is named" : ""),
                     std::move(got));
    if (meant.size() != 1) {
      problem.finding.repair = meant.empty() ? "refused: no usual unit makes it a person's size"
                                             : "refused: more than one unit makes it a person's size";
      return true;
    }
    const double units = pattern_.units_in_meter / meant.front();
    const double nearest = std::round(units * 1e6) / 1e6;
    problem.finding.repair = "units_in_meter is " + number(nearest);
    problem.mend = [nearest](PatternRepair& repair) { repair.set_units_in_meter(nearest); };
    return true;
  }

  // ---- cut for another ----------------------------------------------------------------------------------------------

  LintProblem& add(std::string_view code, std::string expected, std::string got) {
    LintProblem& problem = context_.add(code, Severity::warning, context_.root.at("pattern"), "the garment",
                                        std::move(expected), std::move(got));
    problem.finding.marks = {context_.mark_panel(piece_->panels.front())};
    return problem;
  }

  void check_body() {
    const BodyFigures& body = *context_.body;
    Vec3 low = piece_->low_m, high = piece_->high_m;
    for (const GarmentPiece& piece : context_.boundary->pieces) {
      low = low.cwiseMin(piece.low_m);
      high = high.cwiseMax(piece.high_m);
    }
    const auto beside = [&](int axis) { return body.middle_m[axis] < low[axis] || body.middle_m[axis] > high[axis]; };
    const bool above = !pattern_.legacy_frame && low.y() > body.high_m.y(),
               below = !pattern_.legacy_frame && high.y() < body.low_m.y() + waist_levels.low / 2 * body.height_m();
    if (beside(0) || beside(2) || above || below) return tell_place(low, high, above || below);
    if (!check_size()) tell_misfits();
  }

  // False when all sizes are plausible.
  bool check_size() {
    const BodyFigures& body = *context_.body;
    if (pattern_.legacy_frame) return false;
    const Band who = heights(1);
    const double top = top_m_ - body.low_m.y();
    const Band band = wearing_.has_arms ? neck_levels : waist_levels;
    if (body.height_m() < top / band.high || body.height_m() > top / band.low) {
      LintProblem& problem = add(reason::other_body,
                                 "a garment for a person between " + cm_text(who.low) + " and " + cm_text(who.high) +
                                     ", as high as its top is",
                                 "a body " + cm_text(body.height_m()) + " tall");
      problem.finding.repair = "refused: it would have to be drafted anew";
      return true;
    }
    const Opening& top_opening = context_.boundary->openings[at(wearing_.top)];
    if (!wearing_.has_arms && body.waist_girth_m > 0 && top_opening.girth_m < small_waist * body.waist_girth_m) {
      LintProblem& problem = add(reason::other_body,
                                 "an upper opening of at least " + cm_text(small_waist * body.waist_girth_m) +
                                     " for a waist of " + cm_text(body.waist_girth_m),
                                 cm_text(top_opening.girth_m));
      problem.finding.repair = "refused: it would have to be drafted anew";
      return true;
    }
    return false;
  }

  // The body that it was cut for, by labels and by the angle of the sleeves.
  void tell_misfits() {
    for (Misfit& misfit : misfits(pattern_, *context_.body)) {
      LintProblem& problem = add(misfit.code, std::move(misfit.expected), std::move(misfit.got));
      problem.finding.repair = misfit.code == reason::other_pose
                                   ? "refused: `dress` turns the sleeves onto the arms as they are"
                                   : "refused: it would have to be drafted anew";
    }
  }

  // The height of the top on this body, from labels and openings; negative: not known.
  double top_on_body() const {
    const BodyFigures& body = *context_.body;
    if (wearing_.has_arms) return body.low_m.y() + neck_height * body.height_m();
    for (const StitchSide& side : context_.boundary->openings[at(wearing_.top)].edges)
      if (pattern_.panels[at(side.panel)].edges[at(side.edge)].label == "lower_interface" && body.waist_m > 0)
        return body.waist_m;
    return -1;
  }

  void tell_place(const Vec3& low, const Vec3& high, bool vertical) {
    const BodyFigures& body = *context_.body;
    LintProblem& problem =
        add(reason::off_body, "panels around the body",
            "panels from (" + number(100 * low.x()) + ", " + number(100 * low.y()) + ", " + number(100 * low.z()) +
                ") to (" + number(100 * high.x()) + ", " + number(100 * high.y()) + ", " + number(100 * high.z()) +
                ") cm, the body at (" + number(100 * body.middle_m.x()) + ", " + number(100 * body.middle_m.y()) +
                ", " + number(100 * body.middle_m.z()) + ") cm");
    Vec3 shift = body.middle_m - 0.5 * (piece_->low_m + piece_->high_m);
    for (const int axis : {0, 1, 2})
      if (axis == 1 || (body.middle_m[axis] >= low[axis] && body.middle_m[axis] <= high[axis])) shift[axis] = 0;
    if (vertical) {
      const double top = top_on_body();
      if (top < 0) {
        problem.finding.repair = "refused: how high it belongs is not known";
        return;
      }
      shift.y() = top - top_m_;
    }
    const double moved_top = top_m_ + shift.y() - body.low_m.y();
    const Band band = wearing_.has_arms ? neck_levels : waist_levels;
    if (!pattern_.legacy_frame && (body.height_m() < moved_top / band.high || body.height_m() > moved_top / band.low)) {
      problem.finding.repair = "refused: beside the body or around it, it is not its size";
      return;
    }
    for (int k = 0; k < 3; ++k) shift[k] = std::round(1000 * shift[k]) / 1000;  // whole millimetres
    problem.finding.repair = "all panels are shifted by (" + number(100 * shift.x()) + ", " + number(100 * shift.y()) +
                             ", " + number(100 * shift.z()) + ") cm";
    problem.mend = [shift, units = pattern_.units_in_meter](PatternRepair& repair) {
      repair.shift_panels(shift * units);
    };
  }

  LintContext& context_;
  const Pattern& pattern_;
  const GarmentPiece* piece_ = nullptr;
  Wearing wearing_;
  double top_m_ = 0, girth_m_ = 0;
};

}  // namespace

void lint_size(LintContext& context) { SizeLint(context).run(); }

}  // namespace toile::internal
