// Recursive Newton-Euler for links in a plane. A template, for .cc files of model/arm only.
#pragma once

#include "model/arm/arm_description.h"

namespace hydro::model {

// A number with its rate. With these instead of plain numbers, the recursion also gives the torques' rates.
struct Moving {
  double value = 0;
  double rate = 0;
};
inline Moving operator+(Moving x, Moving y) { return {x.value + y.value, x.rate + y.rate}; }
inline Moving operator-(Moving x, Moving y) { return {x.value - y.value, x.rate - y.rate}; }
inline Moving operator*(Moving x, Moving y) {
  return {x.value * y.value, x.rate * y.value + x.value * y.rate};
}
inline Moving operator*(double x, Moving y) { return {x * y.value, x * y.rate}; }

template <class T>
struct Planar {
  T x, y;
};

// The motion of link i, as numbers of type T: the cosine and sine of its direction, its joint's speed and
// acceleration.
template <class T>
struct LinkMotion {
  T cosine, sine;
  T speed, acceleration;
};

// `motion(i)` gives the LinkMotion of link i; `give(i, torque)` receives the torque of joint i. The outward
// pass computes the links' accelerations, with gravity as an acceleration of the base; the inward pass
// computes the forces and moments at the joints.
template <class T, class Motion, class Give>
void NewtonEuler(int links, const ArmLink* link, double gravity, const Motion& motion, const Give& give) {
  Planar<T> direction[kMostLinks];
  Planar<T> force[kMostLinks];  // mass times acceleration of the centre of mass
  T moment[kMostLinks];         // inertia times angular acceleration
  T turn{};                     // speed and acceleration of the link's direction
  T turn_rate{};
  Planar<T> joint{T{}, T{gravity}};  // acceleration
  for (int i = 0; i < links; ++i) {
    const LinkMotion<T> at = motion(i);
    turn = turn + at.speed;
    turn_rate = turn_rate + at.acceleration;
    direction[i] = {at.cosine, at.sine};
    // A point at distance 1 along the link has this acceleration relative to the joint.
    const T square = turn * turn;
    const Planar<T> along = {T{} - turn_rate * at.sine - square * at.cosine,
                             turn_rate * at.cosine - square * at.sine};
    const ArmLink& l = link[i];
    force[i] = {l.mass * (joint.x + l.centre * along.x), l.mass * (joint.y + l.centre * along.y)};
    moment[i] = l.inertia * turn_rate;
    joint = {joint.x + l.length * along.x, joint.y + l.length * along.y};
  }
  Planar<T> outer{T{}, T{}};  // force that the next joint needs from this link
  T torque{};
  for (int i = links - 1; i >= 0; --i) {
    const ArmLink& l = link[i];
    const Planar<T> lever = {l.centre * force[i].x + l.length * outer.x,
                             l.centre * force[i].y + l.length * outer.y};
    torque = torque + moment[i] + (direction[i].x * lever.y - direction[i].y * lever.x);
    outer = {outer.x + force[i].x, outer.y + force[i].y};
    give(i, torque);
  }
}

}  // namespace hydro::model
