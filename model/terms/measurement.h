// What is told of an actuator at one instant: what its sensors read, what surrounds it, where its power goes.
#pragma once

#include <array>
#include <cstddef>

namespace hydro::model {

// What the sensors would read without noise, in the model's units. T is double, or a scalar with derivatives.
template <class T>
struct MeasurementOf {
  T motor_angle{};
  T motor_speed{};
  T arm_angle{};
  T arm_speed{};
  T p1{};
  T p2{};
};
using Measurement = MeasurementOf<double>;

// The sensors, in the order of Measurement.
enum class Channel { kMotorAngle, kMotorSpeed, kArmAngle, kArmSpeed, kP1, kP2 };
inline constexpr size_t kChannels = 6;
using ChannelSet = std::array<bool, kChannels>;

template <class T>
const T& ChannelOf(const MeasurementOf<T>& measured, size_t channel) {
  const T* const all[kChannels] = {&measured.motor_angle, &measured.motor_speed, &measured.arm_angle,
                                   &measured.arm_speed,   &measured.p1,          &measured.p2};
  return *all[channel];
}

// Outside influences on an actuator that may be measured beside it.
struct Surroundings {
  // In the direction of alpha, in-lbf, or a force for a linear arm: what pushes the arm in addition to its
  // weight.
  double arm_force = 0;
  double temperature = 20;  // degC, of the oil: a machine that nobody has warmed up

  bool operator==(const Surroundings&) const = default;
};

// The power balance of eqs. (4), (13), (14), (15) at one instant: where the power goes.
//
// in-lbf/s in the paper's units. in + shaft_in = stored() + dissipated() + mismatch, exactly.
//
// Pressures count from p_3: fluid that passes a valve at p_3, or leaks to the accumulator, carries no power.
// Compression is (p - p_3) V p'/beta, the rate of the energy that eq. (5) with constant beta stores.
struct Power {
  double in = 0;        // T_p theta'
  double shaft_in = 0;  // from whatever drives a driven shaft: -k_2 dp alpha'

  double kinetic = 0;      // rate of J theta'^2/2 + J_a alpha'^2/2
  double compression = 0;  // rate of energy stored in the fluid
  double gravity = 0;      // rate of m g l sin(alpha)
  double effects_stored = 0;

  double viscous = 0;  // b theta'^2 and other smooth loads
  double coulomb = 0;  // friction that acts against the direction of slip
  double leakage = 0;  // c_I dp^2 + c_E ((p1 - p_3)^2 + (p2 - p_3)^2)
  double effects_dissipated = 0;

  // (c - k_2) dp alpha'. Eqs. (13), (14) take c dp alpha' from the fluid, and eq. (15) gives k_2 dp alpha' to
  // the arm. The paper's c = 3.68379 and k_2 = 3.68 differ, and the difference is lost (or gained) between
  // the two.
  double mismatch = 0;

  double stored() const { return kinetic + compression + gravity + effects_stored; }
  double dissipated() const { return viscous + coulomb + leakage + effects_dissipated; }
};

}  // namespace hydro::model
