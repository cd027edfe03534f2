// dress/outfit_run.hpp: simulates an outfit from the weld of its last garment on: phase after phase (dress/phase.hpp) on one integrator, which
// keeps its contacts and their friction.  The next garment makes a new mesh, and a new run.
#pragma once
#include "assembly/air.hpp"
#include "dress/events.hpp"
#include "dress/label_springs.hpp"
#include "dress/outfit.hpp"
#include "dress/phase.hpp"
#include "dress/tangles.hpp"
#include "step/adaptive_step.hpp"

#include <functional>
#include <optional>
#include <span>

namespace toile::internal {

struct OutfitRunOptions {
  ModelOptions model;
  AirOptions air;
  StepOptions step;
  double fps = 30;
  std::optional<double> step_max_s;  // instead of the phases'
  std::function<bool()> stop;        // asked before every step; may be empty
};

// The last garment that was put on.
struct NewGarment {
  Index worn_before = 0;  // the number of particles of the garments worn before; they come first
  LabelSprings labels;    // hold it for a while
};

class OutfitRun {
 public:
  // `outfit` and `body` must outlive this object; the outfit's state and thickness are advanced in place.  `body` may be null.
  OutfitRun(const OutfitRunOptions& options, Outfit& outfit, BodySurface* body, NewGarment garment = {});
  OutfitRun(const OutfitRun&) = delete;
  OutfitRun& operator=(const OutfitRun&) = delete;

  // Starts a phase; its clock starts at 0, and the body stands.  Without any phase: as_drawn, with one step per frame.
  void begin(const Phase& phase);
  // Advances by one frame, or by another length.
  FrameReport frame() { return frame(1 / options_.fps); }
  FrameReport frame(double length_s);
  void set_events(Events events) { events_ = std::move(events); }
  const Events& events() const { return events_; }
  // Pins and hands may be added, removed and moved between two frames.
  Events& events() { return events_; }
  void set_gravity(const Vec3& m_per_s2) { gravity_m_per_s2_ = m_per_s2; }
  // For one collider, or for all without a value of their own.
  void set_friction(std::optional<Index> collider, double friction);
  void set_stiffness(Index panel, const StiffnessShare& share);
  void set_pressure(Index panel, double Pa);  // replaces that of the events
  void set_wind(const Vec3& m_per_s) { wind_m_per_s_ = m_per_s; }
  // Read by forces (dress/forces.hpp).
  const OutfitRunOptions& options() const { return options_; }
  const Vec3& wind_m_per_s() const { return wind_m_per_s_; }  // of the frame
  double grown() const { return ramped_; }  // share of elastic, and of all that is ramped up after the weld
  void push_tangles_gently(bool gently) { tangles_->push_gently(gently); }  // not part of the state
  // From the next frame on the body moves, from its present positions at 0 s.  The run no longer ends at rest.
  void start_motion(BodyAt body_at);
  double motion_from_s() const { return motion_start_s_; }

  // Of the phase.
  double time_s() const { return frames_from_s_ + static_cast<double>(frames_) * frame_s_; }
  // Gravity and elastic are in full.
  bool settled() const { return time_s() >= phase_.settled_s; }
  PhaseSeconds seconds() const { return stepper_->integrator().seconds() - seconds_before_; }  // of the phase
  const ClothModel& model() const { return model_; }
  double stored_in_contacts_J() const { return stepper_->integrator().contact_rows().stored_J(); }
  LayerGap layer_gap() { return stepper_->integrator().contact_rows().layer_gap(outfit_->state.x); }
  bool touches_body(Index particle) const {
    return stepper_->integrator().body_constraints().touch(particle) != Touch::none;
  }
  std::span<const Pin> pins() const { return world_.pins; }  // of the last frame

  // The state between frames (core/state_archive.hpp), without the outfit, which belongs to the owner.  Restore it after setting the events and, in a
  // run whose body moves, after start_motion.
  template <class Archive>
  void remember(Archive& archive) {
    std::vector<Vec2> b = panel_rest_stretch();
    archive.fixed(b);
    archive(frames_, frames_from_s_, frame_s_, gravity_m_per_s2_, wind_m_per_s_, motion_start_s_, without_room_,
            ramped_, seconds_before_, *tangles_, *stepper_, changed_);
    for (TimedPin& timed : events_.pins) archive(timed.pin.particle, timed.from, timed.pin.on_body);
    for (TimedDrag& timed : events_.drags) archive(timed.drag.particle, timed.drag.weight);
    if constexpr (Archive::reads) take_up(b);
  }

 private:
  std::vector<Vec2> panel_rest_stretch() const;  // [panel] of the model, as it is now
  void take_up(std::span<const Vec2> panel_rest_stretch);
  void share_out();
  void choose_steps();
  void choose_tolerance();
  bool is_slow() const;
  void set_rest_stretch(double share);
  void happen();
  void change_in_time(double end_s);
  void take_and_let_go();

  // Values set since the run began; absent: unchanged.
  struct Changed {
    std::optional<double> friction;
    std::vector<std::optional<double>> collider_friction;
    std::vector<std::optional<Vec3>> stiffness;      // [panel]
    std::vector<std::optional<double>> pressure_Pa;  // [panel]
    template <class Archive>
    void remember(Archive& archive) {
      archive(friction, collider_friction, stiffness, pressure_Pa);
    }
  };

  OutfitRunOptions options_;
  Outfit* outfit_;
  NewGarment garment_;
  std::vector<Pin> worn_pins_;  // hold the garments worn before
  ClothModel model_;
  StepWorld world_;
  Phase phase_;
  PhaseSeconds seconds_before_;
  std::optional<Tangles> tangles_;
  long without_room_ = 0;  // last read count of steps with a pinch without room (step/flypaper.hpp)
  double label_strength_ = 0, motion_start_s_ = 0, ramped_ = -1;
  BodyAt motion_;
  Changed changed_;
  Events events_;
  Vec3 gravity_m_per_s2_{0, 0, 0};  // at its full value
  Vec3 wind_m_per_s_{0, 0, 0};
  long frames_ = 0;  // of one length, since
  double frames_from_s_ = 0, frame_s_ = 0;
  std::optional<AdaptiveStep> stepper_;
};

}  // namespace toile::internal
