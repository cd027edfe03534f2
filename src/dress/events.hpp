// dress/events.hpp: events that act on the cloth, at times since the first frame.
#pragma once
#include "dress/keyed.hpp"
#include "dress/rigid_path.hpp"
#include "step/drag.hpp"
#include "step/implicit_euler.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

namespace toile::internal {

struct TimedPin {
  Pin pin;
  double from_s = 0, to_s = std::numeric_limits<double>::infinity();
  RigidPath moves;           // optional, relative to the particle's position when it is grabbed
  std::optional<Vec3> from;  // the preimage under `moves` of its position when it was grabbed
  bool on_body = false;      // the body carries it, from its position when it is grabbed
};
struct TimedDrag {  // a hand that holds the cloth from from_s to to_s
  Drag drag;
  double from_s = 0, to_s = 0;
  Vec3 near_m{0, 0, 0};  // it grabs the particle nearest to this place
};
struct PanelInTime {
  std::vector<RestStretchKey> rest_stretch_path;
  std::vector<StiffnessKey> stiffness_path;
  double pressure_Pa = 0;
  std::vector<PressureKey> pressure_path;  // replaces the constant
  bool empty() const {
    return rest_stretch_path.empty() && stiffness_path.empty() && pressure_Pa == 0 && pressure_path.empty();
  }
};
struct TimedPanel {
  Index panel = 0;
  PanelInTime own;
};
struct TimedFriction {
  std::optional<Index> collider;  // absent: all without a value of their own
  std::vector<FrictionKey> keys;
};
struct Events {
  std::vector<TimedPin> pins;
  std::vector<TimedDrag> drags;
  std::vector<TimedPanel> panels;
  std::vector<TimedFriction> friction;
  std::vector<VectorKey> gravity, wind;  // m/s^2, m/s; empty: constant
  // Nothing but gravity, air and the body acts on the cloth.
  bool empty() const {
    return pins.empty() && drags.empty() && friction.empty() && gravity.empty() && wind.empty() &&
           std::all_of(panels.begin(), panels.end(), [](const TimedPanel& panel) { return panel.own.empty(); });
  }
};

}  // namespace toile::internal
