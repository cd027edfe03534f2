// api/implementation.hpp: the implementation of toile::Simulation.
#pragma once
#include "api/parts.hpp"
#include "core/parallel.hpp"
#include "sim/simulation.hpp"
#include "toile/simulation.hpp"

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace toile {

struct Simulation::Implementation : internal::SimulationObserver {
  // The inputs of a simulation, from which it may be made again.
  struct Recipe {
    Recipe(internal::SceneFile made_of, SimulationOptions made_options);
    SimulationOptions options;
    internal::Scene scene;
    internal::JsonPlaces places;
    internal::LoadedScene loaded;
    std::uint64_t input_hash = 0;

    // Errors name their place in the scene's file, if there is one.
    template <class Work>
    void in_threads(const Work& work) const {
      places.complete_errors_of([&] {
        if (options.threads > 0)
          internal::with_threads(options.threads, work);
        else
          work();
      });
    }
  };
  explicit Implementation(std::shared_ptr<const Recipe> made_of) : recipe(std::move(made_of)) {}

  // A straight motion during the next advance().
  struct Way {
    internal::Vec3 from, to;
    template <class Archive>
    void remember(Archive& archive) {
      archive(from, to);
    }
  };
  struct Held {
    internal::Index particle = -1;
    Way way;
    std::optional<internal::BodyAttachment> on_body = {};  // instead of the way
    template <class Archive>
    void remember(Archive& archive) {
      archive(particle, way, on_body);
    }
  };
  struct Hand {
    std::int32_t number = 0;
    std::array<internal::Index, 3> particle{-1, -1, -1};
    std::array<double, 3> weight{1, 0, 0};
    double stiffness_N_per_m = 0, damping_N_s_per_m = 0, max_force_N = 0;
    Way way;
    template <class Archive>
    void remember(Archive& archive) {
      archive(number, particle, weight, stiffness_N_per_m, damping_N_s_per_m, max_force_N, way);
    }
  };
  // The caller's changes to the cloth and the body, beside the scene's.
  struct Interaction {
    std::vector<Held> held;   // by particle
    std::vector<Hand> hands;  // by number
    std::int32_t hands_ever = 0;
    std::vector<internal::Vec3> body_from, body_to;  // empty: the caller has not moved it
    double from_s = 0, length_s = 1;                 // of the next advance(), or of the last
    bool moves = false;                              // the body has begun to move
    double moves_from_s = 0;
    template <class Archive>
    void remember(Archive& archive) {
      archive(held, hands, hands_ever, body_from, body_to, from_s, length_s, moves, moves_from_s);
    }
  };

  void make();  // the state after construction; no sewn garment is on
  // Instead of make(): restores the state saved in `bytes`.  Throws internal::InputError.
  void take_up(std::string_view bytes);
  void make_engine();
  // If `work` throws, resets everything by make().
  template <class Work>
  void unless_it_throws(const Work& work) {
    try {
      recipe->in_threads(work);
    } catch (...) {
      make();
      throw;
    }
  }
  void begin();  // the garments that are on hang from now on
  void begins(const internal::OutfitRun& run);
  // Throws unless all garments are on.
  internal::OutfitRun& live(std::string_view what);
  internal::Vec3 along(const Way& way, double t_s) const;
  void tell(internal::OutfitRun& run);          // of the interaction
  void start_motion(internal::OutfitRun& run);  // if it is due and has not begun
  void lead_body(internal::OutfitRun& run);
  void lead(double since_s, std::span<internal::Vec3> x) const;
  const internal::JoinedColliders::Part& collider(int number) const;  // throws if there is none
  void update_body();
  void arrived();  // at the end of an advance()
  DressReport report();
  void judge(DressReport& report);

  const internal::ClothMesh& mesh() const { return begun ? engine->live().model().mesh : flat.mesh; }
  const internal::ClothState& state() const { return begun ? engine->outfit().state : flat.state; }

  std::shared_ptr<const Recipe> recipe;
  std::unique_ptr<internal::Simulation> engine;
  bool begun = false;
  bool making = false;    // and must not be stopped
  internal::Outfit flat;  // the panels, until `begun`
  std::size_t scene_pins = 0, scene_drags = 0;
  Interaction interaction;
  std::vector<internal::Vec3> body_x;
};

}  // namespace toile
