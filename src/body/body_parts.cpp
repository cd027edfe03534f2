#include "body/body_parts.hpp"

#include "core/error.hpp"
#include "mesh/inner_walls.hpp"
#include "mesh/join_sides.hpp"
#include "mesh/surface_parts.hpp"
#include "mesh/triangle_repair.hpp"

#include <fmt/printf.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace toile::internal {
namespace {

constexpr double part_share = 0.003;   // of the largest part's volume: a hand has 0.006, an eyeball 0.0001
constexpr double told_share = 0.01;    // of the body's: smaller parts that are left out are counted together
constexpr double mended_share = 0.05;  // of the largest part's area or of all triangles; smaller parts are not mended
constexpr double whole_share = 0.8;    // of the length of everything: what is as long is a body by itself
constexpr double digits = 1e-5;        // of a file's coordinates: places that differ by less of the file's size are one
constexpr double share_of_an_edge = 0.01;  // and by less of the middle edge: a floor in the file may be large

bool is_body_name(std::string_view name) {
  constexpr std::string_view wanted = "body";
  return std::equal(name.begin(), name.end(), wanted.begin(), wanted.end(),
                    [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; });
}

// [triangle of the file] its group or object is called body.
std::vector<char> named_body(const SurfaceMesh& mesh) {
  std::vector<char> named(mesh.triangles.size(), 0);
  const auto mark = [&](const std::vector<Index>& of, const std::vector<std::string>& names) {
    for (std::size_t t = 0; t < std::min(of.size(), named.size()); ++t)
      if (is_body_name(names[at(of[t])])) named[t] = 1;
  };
  mark(mesh.group, mesh.group_names);
  mark(mesh.object, mesh.object_names);
  return named;
}

struct Part {
  MendedTriangles mesh;
  std::vector<Index> vertices;  // ascending
  Eigen::AlignedBox3d box;
  double volume = 0, area = 0;  // volume only of a closed part
  bool closed = false, sound = false, named = false, wholly_named = true, taken = false;
  MendedPart mended;
  bool is_sheet() const { return !mended.open.empty() && mended.crowded[0] < 0 && mended.one_sided[0] < 0; }
};

class Selection {
 public:
  Selection(const SurfaceMesh& mesh, std::string_view file, double unit_m)
      : mesh_(mesh), file_(file), unit_m_(unit_m), named_(named_body(mesh)) {
    const JoinedSides joined = join_sides(mesh.positions, mesh.triangles, mesh.object);
    work_.triangles = joined_triangles(mesh.triangles, joined);
    work_.source.resize(work_.triangles.size());
    std::iota(work_.source.begin(), work_.source.end(), 0);
    if (joined.joined > 0)
      say(std::to_string(joined.joined) + " vertices lie where another one does, along a seam, and are one with it");
    split();
  }

  BodyParts body() {
    mend([&](const Part& part) { return is_candidate(part); });
    if (parts_.empty())
      throw InputError(file_, "body", "a closed surface", "triangles with a corner twice, and no others");
    if (std::none_of(parts_.begin(), parts_.end(), [](const Part& part) { return part.closed; }))
      refuse(largest_open());
    take();
    leave_inner_parts();
    check_what_is_open();
    say_what_is_left_out();
    return result();
  }

  BodyParts solid() {
    mend([](const Part&) { return true; });
    for (Part& part : parts_) {
      if (!part.closed && !part.is_sheet()) refuse(part);
      part.taken = true;
    }
    return result();
  }

 private:
  void say(const std::string& what) { notes_.push_back(std::string(file_) + ": " + what); }

  void split() {
    const SurfaceParts found = surface_parts(work_.triangles, mesh_.positions);
    parts_.assign(found.parts.size(), {});
    for (std::size_t t = 0; t < work_.triangles.size(); ++t) {
      Part& part = parts_[at(found.of[t])];
      part.mesh.triangles.push_back(work_.triangles[t]);
      part.mesh.source.push_back(work_.source[t]);
      const bool named = named_[at(work_.source[t])] != 0;
      part.named |= named;
      part.wholly_named &= named;
    }
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      parts_[p].closed = found.parts[p].closed;
      parts_[p].volume = found.parts[p].volume_m3;
      measure(parts_[p]);
    }
    largest_area_ = 0;
    Eigen::AlignedBox3d all, named;
    for (const Part& part : parts_) {
      largest_area_ = std::max(largest_area_, part.area);
      all.extend(part.box);
      if (part.named) named.extend(part.box);
    }
    name_is_whole_ = is_as_long(named, all);
  }

