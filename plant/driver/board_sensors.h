// All measured signals of a rig.
#pragma once

#include <array>

#include "bus/clock.h"
#include "model/actuator.h"
#include "plant/driver/board_sensor.h"

namespace hydro::plant {

class BoardSensors {
 public:
  // Throws InputError when the board lacks a channel.
  BoardSensors(ComediBoard& board, const settings::DriverSection& section, const bus::Clock& clock);

  // Reads every input once. Throws RigError.
  model::Measurement Read();

  std::array<const BoardSensor*, 6> all() const {
    return {&p1_, &p2_, &motor_angle_, &motor_speed_, &arm_angle_, &arm_speed_};
  }

 private:
  BoardSensor p1_;
  BoardSensor p2_;
  BoardSensor motor_angle_;
  BoardSensor motor_speed_;
  BoardSensor arm_angle_;
  BoardSensor arm_speed_;
};

}  // namespace hydro::plant
