// dress/events.hpp: what happens to cloth, or around it, at times that count from the first frame.
#pragma once
#include "dress/keyed.hpp"
#include "dress/rigid_path.hpp"
#include "step/drag.hpp"
#include "step/implicit_euler.hpp"

#include <limits>
#include <optional>
#include <vector>

namespace toile::internal {

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
struct PanelInTime {
  std::vector<RestStretchKey> rest_stretch_path;
  std::vector<StiffnessKey> stiffness_path;
  double pressure_Pa = 0;
  std::vector<PressureKey> pressure_path;  // takes the constant's place
};
struct TimedPanel {
  Index panel = 0;
  PanelInTime own;
};
struct TimedFriction {
  std::optional<Index> collider;  // absent: of all that have none of their own
  std::vector<FrictionKey> keys;
};
struct Events {
  std::vector<TimedPin> pins;
  std::vector<TimedDrag> drags;
  std::vector<TimedPanel> panels;
  std::vector<TimedFriction> friction;
  std::vector<VectorKey> gravity, wind;  // m/s^2, m/s; empty: constant
};

}  // namespace toile::internal
