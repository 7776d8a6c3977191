#include "sim/torture/faulty_rig.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace hydro::torture {
namespace {

constexpr std::array kSensors{&model::Measurement::p1,          &model::Measurement::p2,
                              &model::Measurement::motor_speed, &model::Measurement::motor_angle,
                              &model::Measurement::arm_angle,   &model::Measurement::arm_speed};
// The reading of a saturated sensor, and the error of a lying sensor or a spike: psi, rad/s, rad, rad/s.
constexpr std::array kFullScale{3000.0, 3000.0, 2000.0, 1e6, 2.0, 20.0};
constexpr std::array kLie{150.0, -150.0, 40.0, 1.0, 0.05, 0.3};

void Apply(SensorFault& fault, model::Measurement* measured) {
  double& reading = measured->*kSensors[fault.sensor];
  switch (fault.kind) {
    case FaultKind::kSensorNan:
    case FaultKind::kBoardInput:
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

constexpr std::array kNames{"p1", "p2", "motor_speed", "motor_angle", "arm_angle", "arm_speed"};
constexpr int kGoodReadings = 10;  // BoardSensor::kGoodReadings

}  // namespace

FaultyRig::FaultyRig(const settings::StackConfig& config, const SimulatedProcess& process,
                     std::vector<SensorFault>& faults, BoardFaults* board, Observer& observer)
    : rig_(config), process_(process), faults_(faults), board_(board), observer_(observer) {
  if (board_ != nullptr) *board_ = {};
  good_readings_.fill(kGoodReadings);
}

// Reads the sensors as plant::DeviceRig does: a reading that is not credible counts as missing, and is a
// fault until ten readings in a row are good.
void FaultyRig::ReadBoard(model::Measurement* measured) {
  if (std::exchange(board_->refuses_reading, false))
    throw plant::RigError("board_error", "/dev/comedi0 (simulated): driver.p1: the board does not answer");
  if (std::exchange(board_->encoder_lost, false))
    throw plant::RigError("encoder_lost", "driver.motor_angle: the counter has jumped");
  board_faults_.clear();
  for (size_t sensor = 0; sensor < kSensorCount; ++sensor) {
    const bool bad = std::any_of(faults_.begin(), faults_.end(), [&](const SensorFault& fault) {
      return fault.kind == FaultKind::kBoardInput && fault.sensor == sensor;
    });
    good_readings_[sensor] = bad ? 0 : std::min(good_readings_[sensor] + 1, kGoodReadings);
    if (good_readings_[sensor] == kGoodReadings) continue;
    board_faults_.push_back({std::string("sensor_") + kNames[sensor], "the input is at an end of its range"});
  }
  for (SensorFault& fault : faults_) Apply(fault, measured);
}

model::Measurement FaultyRig::Read(int64_t tick) {
  model::Measurement measured = rig_.Read(tick);
  if (board_ != nullptr) {
    ReadBoard(&measured);
  } else {
    for (SensorFault& fault : faults_) Apply(fault, &measured);
  }
  tick_ = tick;
  observer_.OnRead(process_, tick, measured,
                   std::chrono::nanoseconds(process_.machine().Suspended()).count());
  return measured;
}

double FaultyRig::Drive(double voltage) {
  if (board_ != nullptr && std::exchange(board_->guardian_gone, false))
    throw plant::RigError("guardian_gone", "the guardian (hydro-zero) has ended");
  if (board_ != nullptr && std::exchange(board_->refuses_output, false))
    throw plant::RigError("board_error",
                          "/dev/comedi0 (simulated): driver.voltage: the board does not answer");
  const double driven = rig_.Drive(voltage);
  voltage_ = driven;
  observer_.OnDrive(process_, tick_, driven);
  return driven;
}

plant::OutputLeft FaultyRig::Zero() noexcept {
  if (board_ == nullptr || !board_->refuses_zero) return rig_.Zero();
  observer_.OnZeroRefused(process_);
  return {.accepted = false, .voltage = voltage_};
}

}  // namespace hydro::torture
