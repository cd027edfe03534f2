// material/fabric_fit.hpp: a fabric, and how well it is known, from the figures of a laboratory.          docs/howto/fit-fabric.md
//
//   bending      c: D = w g c^3;  B;  a drape coefficient where nothing else says it
//   stretch      the chord of the force-extension curve from zero to the forces that a garment carries, and from the curve's end how it
//                stiffens: T = k (e + e^3 / d^2)
//   shear        G, or the extension on the bias
//
// What no figure says is the base preset's.
#pragma once
#include "material/fabric.hpp"
#include "material/fabric_measurements.hpp"
#include "material/readings.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

struct FittedNumber {
  std::string_view key;  // of a scene's fabric; of what is beside it a key of its own
  Estimate estimate;     // readings = 0: the base's
  std::vector<Estimate> sources;
};

struct FitFlag {
  std::string_view code;  // never changes its meaning
  std::string_view key;   // of the number that it is about
  std::string text;
};

struct DrapeFit {                                   // percent
  std::optional<Estimate> measured, of_the_fabric;  // what the disc showed; what the fitted fabric shows
  bool gives_bending = false;
};

struct FabricFit {
  std::string name;
  Fabric fabric;                      // numbers of four digits
  std::vector<FittedNumber> numbers;  // density, stretch, shear, bend, friction
  std::vector<FittedNumber> beside;   // measured, and not a number of the fabric
  std::vector<FitFlag> flags;
  DrapeFit drape;
};

namespace fit_flag {
inline constexpr std::string_view sources_disagree = "sources_disagree", drape_disagrees = "drape_disagrees",
                                  weight_of_the_base = "weight_of_the_base", chord_elsewhere = "chord_elsewhere",
                                  outside_the_drape_curve = "outside_the_drape_curve", stiff_stretch = "stiff_stretch",
                                  no_bending_friction = "no_bending_friction";
}  // namespace fit_flag

// Relative scatter of a single reading.  They are our estimates, on the wide side of what interlaboratory tests state; from two readings on the
// readings' own scatter counts instead.
namespace single_reading {
inline constexpr double weight = 0.02, bending_length = 0.05, fast_rigidity = 0.15, kes_bending = 0.1, extension = 0.1,
                        kes_linearity = 0.05, kes_work = 0.1, shear = 0.1, curve = 0.05, drape = 0.05, friction = 0.1,
                        thickness = 0.05, hysteresis = 0.15;
}

// Throws InputError of a path of the measurements ("/drape_percent") for a drape outside the curve, where bending is to come from it.
FabricFit fit_fabric(const FabricMeasurements& measured);

// Rounded to four significant digits.
double four_digits(double x);

}  // namespace toile::internal