  // About as long as `all`, along its own longest extent.
  static bool is_as_long(const Eigen::AlignedBox3d& box, const Eigen::AlignedBox3d& all) {
    if (box.isEmpty()) return false;
    Eigen::Index longest = 0;
    const double length = box.sizes().maxCoeff(&longest);
    return length >= whole_share * all.sizes()[longest];
  }

  void measure(Part& part) const {
    part.area = 0;
    bool flat = false;
    for (const auto& [a, b, c] : part.mesh.triangles) {
      const Vec3 &x = mesh_.positions[at(a)], &y = mesh_.positions[at(b)], &z = mesh_.positions[at(c)];
      part.area += 0.5 * (y - x).cross(z - x).norm();
      flat |= is_flat({x, y, z});
      part.vertices.insert(part.vertices.end(), {a, b, c});
      for (const Vec3& corner : {x, y, z}) part.box.extend(corner);
    }
    std::sort(part.vertices.begin(), part.vertices.end());
    part.vertices.erase(std::unique(part.vertices.begin(), part.vertices.end()), part.vertices.end());
    part.sound = part.closed && part.volume > 0 && !flat;
  }

  bool is_candidate(const Part& part) const {
    if (name_is_whole_) return part.named;
    const auto triangles = static_cast<double>(part.mesh.triangles.size());
    return part.area >= mended_share * largest_area_ ||
           triangles >= mended_share * static_cast<double>(work_.triangles.size());
  }

  // Mends the parts for which `wanted`, if one of them needs it.
  template <class F>
  void mend(const F& wanted) {
    const auto needs_it = [&](const Part& part) { return wanted(part) && !part.sound; };
    if (std::none_of(parts_.begin(), parts_.end(), needs_it)) return;
    Eigen::AlignedBox3d all;
    for (const Part& part : parts_) all.extend(part.box);
    corners_ = mend_corners(work_, mesh_.positions,
                            std::min(digits * all.diagonal().norm(), share_of_an_edge * middle_edge()));
    split();
    for (Part& part : parts_) {
      if (!needs_it(part)) continue;
      part.mended = mend_part(part.mesh, mesh_.positions);
      const SurfaceParts found = surface_parts(part.mesh.triangles, mesh_.positions);
      part.closed = part.mended.closed() && !found.parts.empty() &&
                    std::all_of(found.parts.begin(), found.parts.end(), [](const SurfacePart& p) { return p.closed; });
      part.volume = 0;
      for (const SurfacePart& p : found.parts) part.volume += p.volume_m3;
    }
  }

  // The median of all sides.
  double middle_edge() const {
    std::vector<double> sides;
    for (const Triangle& t : work_.triangles)
      for (std::size_t k = 0; k < 3; ++k)
        sides.push_back((mesh_.positions[at(t[k])] - mesh_.positions[at(t[(k + 1) % 3])]).norm());
    const auto middle = sides.begin() + static_cast<std::ptrdiff_t>(sides.size() / 2);
    std::nth_element(sides.begin(), middle, sides.end());
    return *middle;
  }

  const Part& largest_open() const {
    const Part* largest = &parts_[0];
    for (const Part& part : parts_)
      if (std::pair(is_candidate(part), part.area) > std::pair(is_candidate(*largest), largest->area)) largest = &part;
    return *largest;
  }

  void take() {
    double largest = 0;
    bool named = false, named_and_closed = false;
    for (const Part& part : parts_) {
      named |= part.named;
      if (!part.closed) continue;
      named_and_closed |= part.named;
      largest = std::max(largest, std::abs(part.volume));
    }
    const bool by_name = name_is_whole_ && named_and_closed;
    for (Part& part : parts_) {
      part.taken = part.closed && (by_name ? part.named : std::abs(part.volume) >= part_share * largest);
      if (by_name && part.taken && !part.wholly_named)
        say("what the file calls body is open: taken with what it hangs together with (" + names_of(part) + ")");
    }
    if (named && !by_name) say("what the file calls body is not the whole of it: the name is not followed");
  }

