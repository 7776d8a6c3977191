#include "torture/faulty_rig.h"

#include <limits>

namespace hydro::torture {
namespace {

constexpr std::array kSensors{&model::Measurement::p1,          &model::Measurement::p2,
                              &model::Measurement::motor_speed, &model::Measurement::motor_angle,
                              &model::Measurement::arm_angle,   &model::Measurement::arm_speed};
// What a saturated sensor shows, and by how much a lying one or a spike is wrong: psi, rad/s, rad, rad/s.
constexpr std::array kFullScale{3000.0, 3000.0, 2000.0, 1e6, 2.0, 20.0};
constexpr std::array kLie{150.0, -150.0, 40.0, 1.0, 0.05, 0.3};

void Apply(SensorFault& fault, model::Measurement* measured) {
  double& reading = measured->*kSensors[fault.sensor];
  switch (fault.kind) {
    case FaultKind::kSensorNan:
      reading = std::numeric_limits<double>::quiet_NaN();
      break;
    case FaultKind::kSensorStick:
      if (!fault.began) fault.held = reading;
      reading = fault.held;
      break;
    case FaultKind::kSensorSaturate:
      reading = kFullScale[fault.sensor];
      break;
    case FaultKind::kSensorSpike:
      reading += 5 * kLie[fault.sensor];
      break;
    case FaultKind::kSensorLie:
    default:
      reading += kLie[fault.sensor];
      break;
  }
  fault.began = true;
}

}  // namespace

model::Measurement FaultyRig::Read(int64_t tick) {
  model::Measurement measured = rig_.Read(tick);
  for (SensorFault& fault : faults_) Apply(fault, &measured);
  tick_ = tick;
  observer_.OnRead(process_, tick, measured,
                   std::chrono::nanoseconds(process_.machine().Suspended()).count());
  return measured;
}

double FaultyRig::Drive(double voltage) {
  const double driven = rig_.Drive(voltage);
  observer_.OnDrive(process_, tick_, driven);
  return driven;
}

}  // namespace hydro::torture
