// sim/setup.hpp: from a scene to cloth and body in memory, before anything moves.
#pragma once
#include "assembly/cloth_model.hpp"
#include "dress/keyed.hpp"
#include "dress/outfit.hpp"
#include "dress/outfit_run.hpp"
#include "garment/pattern_figures.hpp"
#include "sim/colliders.hpp"
#include "sim/scene.hpp"
#include "step/implicit_euler.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace toile::internal {

// A cloth of the scene, with the fabrics of its panels, its pins and drags.
struct LoadedCloth : MeshedCloth {
  std::vector<Fabric> fabrics;     // [panel] with the scene's contact overrides
  std::vector<Vec2> rest_stretch;  // [panel] (b_u, b_v)
  std::vector<TimedPin> pins;      // on the particles of `garment`, if it is not sewn
  std::vector<TimedDrag> drags;    // likewise
  std::vector<TimedPanel> panels;  // of `garment`
};
// Loads scene.cloth[k]; `read` gives the texts of its files.  Throws as mesh_cloth, and InputError for a panel or a label that the cloth does
// not have.
LoadedCloth load_cloth(const Scene& scene, std::size_t k, const TextSource& read);

// All inputs of a scene, read.
struct LoadedScene {
  std::vector<LoadedCloth> cloth;
  LoadedColliders colliders;
  std::optional<Outfit> start;     // the cloth as another run draped it, if this one begins there
  std::uint64_t start_hash = 0;    // likewise, of that run
  double cloth_s = 0, body_s = 0;  // wall time, for the report
};
// Throws as load_cloth, load_colliders and start_from.
LoadedScene load_scene(const Scene& scene, const TextSource& read);

struct PinnedParticle {
  std::size_t pin = 0;  // of the cloth
  Index particle = -1;  // of `x`
  template <class Archive>
  void remember(Archive& archive) {
    archive(pin, particle);
  }
};
// The pinned particles of scene.cloth[k], by their positions.  Throws InputError for a box without particles, and for a particle with two pins
// at once.
std::vector<PinnedParticle> pinned_particles(const Scene& scene, std::size_t k, std::span<const Vec3> x);
TimedPin timed_pin(const ScenePin& pin, Index particle);

// Cloth that is not sewn and hangs where it is placed.
Outfit outfit_of_shapes(std::span<const LoadedCloth> cloth);
// The changes of the cloth over time, for the particles and panels of `outfit`, whose parts are the cloths in their order.
Events events_of(const Scene& scene, const Outfit& outfit, std::span<const LoadedCloth> cloth);
// The heights of labelled edges: as the cloth says; if it says nothing, the waist ("lower_interface") is at the body's, unless the garment
// hangs from the shoulders: its waist is as low as it is cut, and would bunch if held higher.  The other labels of GarmentCode are held
// only where the cloth says (docs/theory/sewing.md#collars-and-strapless-tops); unknown labels are named in a warning.  Throws InputError
// for a height of a label that no edge has.
std::vector<LabelHeight> label_heights_of(const SceneCloth& cloth, const GarmentMesh& garment, bool on_shoulders,
                                          const BodyFigures& body, std::vector<std::string>& warnings);
// The default distance at which cloth of this edge length rests on a collider: edges cut corners, those of skin by e^2 / 8R, and rims of solids
// by more.
double default_offset_m(const SceneCollider& collider, double edge_m);
StepOptions step_options(const Scene& scene, double edge_m);
// Settings that change over time are as at the start.
OutfitRunOptions run_options(const Scene& scene, const StepOptions& step, std::function<bool()> stop = {});

// The hash of every setting of the scene that changes the result; not of its name, output or number of threads.
std::uint64_t settings_hash(const Scene& scene);
// The hash of those settings and of all files read: `input_hash` of a report.
std::uint64_t input_hash(const Scene& scene, const LoadedScene& loaded);

}  // namespace toile::internal