  // Of a few vertices of `inner` all are in `outer`.
  bool contains(const Part& outer, const Part& inner) const {
    if (!outer.box.contains(inner.box)) return false;
    constexpr std::size_t probes = 16;
    const std::size_t stride = std::max<std::size_t>(1, inner.vertices.size() / probes);
    for (std::size_t v = 0; v < inner.vertices.size(); v += stride)
      if (!is_inside(mesh_.positions[at(inner.vertices[v])], outer.mesh.triangles, mesh_.positions)) return false;
    return true;
  }

  void leave_inner_parts() {
    for (Part& inner : parts_) {
      if (!inner.taken) continue;
      const bool within = std::any_of(parts_.begin(), parts_.end(), [&](const Part& outer) {
        return outer.taken && &outer != &inner && outer.area > inner.area && contains(outer, inner);
      });
      if (!within) continue;
      inner.taken = false;
      say(names_of(inner) + " (" + std::to_string(inner.vertices.size()) + " vertices) lies inside the body: left out");
    }
  }

  void check_what_is_open() {
    Eigen::AlignedBox3d all, taken;
    for (const Part& part : parts_) {
      if (part.taken) taken.extend(part.box);
      if (part.taken || is_candidate(part)) all.extend(part.box);
    }
    for (const Part& part : parts_) {
      if (part.closed || !is_candidate(part)) continue;
      if (!is_as_long(taken, all)) refuse(part);
      say(names_of(part) + " (" + std::to_string(part.vertices.size()) + " vertices) is open: left out");
    }
  }

  void say_what_is_left_out() {
    double volume = 0;
    for (const Part& part : parts_)
      if (part.taken) volume += std::abs(part.volume);
    std::size_t smaller = 0, of_vertices = 0;
    std::vector<std::string> names;
    for (const Part& part : parts_) {
      if (part.taken || (!part.closed && is_candidate(part))) continue;
      const double share = std::abs(part.volume) / volume;
      if (part.closed && share >= told_share) {
        say(names_of(part) + " (" + std::to_string(part.vertices.size()) + " vertices, " +
            fmt::sprintf("%.0f %% of the volume of the body) left out", 100 * share));
      } else {
        ++smaller;
        of_vertices += part.vertices.size();
        if (std::string name = names_of(part); std::find(names.begin(), names.end(), name) == names.end())
          names.push_back(std::move(name));
      }
    }
    if (smaller == 0) return;
    constexpr std::size_t most_names = 5;
    std::string list;
    for (std::size_t k = 0; k < std::min(names.size(), most_names); ++k) list += (k > 0 ? ", " : "") + names[k];
    say(std::to_string(smaller) + " smaller or open parts of " + std::to_string(of_vertices) + " vertices (" + list +
        (names.size() > most_names ? ", ...) left out" : ") left out"));
  }

  // The names of the objects (of the groups, if there is only one object) of a part, in the order of the file.
  std::string names_of(const Part& part) const {
    const bool by_object = mesh_.object_names.size() > 1;
    const auto& of = by_object ? mesh_.object : mesh_.group;
    const auto& names = by_object ? mesh_.object_names : mesh_.group_names;
    std::vector<char> used(names.size(), 0);
    for (const Index t : part.mesh.source)
      if (t >= 0 && at(t) < of.size()) used[at(of[at(t)])] = 1;
    std::string text;
    for (std::size_t k = 0; k < names.size(); ++k)
      if (used[k] != 0 && !names[k].empty()) text += (text.empty() ? "" : ", ") + printable(names[k]);
    return text.empty() ? "a part without a name" : text;
  }

  std::string holes_in_words(const std::vector<Hole>& holes) const {
    std::vector<const Hole*> by_girth;
    for (const Hole& hole : holes) by_girth.push_back(&hole);
    std::stable_sort(by_girth.begin(), by_girth.end(),
                     [](const Hole* l, const Hole* r) { return l->girth > r->girth; });
    constexpr std::size_t most = 3;
    std::string text = std::to_string(holes.size()) + (holes.size() == 1 ? " hole (" : " holes (");
    for (std::size_t h = 0; h < std::min(most, by_girth.size()); ++h) {
      // Without a minus before a zero.
      const Vec3 middle = (100 * unit_m_ * by_girth[h]->middle).array().round() / 100 + 0.0;
      text += (h > 0 ? ", " : "") + fmt::sprintf("%.3g m round at (%.2f, %.2f, %.2f) m", unit_m_ * by_girth[h]->girth,
                                                 middle.x(), middle.y(), middle.z());
    }
    return text + (by_girth.size() > most ? ", ...)" : ")");
  }

