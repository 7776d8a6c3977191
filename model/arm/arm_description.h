// A planar arm as data, filled from a configuration.
#pragma once

#include <vector>

namespace hydro::model {

// The largest number of links.
inline constexpr int kMostLinks = 64;

// Units only need to be coherent, and equal to those of the joints' models. The comments give the paper's
// units.
struct ArmLink {
  double mass = 0;     // lbf-s^2/in
  double length = 0;   // in, from this link's joint to the next joint, the last one's to the tip
  double centre = 0;   // in, from the joint to the centre of mass, along the link; below 0: behind the joint
  double inertia = 0;  // in-lbf-s^2, about the centre of mass
  double angle = 0;  // rad, from the link before (the first: from the horizontal) to this one where alpha = 0
};

// Revolute joints in one vertical plane, from the base outwards. Joint i turns link i against link i - 1.
struct ArmDescription {
  double gravity = 0;  // in/s^2, down; 0: the plane is horizontal
  double payload = 0;  // lbf-s^2/in, a point mass at the tip
  std::vector<ArmLink> links = {};

  // Throws ModelError for an impossible value: "arm.link 2: mass = -0.1; allowed is above 0". Links count
  // from 1, starting at the base.
  void Check() const;
};

}  // namespace hydro::model
