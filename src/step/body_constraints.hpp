// step/body_constraints.hpp: cloth particles on a body: held, sliding or free, decided by constraint forces.   (L1) [BW98 5.4, 6]
//
//   touching   a particle whose gap, predicted with v + h g and the body's motion, is below the offset r
//   slides     S = I - n n^T,  z = n.(v_body - v) n,  plus the kinetic force -mu_k lambda_n t
//   sticks     S = 0,          z = v_body - v                    while |lambda_t| <= mu_s lambda_n
//   y          position alteration: min(r - gap, 0.2 r) n, zero while 0 <= r - gap < 0.02 r; negative lets a predicted contact land exactly
//              on the offset.  It moves the particle and tells its neighbours through K y, and is never part of v.
//   release    lambda_n < 0: the body would have to pull.  Within the same step (the paper: in the next), once per particle and step.
//
// lambda = e / h is read from the residual e = A dv - b of the solve.
#pragma once
#include "assembly/cloth_model.hpp"
#include "constraint/particle_constraints.hpp"
#include "contact/proximity.hpp"

#include <span>
#include <vector>

namespace toile {

struct BodyContactOptions {
  double offset_m = 2.5e-3;        // r: where cloth rests above the body
  double friction = 0.4;           // mu; kinetic, static is 2 % larger
};

enum class Touch : std::uint8_t { none, slides, sticks };

class BodyConstraints {
 public:
  BodyConstraints(const ClothModel& model, const BodySurface* body, const BodyContactOptions& options);

  // L0: nearest body point of every particle that can reach the body within h_s.
  void detect(const ClothState& state, double h_s);

  // The active set with which a step of h_s begins.
  void begin(const ClothState& state, double h_s);
  // Adds S, z of the touching particles; fills y (others zero) and the kinetic friction forces f (N).  Particles that `constraints`
  // already holds are left to their pins.
  void apply(const ClothState& state, double h_s, ParticleConstraints& constraints, std::span<Vec3> y, std::span<Vec3> friction_N);
  // After a solve: releases, adds, and switches stick and slip.  Returns how many particles changed; 0: the set is consistent.
  // `first_passes`: releases are allowed.
  int update(const ClothState& state, std::span<const Vec3> dv, std::span<const Vec3> e, double h_s, bool first_passes);
  // After an accepted step: remembers forces and modes for the next.
  void accept();

  bool any_near() const { return !near_.empty(); }
  int touching() const;
  Touch touch(Index particle) const { return touch_[static_cast<std::size_t>(particle)]; }
  double normal_force_N(Index particle) const { return lambda_n_[static_cast<std::size_t>(particle)]; }
  void set_friction(double friction) { options_.friction = friction; }
  const BodyContactOptions& options() const { return options_; }

 private:
  struct Near {                    // a particle within reach of the body
    Index particle;
    BodyPoint point;
    Vec3 body_travel;              // of the contact's material point over the step, m
    Vec3 slip_direction{0, 0, 0};  // unit tangent, or zero
    Touch touch = Touch::none;
    bool released = false, pinned = false;
    int switches = 0;
    double lambda_n = 0;           // N
  };
  void touch_down(Near& near, const Vec3& v, double h_s) const;
  double alteration(const Near& near) const;

  const ClothModel* model_;
  const BodySurface* body_;
  BodyContactOptions options_;
  std::vector<BodyPoint> points_;  // [particle] scratch of detect
  std::vector<Near> near_;         // ascending particles
  std::vector<Touch> touch_;       // [particle] at the end of the last accepted step
  std::vector<double> lambda_n_;   // [particle] N, likewise
};

}  // namespace toile
