// body/mannequin_form.hpp: all numbers of one mannequin: sections of its parts, joints, mesh and tape.
//
// A form is the data of a body; MannequinShape makes a field of it.  Every part is written for the left side (x > 0);
// the image follows.  Metres, y up, facing +z.  The numbers are ours: heights and girths near the middle of published
// anthropometric ranges [Gordon et al., 2012 Anthropometric Survey of U.S. Army Personnel, 2014], shapes by eye.
#pragma once
#include "body/implicit_shape.hpp"
#include "body/mannequin.hpp"

#include <vector>

namespace toile::internal {

struct MannequinForm {
  // Lofts: `trunk` (from the crotch to the root of the neck), `neck`, `face` (from under the chin to the forehead) and
  // `leg` (ankle to hip) by height; `foot` along z from heel to toes, u outwards and v up, cut at y = 0 later.
  std::vector<LoftSection> trunk, neck, face, leg, foot;
  // Along the arm's axis from the shoulder joint, 45 degrees below the horizontal; u across it and up, v forwards.
  std::vector<LoftSection> arm;
  Vec3 shoulder_m;                        // the joint, where the arm's axis begins
  double elbow_m, wrist_m, finger_tip_m;  // along it
  double elbow_z_m, wrist_z_m, hand_z_m;  // their offset in front of the axis
  std::array<Vec3, 3> thumb;              // root, knuckle, tip: along the arm, across, forwards
  std::array<double, 3> thumb_radius;

  Ellipsoid skull;
  RoundCone nose;
  Ellipsoid eye_socket;  // carved out
  RoundCone shoulder;    // the yoke from the neck to the joint
  Ellipsoid breast;      // or the muscle that stands there
  Ellipsoid buttock;

  struct Joints {  // of the middle and of the left leg; those of the arm follow from its axis
    Vec3 hips, spine, chest, neck, head, crown, collar, hip, knee, ankle, toes, toe_tips;
  } joints;

  struct Flesh {  // radii around the bones; the end radius of one is the first of the next; for skin weights only
    double hips, waist, ribs, neck_root, neck, head, collar, shoulder, elbow, wrist, finger_tips, hip, knee, ankle,
        ball, toe_tips;
  } flesh_m;

  struct Mesh {  // target edge lengths
    double body, hand, foot, head, nose;
    double foot_below, head_above;  // heights at which feet and head begin
    Vec3 nose_at;
    Vec3 low, high;  // a box around the left half
  } mesh;

  struct Range {
    double low, high;
  };
  struct Tape {  // ranges of height for each girth, and the height of the nape above the joint of the neck
    Range waist, bust, hips, neck;
    double acromion_from;  // x from which the search for the acromion starts
    double nape;
  } tape;
};

// A woman of 1.72 m with the proportions of a dress form.
const MannequinForm& woman_form();

// A man of 1.80 m: wide shoulders, flat chest, narrow hips.
const MannequinForm& man_form();

// The form of a kind; the dancer's is the woman's.
const MannequinForm& mannequin_form(MannequinKind kind);

}  // namespace toile::internal
