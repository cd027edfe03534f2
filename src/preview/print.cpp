// preview/print.cpp: patterns averaged over a pixel's extent.
#include "preview/print.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace toile::internal {
namespace {

constexpr double least_print_extent_m = 1e-6;
constexpr int dot_places = 4;  // squared: at so many a dot is looked at, of which a pixel sees a part

Dye dye_of(const Vec3f& colour) { return {colour, colour, 1}; }
Dye dye_of(const Vec4f& premultiplied) {
  const Vec3f colour = premultiplied.head<3>().cwiseMin(whitest * premultiplied.w());
  return {colour, colour, premultiplied.w()};
}

float share_of(const Dots& dots) {
  const double radius = 0.5 * dots.diameter_m / dots.spacing_m;
  return static_cast<float>(std::numbers::pi * radius * radius);
}

// The share of a box, in spacings, that discs around whole numbers cover, from the distances of its parts' middles: each disc has an edge as soft as a
// part is wide, w, and its weight is that of the sharp one, pi r^2, over its own: pi (r^2 + w^2 / 12), or pi (r + w/2)^3 / (3 w) where it is all edge.
float cover_of(const Dots& dots, const Vec2& at, const Vec2& extent) {
  const double radius = 0.5 * dots.diameter_m / dots.spacing_m;
  const double part = std::max(extent.maxCoeff() / dot_places, least_print_extent_m / dots.spacing_m);
  double sum = 0;
  for (int i = 0; i < dot_places; ++i)
    for (int j = 0; j < dot_places; ++j) {
      const Vec2 q =
          at + Vec2(((i + 0.5) / dot_places - 0.5) * extent.x(), ((j + 0.5) / dot_places - 0.5) * extent.y());
      const double away = std::hypot(q.x() - std::round(q.x()), q.y() - std::round(q.y()));
      sum += std::clamp((radius - away) / part + 0.5, 0.0, 1.0);
    }
  const double reach = radius + 0.5 * part,
               soft = radius > 0.5 * part ? radius * radius + part * part / 12 : reach * reach * reach / (3 * part);
  return static_cast<float>(sum / (dot_places * dot_places) * radius * radius / soft);
}

// A period of about two pixels beats with their grid: 42 % of the contrast of one of 2, and 19 % of one of 1.5, is left by the tracer's filter with the
// extent of 0.75 pixels that it passes, and 12 % and 2 % with one of 1.65.  Edges of what is coarser stay as they are.
double without_beat(double extent_m, double period_m) {
  const auto extents = static_cast<float>(period_m / std::max(extent_m, least_print_extent_m));
  return extent_m * static_cast<double>(1.0f + 1.2f * (1.0f - smoothstep(3.0f, 6.0f, extents)));
}

Vec3f seen(const Sett& sett, double at, double extent_m) {
  return sett.mean_over(at, without_beat(extent_m, sett.fine_m()));
}
Dye seen(const Stripes& stripes, const Vec2& at, const Vec2& extent) {
  return dye_of(seen(stripes.sett, at.x(), extent.x()));
}
Dye seen(const Check& check, const Vec2& at, const Vec2& extent) {
  return {seen(check.sett, at.x(), extent.x()), seen(check.sett, at.y(), extent.y()), 1};
}
Dye seen(const Dots& dots, const Vec2& at, const Vec2& seen_extent) {
  const Vec2 extent(without_beat(seen_extent.x(), dots.spacing_m), without_beat(seen_extent.y(), dots.spacing_m));
  // A box as wide as the spacing has the mean anywhere; before, its parts would meet discs by chance.
  const float wide = smoothstep(0.6f, 1.0f, static_cast<float>(extent.maxCoeff() / dots.spacing_m));
  const float own = wide < 1 ? cover_of(dots, at / dots.spacing_m, extent / dots.spacing_m) : 0;
  const float cover = own + wide * (share_of(dots) - own);
  return {cover * dots.colour, cover * dots.colour, cover};
}
Dye seen(const Picture& picture, const Vec2& at, const Vec2& extent) {
  return dye_of(
      picture.texture.at(at.cwiseQuotient(picture.repeat_m), extent.cwiseQuotient(picture.repeat_m).cast<float>()));
}

Dye mean_dye(const Stripes& stripes) { return dye_of(stripes.sett.mean()); }
Dye mean_dye(const Check& check) { return dye_of(check.sett.mean()); }
Dye mean_dye(const Dots& dots) {
  const float cover = share_of(dots);
  return {cover * dots.colour, cover * dots.colour, cover};
}
Dye mean_dye(const Picture& picture) { return dye_of(picture.texture.mean()); }

}  // namespace

Sett::Sett(std::vector<Band> bands) : bands_(std::move(bands)) {
  for (const Band& band : bands_) {
    repeat_m_ += band.width_m;
    whole_ += band.width_m * band.colour.cast<double>();
  }
}

Sett::Sum Sett::integral(double x) const {
  const double repeats = std::floor(x / repeat_m_);
  double left = x - repeats * repeat_m_;
  Sum sum = repeats * whole_;
  for (const Band& band : bands_) {
    sum += std::clamp(left, 0.0, band.width_m) * band.colour.cast<double>();
    left -= band.width_m;
  }
  return sum;
}

Vec3f Sett::mean_over(double x, double extent_m) const {
  const double extent = std::max(extent_m, least_print_extent_m);
  double low = x - 0.5 * extent;
  low -= std::floor(low / repeat_m_) * repeat_m_;  // differences of small numbers
  return ((integral(low + extent) - integral(low)) / extent).cast<float>();
}

Vec3f Sett::mean() const { return (whole_ / repeat_m_).cast<float>(); }

Dye Print::at(const Vec2& point, const Vec2f& extent) const {
  if (!point.allFinite() || !extent.allFinite()) return mean();
  const double c = std::cos(turn_rad), s = std::sin(turn_rad);
  const Vec2 p = point - offset_m, e = extent.cast<double>();
  const Vec2 turned(c * p.x() + s * p.y(), c * p.y() - s * p.x());
  // Of an ellipse with these axes.
  const Vec2 turned_extent(std::hypot(c * e.x(), s * e.y()), std::hypot(s * e.x(), c * e.y()));
  return std::visit([&](const auto& one) { return seen(one, turned, turned_extent); }, pattern);
}

Dye Print::mean() const {
  return std::visit([](const auto& one) { return mean_dye(one); }, pattern);
}

}  // namespace toile::internal
