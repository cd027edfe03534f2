// preview/looks.hpp: colours and prints of a run's cloth, from a file.                          docs/howto/preview.md#colours-and-prints
//
//   {"looks": [{"panel": "collar", "colour": "#f4f1e8"}, {"garment": 0, "print": {"stripes": [["#ffffff", 12], ["#22305a", 8]]}}, ...]}
//
// A rule is of the panels that have all of the names that it gives, of all cloth if it gives none; what a later rule says replaces what an earlier
// one said of the same.
//
// Mind: they are for pictures.  No run reads them.
#pragma once
#include "core/types.hpp"
#include "io/json.hpp"
#include "preview/cloth_look.hpp"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

// A panel of a run.
struct ClothPart {
  Index garment = 0;  // from the inside out
  std::string garment_name, panel, fabric;
};

class Looks {
 public:
  // Throws InputError with line and pointer: of a key that is not known, a colour or a size that cannot be, a picture that is not there or no PNG.
  static Looks parse(std::string_view text, const std::string& file);
  // Throws IoError, too.
  static Looks load(const std::string& path);

  // Throws InputError for a rule that names what none of these has.
  void check(std::span<const ClothPart> parts) const;

  // A look like `own`, in the colours of the rules.
  ClothLook look_of(const ClothPart& part, const ClothLook& own) const;
  // The mean colour of its right side, linear; none where no rule gives one.
  std::optional<Vec3f> colour_of(const ClothPart& part, const ClothLook& own) const;

  // That file and its pictures.
  const std::vector<std::string>& files() const { return files_; }

 private:
  // What a rule says; empty: nothing.
  struct Style {
    std::optional<Vec3f> colour, stitch;
    std::optional<float> sheen, gloss, roughness;
    std::optional<std::shared_ptr<const Print>> print;  // of null: none
  };
  struct Rule {
    Json json;
    std::optional<Index> garment;
    std::vector<std::string> garments, panels, fabrics;  // one of each; empty: any
    Style style;
    bool is_of(const ClothPart& part) const;
  };
  Style style_of(const ClothPart& part) const;
  Rule read_rule(const Json& json);

  std::vector<Rule> rules_;
  std::vector<std::string> files_;
};

}  // namespace toile::internal
