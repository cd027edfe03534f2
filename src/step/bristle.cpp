#include "step/bristle.hpp"

#include "step/tangents.hpp"

namespace toile::internal {
namespace {

constexpr int most_turns = 2;  // slip and stick do not alternate without end

}  // namespace

void Bristle::carry_on(const Vec3& n, double k_t_N_per_m) {
  const double length = stretch_m_.norm();
  if (length > 0) {
    const Vec3 turned = stretch_m_ - n.dot(stretch_m_) * n;
    const double left = turned.norm();
    stretch_m_ = left > 0 ? Vec3((length / left * stiffness_N_per_m_ / k_t_N_per_m) * turned) : Vec3::Zero();
  }
  stiffness_N_per_m_ = k_t_N_per_m;
  turned_back_ = 0;
  state_ = State::free;
}

bool Bristle::decide(const Vec3& u_m, double cone_N) {
  const Vec3 d = stretch_m_ + u_m;
  const bool turned_back = slips() && d.dot(along_) <= 0;
  turned_back_ += turned_back ? 1 : 0;
  way_m_ = d.norm();
  cone_N_ = cone_N;
  state_ = State::free;
  if (!(cone_N > 0)) return turned_back;
  const bool held = turned_back || turned_back_ >= most_turns;
  state_ = stiffness_N_per_m_ * way_m_ > cone_N && !held ? State::slips : State::sticks;
  if (slips()) along_ = d / way_m_;
  return turned_back;
}

void Bristle::take_over(const Vec3& friction_N, double cone_N) {
  stretch_m_ = Vec3::Zero();
  end(-friction_N / stiffness_N_per_m_, cone_N);
}

void Bristle::end(const Vec3& u_m, double cone_N) {
  stretch_m_ += u_m;
  const double longest = cone_N / stiffness_N_per_m_, length = stretch_m_.norm();
  if (length > longest) stretch_m_ *= longest / length;
}

void Bristle::append_springs(const LinearSpring& contact, const Vec3& travel_m, double damping_s,
                             std::vector<LinearSpring>& springs) const {
  if (state_ == State::free) return;
  const auto add = [&](const Vec3& t, double force_N, double stiffness_N_per_m, double damping_N_s_per_m) {
    LinearSpring spring = contact;
    spring.direction = t;
    spring.force_N = force_N;
    spring.stiffness_N_per_m = stiffness_N_per_m;
    spring.damping_N_s_per_m = damping_N_s_per_m;
    spring.body_displacement_m = t.dot(travel_m);
    springs.push_back(spring);
  };
  if (slips()) {
    // The normal may have turned since the motion was measured.
    const Vec3& n = contact.direction;
    const Vec3 t = (along_ - n.dot(along_) * n).normalized(), across = n.cross(t);
    const double k = cone_N_ / way_m_;
    add(t, -cone_N_, 0, 0);
    add(across, -k * across.dot(stretch_m_), k, 0);
    return;
  }
  for (const Vec3& t : tangents(contact.direction))
    add(t, -stiffness_N_per_m_ * t.dot(stretch_m_), stiffness_N_per_m_, damping_s * stiffness_N_per_m_);
}

}  // namespace toile::internal
