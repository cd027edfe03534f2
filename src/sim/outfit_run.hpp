// sim/outfit_run.hpp: an outfit in time: it settles after the weld, comes to rest, and follows the body.
//
//   after a weld   0.2 s weightless, 0.3 s in which gravity and elastic grow; what was worn before is held that long.
//                  A single garment slips on the body for 1 s before friction holds it; labels let go between 0.5 and 1 s.
//   then           as the scene says.  start_motion() lets the body move from the next frame on.
//
// Where rest is awaited, steps are twice as long until then, and slow motion is solved for more exactly; once nearly all is slow, every step is.
#pragma once
#include "garment/label_heights.hpp"
#include "sim/outfit.hpp"
#include "sim/scene.hpp"
#include "sim/tangles.hpp"
#include "step/adaptive_step.hpp"

#include <functional>
#include <limits>
#include <optional>
#include <span>

namespace toile::internal {

struct Settling {            // of a garment that has just been sewn
  bool sewn = false;         // false: nothing to settle (a grid, or a drape that is taken up again)
  Index held_particles = 0;  // worn before
  LabelSprings labels;       // hold the new garment for a while
  bool to_rest = false;      // it is awaited, until the body moves
  bool waits = false;        // at the weld, held by its labels, however long it takes until it is on
  bool weightless = false;   // meanwhile
};

struct TimedPin {
  Pin pin;
  double from_s = 0, to_s = std::numeric_limits<double>::infinity();
  RigidPath moves;           // if any, from where the particle is when it is taken
  std::optional<Vec3> from;  // where it would have been before the moves began; once it is taken
  bool on_body = false;      // it goes where the body takes it, from where it is when it is taken
};
struct TimedDrag {  // a hand that holds the cloth for a while
  Drag drag;
  double from_s = 0, to_s = 0;
  Vec3 near_m{0, 0, 0};  // it takes the particle nearest to this place
};
struct OwnOfPanel {  // all that the scene says of one panel
  Index panel = 0;
  ScenePanel own;
};
struct Events {  // times count from the first frame
  std::vector<TimedPin> pins;
  std::vector<TimedDrag> drags;
  std::vector<OwnOfPanel> panels;
};

class OutfitRun {
 public:
  // `outfit` and `scene` must outlive this object; the outfit's state and thickness are advanced in place.  `body` may be null.
  OutfitRun(const Scene& scene, Outfit& outfit, BodySurface* body, const StepOptions& step, Settling settling,
            std::function<bool()> stop);
  static constexpr double settling_s = 0.5;  // until gravity and elastic are full
  OutfitRun(const OutfitRun&) = delete;
  OutfitRun& operator=(const OutfitRun&) = delete;

  // Advances by one frame of the scene, or by another length.
  FrameReport frame() { return frame(1 / scene_->fps); }
  FrameReport frame(double length_s);
  void set_events(Events events) { events_ = std::move(events); }
  const Events& events() const { return events_; }
  // Between two frames pins and hands may come, go and be led elsewhere.
  Events& events() { return events_; }
  void set_gravity(const Vec3& m_per_s2) { gravity_m_per_s2_ = m_per_s2; }
  // Of one collider, or of all that have none of their own.
  void set_friction(std::optional<Index> collider, double friction);
  void set_stiffness(Index panel, const StiffnessShare& share);
  void set_pressure(Index panel, double Pa);  // in place of what the scene says of it
  void set_wind(const Vec3& m_per_s) { wind_m_per_s_ = m_per_s; }
  // What forces ask (sim/forces.hpp).
  const Scene& scene() const { return *scene_; }
  const Vec3& wind_m_per_s() const { return wind_m_per_s_; }  // of the frame
  double grown() const { return ramped_; }  // share of elastic, and of whatever else grows after the weld
  // From the next frame on the body moves: at 0 s it is where it is now.
  void start_motion(BodyAt body_at);
  double motion_from_s() const { return motion_start_s_; }

  double time_s() const { return frames_from_s_ + static_cast<double>(frames_) * frame_s_; }
  // Gravity, elastic and friction are what the scene says.
  bool settled() const;
  PhaseSeconds seconds() const { return stepper_->integrator().seconds(); }
  const ClothModel& model() const { return model_; }
  double stored_in_contacts_J() const { return stepper_->integrator().contact_rows().stored_J(); }
  LayerGap layer_gap() { return stepper_->integrator().contact_rows().layer_gap(outfit_->state.x); }
  bool touches_body(Index particle) const {
    return stepper_->integrator().body_constraints().touch(particle) != Touch::none;
  }
  std::span<const Pin> pins() const { return world_.pins; }  // of the last frame

  // What outlives a frame (core/state_archive.hpp), without the outfit, which is its owner's.  To be read back once the events are set and, of a run
  // whose body moves, start_motion has been called.
  template <class Archive>
  void remember(Archive& archive) {
    std::vector<Vec2> b = panel_rest_stretch();
    archive.fixed(b);
    archive(frames_, frames_from_s_, frame_s_, gravity_m_per_s2_, wind_m_per_s_, motion_start_s_, without_room_,
            ramped_, *tangles_, *stepper_, changed_);
    for (TimedPin& timed : events_.pins) archive(timed.pin.particle, timed.from, timed.pin.on_body);
    for (TimedDrag& timed : events_.drags) archive(timed.drag.particle, timed.drag.weight);
    if constexpr (Archive::reads) take_up(b);
  }

 private:
  std::vector<Vec2> panel_rest_stretch() const;  // [panel] of the model, as it is now
  void take_up(std::span<const Vec2> panel_rest_stretch);
  void settle();
  void choose_steps();
  void choose_tolerance();
  bool is_slow() const;
  void set_rest_stretch(double share);
  void happen();
  void change_in_time(double end_s);
  void take_and_let_go();

  // What was set since the run began; absent: the scene's.
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

  const Scene* scene_;
  Outfit* outfit_;
  Settling settling_;
  std::vector<Pin> worn_pins_;  // hold what was worn before
  StepOptions step_;
  ClothModel model_;
  StepWorld world_;
  std::optional<Tangles> tangles_;
  long without_room_ = 0;  // steps in which the body let cloth pass (step/flypaper.hpp), by the last look
  double label_strength_ = 0, motion_start_s_ = 0, ramped_ = -1;
  BodyAt motion_;
  Changed changed_;
  Events events_;
  Vec3 gravity_m_per_s2_{0, 0, 0};  // when it has grown to all of it
  Vec3 wind_m_per_s_{0, 0, 0};
  long frames_ = 0;  // of one length, since
  double frames_from_s_ = 0, frame_s_ = 0;
  std::optional<AdaptiveStep> stepper_;
};

}  // namespace toile::internal
