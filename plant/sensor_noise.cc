#include "plant/sensor_noise.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"

namespace hydro::plant {

double StandardNormal(uint64_t seed, int64_t tick, int channel) {
  return hydro::StandardNormal(Scatter(Scatter(seed) ^ static_cast<uint64_t>(tick)) +
                               static_cast<uint64_t>(channel));
}

bool ReadsExactly(const settings::NoiseSection& noise) {
  return std::max({noise.p1_psi, noise.p1_resolution_psi, noise.p2_psi, noise.p2_resolution_psi,
                   noise.motor_angle_rad, noise.motor_angle_resolution_rad, noise.motor_speed_rad_s,
                   noise.motor_speed_resolution_rad_s, noise.arm_angle_rad, noise.arm_angle_resolution_rad,
                   noise.arm_speed_rad_s, noise.arm_speed_resolution_rad_s}) <= 0;
}

model::Measurement ReadSensors(const model::Measurement& measurement, const settings::NoiseSection& noise,
                               int64_t seed, int64_t tick) {
  model::Measurement reading = measurement;
  int channel = 0;
  const auto read = [&](double& signal, double standard_deviation, double resolution) {
    if (standard_deviation > 0) {
      signal += standard_deviation * StandardNormal(static_cast<uint64_t>(seed), tick, channel);
    }
    if (resolution > 0) signal = std::round(signal / resolution) * resolution;
    ++channel;
  };
  read(reading.p1, noise.p1_psi, noise.p1_resolution_psi);
  read(reading.p2, noise.p2_psi, noise.p2_resolution_psi);
  read(reading.motor_angle, noise.motor_angle_rad, noise.motor_angle_resolution_rad);
  read(reading.motor_speed, noise.motor_speed_rad_s, noise.motor_speed_resolution_rad_s);
  read(reading.arm_angle, noise.arm_angle_rad, noise.arm_angle_resolution_rad);
  read(reading.arm_speed, noise.arm_speed_rad_s, noise.arm_speed_resolution_rad_s);
  return reading;
}

}  // namespace hydro::plant
