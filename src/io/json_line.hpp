// io/json_line.hpp: one line of a file whose lines are JSON values of their own (JSON Lines).
#pragma once
#include "io/json.hpp"

#include <string_view>

namespace toile::internal {

// Json::parse of a text that begins in that line of the file.  Throws InputError with line and column.
Json parse_json_line(std::string_view text, std::string_view file, int line);

}  // namespace toile::internal