  [[noreturn]] void refuse(const Part& part) const {
    const auto edge = [](const std::array<Index, 2>& ends) {
      return "edge " + std::to_string(ends[0]) + "-" + std::to_string(ends[1]);
    };
    std::string got = names_of(part) + " (" + std::to_string(part.mesh.triangles.size()) + " triangles) ";
    if (part.mended.crowded[0] >= 0)
      got += "with three triangles or more at " + edge(part.mended.crowded);
    else if (part.mended.one_sided[0] >= 0)
      got += "that meets its own back at " + edge(part.mended.one_sided);
    else if (!part.mended.open.empty())
      got += "with " + holes_in_words(part.mended.open) + "; such a sheet may be one of a scene's `solids`";
    else
      got += "that encloses nothing";
    throw InputError(file_, "body", "a closed surface, but for holes as small as a neck's", got);
  }

  void say_what_was_mended() {
    std::vector<std::string> done;
    const auto count = [&](std::size_t number, std::string_view what) {
      if (number > 0) done.push_back(std::to_string(number) + ' ' + std::string(what));
    };
    MendedPart sum;
    std::size_t triangles = 0;
    for (const Part& part : parts_) {
      if (!part.taken) continue;
      sum.walls += part.mended.walls;
      sum.turned += part.mended.turned;
      sum.capped.insert(sum.capped.end(), part.mended.capped.begin(), part.mended.capped.end());
      for (const Index t : part.mesh.source) triangles += t >= 0 ? 1 : 0;
    }
    count(corners_.welded, "vertices at the place of another one are one with it");
    count(corners_.degenerate, "triangles with a corner twice are gone");
    count(corners_.duplicate, "triangles that were there before are gone");
    count(corners_.flat, "flat triangles have another diagonal");
    count(sum.walls, "triangles of walls inside are gone");
    if (sum.turned == triangles)
      done.emplace_back("all triangles are turned: it was inside out");
    else
      count(sum.turned, "triangles are turned to face outwards");
    if (!sum.capped.empty()) done.push_back(holes_in_words(sum.capped) + " capped");
    std::string text;
    for (const std::string& one : done) text += (text.empty() ? "" : "; ") + one;
    if (!text.empty()) say("mended: " + text);
  }

  BodyParts result() {
    say_what_was_mended();
    BodyParts parts;
    // In the order of the file, caps last.
    std::vector<std::pair<Index, Triangle>> triangles;
    for (const Part& part : parts_) {
      if (!part.taken) continue;
      if (part.is_sheet()) {
        say(names_of(part) + " (" + std::to_string(part.mesh.triangles.size()) + " triangles) is open, with " +
            holes_in_words(part.mended.open) +
            fmt::sprintf(": a sheet, solid %.0f mm behind its faces", 1000 * sheet_thickness_m));
        parts.sheets.insert(parts.sheets.end(), part.mesh.triangles.begin(), part.mesh.triangles.end());
        continue;
      }
      for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
        if (part.mesh.source[t] >= 0)
          triangles.emplace_back(part.mesh.source[t], part.mesh.triangles[t]);
        else
          caps_.push_back(part.mesh.triangles[t]);
      }
    }
    std::sort(triangles.begin(), triangles.end());
    for (const auto& [source, triangle] : triangles) parts.triangles.push_back(triangle);
    parts.triangles.insert(parts.triangles.end(), caps_.begin(), caps_.end());
    parts.notes = std::move(notes_);
    return parts;
  }

  const SurfaceMesh& mesh_;
  std::string_view file_;
  double unit_m_;
  std::vector<char> named_;     // [triangle of the file]
  bool name_is_whole_ = false;  // what is called body is as long as everything
  double largest_area_ = 0;
  MendedTriangles work_;
  MendedCorners corners_;
  std::vector<Part> parts_;
  std::vector<Triangle> caps_;
  std::vector<std::string> notes_;
};

}  // namespace

BodyParts body_parts(const SurfaceMesh& mesh, std::string_view file, double unit_m) {
  return Selection(mesh, file, unit_m).body();
}

BodyParts solid_parts(const SurfaceMesh& mesh, std::string_view file, double unit_m) {
  return Selection(mesh, file, unit_m).solid();
}

}  // namespace toile::internal
