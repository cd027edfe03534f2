// sim/fabric_measurements_file.hpp: reads the figures of a textile laboratory.                        docs/howto/fit-fabric.md
#pragma once
#include "io/json_places.hpp"
#include "material/fabric_fit.hpp"

#include <string>
#include <string_view>

namespace toile::internal {

struct FabricMeasurementsFile {
  FabricMeasurements measured;
  JsonPlaces places;  // by the pointers of the file
};

// Strict: throws InputError naming file, line, key, expected and got for a key that it does not know, a value that cannot be of a cloth
// in the key's unit, figures that need or exclude each other, and a file without any figure.
FabricMeasurementsFile parse_fabric_measurements(std::string_view text, const std::string& file);

// Of a file.  Errors of the fit have their place in it, too.
FabricFit fit_fabric_file(const std::string& path);

}  // namespace toile::internal
