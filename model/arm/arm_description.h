// A planar arm as data: what a reader of a configuration fills.
#pragma once

#include <vector>

namespace hydro::model {

// The most links of an arm.
inline constexpr int kMostLinks = 64;

// Units need only be coherent, and those of the joints' models; the paper's are given.
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

  // Throws ModelError for a value that no arm has: "arm.link 2: mass = -0.1; allowed is above 0". Links count
  // from 1, from the base.
  void Check() const;
};

}  // namespace hydro::model
