#include "plant/driver/board_sensors.h"

namespace hydro::plant {

BoardSensors::BoardSensors(ComediBoard& board, const settings::DriverSection& section,
                           const bus::Clock& clock)
    : p1_(board, clock, "p1", section.p1),
      p2_(board, clock, "p2", section.p2),
      motor_angle_(board, clock, "motor_angle", section.motor_angle),
      motor_speed_(board, clock, "motor_speed", section.motor_speed, &motor_angle_),
      arm_angle_(board, clock, "arm_angle", section.arm_angle),
      arm_speed_(board, clock, "arm_speed", section.arm_speed, &arm_angle_) {}

model::Measurement BoardSensors::Read() {
  model::Measurement measured;
  measured.p1 = p1_.Read();
  measured.p2 = p2_.Read();
  measured.motor_angle = motor_angle_.Read();
  measured.motor_speed = motor_speed_.Read();
  measured.arm_angle = arm_angle_.Read();
  measured.arm_speed = arm_speed_.Read();
  return measured;
}

}  // namespace hydro::plant
