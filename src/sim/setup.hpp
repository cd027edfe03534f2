// sim/setup.hpp: from the words of a scene to cloth and body in memory, before anything moves.
#pragma once
#include "assembly/cloth_model.hpp"
#include "core/hash.hpp"
#include "garment/garment_mesh.hpp"
#include "garment/pattern_figures.hpp"
#include "sim/colliders.hpp"
#include "sim/keyed.hpp"
#include "sim/outfit.hpp"
#include "sim/outfit_run.hpp"
#include "sim/scene.hpp"
#include "step/implicit_euler.hpp"

#include <vector>

namespace toile::internal {

// A cloth of the scene, meshed and moved as `placement` says: a pattern's panels, or a shape of one panel.
struct LoadedCloth {
  GarmentMesh garment;
  std::optional<Pattern> pattern;  // as read; none of a shape
  std::vector<Fabric> fabrics;     // [panel] with the scene's contact overrides
  std::vector<Vec2> rest_stretch;  // [panel] (b_u, b_v)
  std::vector<TimedPin> pins;      // on the particles of `garment`, of a cloth that is not sewn
  std::vector<TimedDrag> drags;    // likewise
  std::vector<OwnOfPanel> panels;  // of `garment`
  double edge_m = 0;               // that its triangles were asked to have
  std::vector<std::string> warnings;
};
// `read` gives the text of a pattern, which is added to `inputs`.  Errors of the mesher are given the name of the file, or the place of the
// shape.  Throws InputError for a panel or a label that the cloth does not have, and for what check_garment refuses.
LoadedCloth load_cloth(const Scene& scene, const SceneCloth& cloth, const TextSource& read, Hash& inputs);

// All that a scene names, read.
struct LoadedScene {
  std::vector<LoadedCloth> cloth;
  LoadedColliders colliders;
  std::optional<Outfit> start;     // how another run had draped the cloth, if this one begins there
  double cloth_s = 0, body_s = 0;  // wall time, for the report
};
// Adds every byte that it reads to `inputs`.  Throws what load_cloth, load_colliders and start_from throw.
LoadedScene load_scene(const Scene& scene, const TextSource& read, Hash& inputs);

struct PinnedParticle {
  std::size_t pin = 0;  // of the cloth
  Index particle = -1;  // of `x`
  template <class Archive>
  void remember(Archive& archive) {
    archive(pin, particle);
  }
};
// Which particles the cloth's pins hold, by where they are.  Throws InputError for a box with none in it, and for one that two pins hold at once.
std::vector<PinnedParticle> pinned_particles(const SceneCloth& cloth, std::span<const Vec3> x);
TimedPin timed_pin(const ScenePin& pin, Index particle);

// Sheets, tubes and ribbons that hang where they are drawn.
Outfit outfit_of_shapes(std::span<const LoadedCloth> cloth);
// What happens to the cloth in time, on the particles and panels of `outfit`, whose parts are the cloths in their order.
Events events_of(const Outfit& outfit, std::span<const LoadedCloth> cloth);
// Where labelled edges are held: as the cloth says; if it says nothing, the waist ("lower_interface") at the body's, unless the garment
// hangs from the shoulders: its waist is as low as it is cut, and held higher it would bunch.  The other labels of GarmentCode are held only where
// the cloth says (docs/theory/sewing.md#collars-and-strapless-tops); those that nobody knows are named in a warning.  Throws InputError for a height of a label that no edge carries.
std::vector<LabelHeight> label_heights_of(const SceneCloth& cloth, const GarmentMesh& garment, bool on_shoulders,
                                          const BodyFigures& body, std::vector<std::string>& warnings);
// How far above the body cloth of this edge length rests when nobody says: edges cut corners of the body, by e^2 / 8R.
double default_offset_m(double edge_m);
StepOptions step_options(const Scene& scene, double edge_m);

// Every number of the scene that changes the result; not its name, output or number of threads.
void add_to_hash(const Scene& scene, Hash& hash);

}  // namespace toile::internal
