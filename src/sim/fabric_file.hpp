// sim/fabric_file.hpp: a fabric in a file of its own, as `toile fit-fabric` writes it and --fabric takes it.   docs/howto/fit-fabric.md
//
//   {"name": "my poplin", "fabric": {"base": "cotton", "density_kg_per_m2": 0.118, ...}, "uncertainty": {...}, ...}
//
// or the keys of "fabric" alone, as in a scene.
#pragma once
#include "material/fabric_fit.hpp"

#include <string>
#include <string_view>

namespace toile::internal {

// Ends with a line feed.
std::string to_json(const FabricFit& fit);

// Whether the text is of to_json: a file that it may replace.
bool is_fabric_fit(std::string_view text);

// Throws InputError naming file, line, key, expected and got; IoError where it cannot be read.
Fabric read_fabric_file(const std::string& path);

bool names_a_fabric_file(const std::string& name_or_file);  // it ends in .json

// A preset's, or a file's.  `place` is that of the name, for errors.
Fabric fabric_of(const std::string& name_or_file, std::string_view place);

}  // namespace toile::internal
