// preview/cloth_look.cpp: weaves as brightness over the drawing.
#include "preview/cloth_look.hpp"

#include "preview/low_discrepancy.hpp"

#include <array>
#include <cmath>
#include <cstdint>

namespace toile::internal {
namespace {

constexpr float pi = 3.14159265f;
constexpr int twill_repeat = 4, satin_repeat = 8;  // threads: warp over all but one
// Of a twill whose threads are too fine to be drawn: the first harmonic of a repeat in which one thread of four is the weft's is
// (2/pi) sin(pi/4) = 0.45, softened by eye; and the hollow between two ribs, by eye.
constexpr float rib_hue = 0.32f, rib_shade = 0.06f;
constexpr double row_height = 0.8;  // of a jersey's stitch, in wales

// In [-1, 1], the same for a thread every time.
float chance(int thread, std::uint32_t kind) {
  return static_cast<float>(mix_bits(static_cast<std::uint32_t>(thread) * 0x9e3779b9u + kind) >> 8) * 0x1p-23f - 1.0f;
}

// Yarn is never even: streaks two threads wide and some dozens long, in [-1, 1].
constexpr float streak_width = 2.0f, streak_length = 40.0f;  // threads
float streak(double along, double across, std::uint32_t kind) {
  const double x = along / streak_length, y = across / streak_width;
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  const float fx = smoothstep(0.0f, 1.0f, static_cast<float>(x - std::floor(x))),
              fy = smoothstep(0.0f, 1.0f, static_cast<float>(y - std::floor(y)));
  const auto value = [&](int di, int dj) { return chance((i + di) * 7919 + (j + dj) * 104729, kind); };
  const float near = value(0, 0) + fx * (value(1, 0) - value(0, 0)),
              far = value(0, 1) + fx * (value(1, 1) - value(0, 1));
  return near + fy * (far - near);
}

float fraction(float x) { return x - std::floor(x); }

// 1 for detail of this size that is seen, 0 for detail that a pixel averages.
float resolved(float extent, float size) { return 1.0f - smoothstep(0.35f, 1.0f, extent / size); }

// Of the warp, on the side that is seen.
float warp_share(Weave weave, bool right_side) {
  switch (weave) {
    case Weave::plain:
      return 0.5f;
    case Weave::twill:
      return right_side ? 1.0f - 1.0f / twill_repeat : 1.0f / twill_repeat;
    case Weave::even_twill:
      return 0.5f;
    case Weave::satin:
      return right_side ? 1.0f - 1.0f / satin_repeat : 1.0f / satin_repeat;
    case Weave::knit:
      return 1.0f;
    case Weave::none:
      return right_side ? 1.0f : 0.0f;
  }
  return 1.0f;
}

// On the right side.
bool is_warp_over(Weave weave, int warp, int weft) {
  const auto modulo = [](int i, int n) { return (i % n + n) % n; };
  switch (weave) {
    case Weave::plain:
      return modulo(warp + weft, 2) == 0;
    case Weave::twill:
      return modulo(warp - weft, twill_repeat) != 0;
    case Weave::even_twill:
      return modulo(warp - weft, twill_repeat) % 3 != 0;  // under the two around the rib's middle
    case Weave::satin:
      return modulo(3 * warp - weft, satin_repeat) != 0;
    case Weave::knit:
    case Weave::none:
      return true;
  }
  return true;
}

// Round threads that go over and under each other: brightness across the one on top, and along it.  The mean over f, g in [-1/2, 1/2] is 1.
float thread_shade(float across, float along) {
  constexpr float mean = (1.0f - 1.7f / 12.0f) * (0.8f + 0.2f * 2.0f / pi);
  return (1.0f - 1.7f * across * across) * (0.8f + 0.2f * std::cos(pi * along)) / mean;
}

// Stitches of a jersey: columns of Vs.  `x` 0 ... 1 from the middle of the wale to its edge, y in rows.
float stitch_shade(float x, float y) {
  constexpr float mean = 0.55f + 0.45f * 2.0f / pi;
  const float valley = 0.35f * smoothstep(0.65f, 1.0f, x) + 0.2f * (1.0f - smoothstep(0.0f, 0.3f, x));
  constexpr float valley_mean = 0.35f * 0.175f + 0.2f * 0.15f;
  return (0.55f + 0.45f * std::sin(pi * fraction(y + 0.6f * x))) / mean * (1.0f - valley) / (1.0f - valley_mean);
}

struct Threads {
  Vec3f warp, weft;
};

Vec3f mean_of(const Threads& threads, Weave weave, bool right_side) {
  return mix(threads.weft, threads.warp, warp_share(weave, right_side));
}

// Their mean on the right side is `colour`; warp and weft are lighter and darker than it in the same measure as those of the look, as far as neither
// reflects more than the whitest cloth.
Threads in_colour(const ClothLook& look, const Vec3f& colour) {
  const float mean = luminance(mean_of({look.warp, look.weft}, look.weave, true));
  if (!(mean > 1e-6f)) return {colour, colour};  // black
  const float warp = luminance(look.warp) / mean - 1.0f, weft = luminance(look.weft) / mean - 1.0f;
  const float most = std::max(warp, weft), room = whitest / std::max(1e-3f, colour.maxCoeff()) - 1.0f;
  const float share = most > room ? std::max(0.0f, room / most) : 1.0f;
  return {(1.0f + share * warp) * colour, (1.0f + share * weft) * colour};
}

// What is printed or woven in, over the threads.
Threads printed(const ClothLook& look, bool right_side, const Dye& dye) {
  const float share = right_side ? 1.0f : look.print->through, ground = 1.0f - share * dye.cover;
  Threads on{dye.warp, dye.weft};
  if (!look.print->is_woven()) {
    on = in_colour(look, dye.warp);
  } else if (look.weave == Weave::knit || look.weave == Weave::none) {  // no weft: printed
    on.warp = on.weft = 0.5f * (dye.warp + dye.weft);
  }
  return {ground * look.warp + share * on.warp, ground * look.weft + share * on.weft};
}

struct FabricLook {
  std::string_view fabric;
  ClothLook look;
};

// By the names of material/fabric.hpp, in the order of ClothLook.  Thicknesses are measured ones, which contact cannot resolve.
const std::array<FabricLook, 16>& fabric_looks() {
  static const std::array<FabricLook, 16> looks{{
      {"cotton",
       {.weave = Weave::plain,
        .warp = Vec3f(0.19f, 0.28f, 0.43f),
        .weft = Vec3f(0.38f, 0.45f, 0.55f),
        .stitch = Vec3f(0.30f, 0.36f, 0.44f),
        .thread_m = 3e-4f,
        .uneven = 0.06f,
        .thickness_m = 4e-4f,
        .hem_m = 0.015f,
        .sheen = 0.3f}},
      {"silk",
       {.weave = Weave::satin,
        .warp = Vec3f(0.60f, 0.41f, 0.34f),
        .weft = Vec3f(0.60f, 0.41f, 0.34f),
        .stitch = Vec3f(0.48f, 0.33f, 0.27f),
        .thread_m = 1.2e-4f,
        .uneven = 0.02f,
        .thickness_m = 2.2e-4f,
        .hem_m = 0.006f,
        .sheen = 0.12f,
        .gloss = 0.05f,
        .roughness = 0.42f}},
      {"wool",
       {.weave = Weave::twill,
        .warp = Vec3f(0.30f, 0.20f, 0.125f),
        .weft = Vec3f(0.38f, 0.27f, 0.18f),
        .stitch = Vec3f(0.30f, 0.22f, 0.14f),
        .thread_m = 4.5e-4f,
        .uneven = 0.08f,
        .thickness_m = 7e-4f,
        .hem_m = 0.03f,
        .sheen = 0.45f}},
      {"denim",
       {.weave = Weave::twill,
        .warp = Vec3f(0.028f, 0.052f, 0.115f),
        .weft = Vec3f(0.30f, 0.32f, 0.33f),
        .stitch = Vec3f(0.55f, 0.27f, 0.07f),
        .thread_m = 4.5e-4f,
        .uneven = 0.09f,
        .thickness_m = 9e-4f,
        .hem_m = 0.015f,
        .sheen = 0.2f}},
      {"knit",
       {.weave = Weave::knit,
        .warp = Vec3f(0.33f, 0.37f, 0.34f),
        .weft = Vec3f(0.33f, 0.37f, 0.34f),
        .stitch = Vec3f(0.26f, 0.30f, 0.27f),
        .thread_m = 9e-4f,
        .uneven = 0.03f,
        .thickness_m = 8e-4f,
        .hem_m = 0.02f,
        .sheen = 0.4f}},
      {"chiffon",
       {.weave = Weave::plain,
        .warp = Vec3f(0.62f, 0.56f, 0.52f),
        .weft = Vec3f(0.66f, 0.60f, 0.56f),
        .stitch = Vec3f(0.55f, 0.50f, 0.46f),
        .thread_m = 1.5e-4f,
        .uneven = 0.02f,
        .thickness_m = 1.5e-4f,
        .hem_m = 0.004f,
        .sheen = 0.15f}},
      {"satin",
       {.weave = Weave::satin,
        .warp = Vec3f(0.17f, 0.25f, 0.26f),
        .weft = Vec3f(0.17f, 0.25f, 0.26f),
        .stitch = Vec3f(0.13f, 0.20f, 0.21f),
        .thread_m = 1.2e-4f,
        .uneven = 0.01f,
        .thickness_m = 2.5e-4f,
        .hem_m = 0.008f,
        .sheen = 0.1f,
        .gloss = 0.08f,
        .roughness = 0.34f}},
      {"jersey",
       {.weave = Weave::knit,
        .warp = Vec3f(0.42f, 0.42f, 0.42f),
        .weft = Vec3f(0.42f, 0.42f, 0.42f),
        .stitch = Vec3f(0.34f, 0.34f, 0.34f),
        .thread_m = 7e-4f,
        .uneven = 0.03f,
        .thickness_m = 6e-4f,
        .hem_m = 0.02f,
        .sheen = 0.35f}},
      {"rib",
       {.weave = Weave::knit,
        .warp = Vec3f(0.40f, 0.30f, 0.24f),
        .weft = Vec3f(0.40f, 0.30f, 0.24f),
        .stitch = Vec3f(0.33f, 0.25f, 0.20f),
        .thread_m = 1.6e-3f,
        .uneven = 0.03f,
        .thickness_m = 1.1e-3f,
        .hem_m = 0.02f,
        .sheen = 0.4f}},
      {"poplin",
       {.weave = Weave::plain,
        .warp = Vec3f(0.60f, 0.61f, 0.63f),
        .weft = Vec3f(0.60f, 0.61f, 0.63f),
        .stitch = Vec3f(0.50f, 0.51f, 0.53f),
        .thread_m = 2e-4f,
        .uneven = 0.02f,
        .thickness_m = 5e-4f,
        .hem_m = 0.012f,
        .sheen = 0.2f}},
      {"linen",
       {.weave = Weave::plain,
        .warp = Vec3f(0.44f, 0.38f, 0.28f),
        .weft = Vec3f(0.50f, 0.44f, 0.34f),
        .stitch = Vec3f(0.38f, 0.33f, 0.25f),
        .thread_m = 5e-4f,
        .uneven = 0.16f,
        .thickness_m = 4e-4f,
        .hem_m = 0.02f,
        .sheen = 0.2f}},
      {"flannel",
       {.weave = Weave::twill,
        .warp = Vec3f(0.17f, 0.18f, 0.20f),
        .weft = Vec3f(0.24f, 0.25f, 0.27f),
        .stitch = Vec3f(0.18f, 0.19f, 0.21f),
        .thread_m = 5e-4f,
        .uneven = 0.12f,
        .thickness_m = 7.5e-4f,
        .hem_m = 0.03f,
        .sheen = 0.7f}},
      {"suiting",
       {.weave = Weave::twill,
        .warp = Vec3f(0.055f, 0.06f, 0.085f),
        .weft = Vec3f(0.07f, 0.075f, 0.10f),
        .stitch = Vec3f(0.05f, 0.055f, 0.075f),
        .thread_m = 3e-4f,
        .uneven = 0.04f,
        .thickness_m = 4e-4f,
        .hem_m = 0.03f,
        .sheen = 0.35f}},
      {"canvas",
       {.weave = Weave::plain,
        .warp = Vec3f(0.46f, 0.42f, 0.33f),
        .weft = Vec3f(0.46f, 0.42f, 0.33f),
        .stitch = Vec3f(0.40f, 0.36f, 0.28f),
        .thread_m = 7e-4f,
        .uneven = 0.07f,
        .thickness_m = 6.8e-4f,
        .hem_m = 0.02f,
        .sheen = 0.15f}},
      {"leather",
       {.weave = Weave::none,
        .warp = Vec3f(0.07f, 0.042f, 0.03f),
        .weft = Vec3f(0.16f, 0.115f, 0.085f),
        .stitch = Vec3f(0.05f, 0.03f, 0.022f),
        .thread_m = 1e-3f,
        .uneven = 0.01f,
        .thickness_m = 8e-4f,
        .hem_m = 0.012f,
        .sheen = 0,
        .gloss = 0.05f,
        .roughness = 0.38f}},
      {"neoprene",
       {.weave = Weave::knit,
        .warp = Vec3f(0.05f, 0.055f, 0.06f),
        .weft = Vec3f(0.05f, 0.055f, 0.06f),
        .stitch = Vec3f(0.09f, 0.09f, 0.095f),
        .thread_m = 4e-4f,
        .uneven = 0.02f,
        .thickness_m = 3e-3f,
        .hem_m = 0.015f,
        .sheen = 0.25f}},
  }};
  return looks;
}

}  // namespace

ClothLook look_of(std::string_view fabric) {
  for (const FabricLook& one : fabric_looks())
    if (one.fabric == fabric) return one.look;
  return fabric_looks().front().look;
}

ClothLook dyed(const ClothLook& look, const Vec3f& colour) {
  const float mean = std::max(1e-3f, 0.5f * (luminance(look.warp) + luminance(look.weft)));
  ClothLook other = look;
  other.warp = (luminance(look.warp) / mean * colour).cwiseMin(0.9f);
  other.weft = (luminance(look.weft) / mean * colour).cwiseMin(0.9f);
  other.stitch = 0.8f * other.weft;
  return other;
}

ClothLook coloured(const ClothLook& look, const Vec3f& colour) {
  const auto& [warp, weft] = in_colour(look, colour);
  ClothLook other = look;
  other.warp = warp;
  other.weft = weft;
  return other;
}

Vec3f mean_colour(const ClothLook& look, bool right_side) {
  if (look.print) return mean_of(printed(look, right_side, look.print->mean()), look.weave, right_side);
  return mean_of({look.warp, look.weft}, look.weave, right_side);
}

Vec3f thread_colour(const ClothLook& look, bool right_side, const Vec2& point, const Vec2f& extent) {
  const Threads dye =
      look.print ? printed(look, right_side, look.print->at(point, extent)) : Threads{look.warp, look.weft};
  const float size = look.thread_m, blur = std::max(extent.x(), extent.y());
  const Vec2 threads_at =
      point / static_cast<double>(size);  // warp threads lie side by side along x, weft threads along y
  const Vec2 whole(std::floor(threads_at.x()), std::floor(threads_at.y()));
  const int warp = static_cast<int>(whole.x()), weft = static_cast<int>(whole.y());
  const float across_warp = static_cast<float>(threads_at.x() - whole.x()) - 0.5f,
              across_weft = static_cast<float>(threads_at.y() - whole.y()) - 0.5f;
  const float left = look.uneven * std::min(1.0f, streak_width * size / std::max(blur, 1e-9f));  // after averaging
  const float uneven = left * (streak(threads_at.y(), threads_at.x(), 3) +
                               (look.weave == Weave::knit ? 0.0f : streak(threads_at.x(), threads_at.y(), 4)));
  const Vec3f mean = (1.0f + uneven) * mean_of(dye, look.weave, right_side);
  if (look.weave == Weave::none) return mean;
  const float threads = resolved(blur, size);
  const bool is_twill = look.weave == Weave::twill || look.weave == Weave::even_twill;
  const float ribs = is_twill ? resolved(blur, 0.7f * twill_repeat * size) : threads;
  if (!(threads > 0) && !(ribs > 0)) return mean;
  if (look.weave == Weave::knit) {
    const auto row = static_cast<float>(threads_at.y() / row_height - std::floor(threads_at.y() / row_height));
    const float shade =
        stitch_shade(2.0f * std::abs(across_warp), row) * (1.0f + uneven + look.uneven * chance(warp, 1));
    return mix(mean, Vec3f(shade * dye.warp), threads);
  }
  const bool warp_over = is_warp_over(look.weave, warp, weft) == right_side;
  const float shade = warp_over ? thread_shade(across_warp, across_weft) * (1.0f + look.uneven * chance(warp, 1))
                                : thread_shade(across_weft, across_warp) * (1.0f + look.uneven * chance(weft, 2));
  const Vec3f close = (1.0f + uneven) * shade * (warp_over ? dye.warp : dye.weft);
  Vec3f far = mean;
  if (is_twill) {
    // The diagonal ribs, as cosines, where threads are too fine.
    const double diagonal = (threads_at.x() - threads_at.y() + 0.5) / twill_repeat;
    const float rib = ribs * std::cos(2.0f * pi * static_cast<float>(diagonal - std::floor(diagonal)));
    far += rib_hue * rib * (right_side ? 1.0f : -1.0f) * (dye.weft - dye.warp) + rib_shade * rib * mean;
  }
  return mix(far, close, threads).cwiseMax(0.0f);
}

float line_cover(float x, float extent, float width) {
  const float half = 0.5f * std::max(extent, 1e-7f),
              inside = std::min(x + half, 0.5f * width) - std::max(x - half, -0.5f * width);
  return std::clamp(inside / (2.0f * half), 0.0f, 1.0f);
}

}  // namespace toile::internal
