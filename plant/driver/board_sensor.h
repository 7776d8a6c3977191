// One measured signal of a rig: where it comes from on the board, and what its readings are worth.
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "bus/clock.h"
#include "plant/driver/comedi_board.h"
#include "plant/driver/signal_conditioning.h"
#include "plant/rig.h"
#include "settings/driver_section.h"

namespace hydro::plant {

class BoardSensor {
 public:
  // `name`: of its section, e.g. "p1". `angle`: the sensor whose rate this one is, for source "derivative";
  // it must outlive this one and be read before it. Throws InputError when the board has no such channel.
  BoardSensor(ComediBoard& board, const bus::Clock& clock, const std::string& name,
              const settings::SensorSection& section, const BoardSensor* angle = nullptr);

  // The signal now. Rates and low passes take the time since the last reading from the clock, right beside
  // the reading itself, so that a late wake-up makes no false speed. NaN: not measured, or not to be
  // believed: an analog input at an end of its range, or outside minimum_V to maximum_V. Throws RigError:
  // "board_error" when the board does not answer, "encoder_lost" when a counter has moved too far to be
  // followed.
  double Read();

  // The fault "sensor_NAME": from a reading that is not to be believed until kGoodReadings in a row are.
  const std::optional<RigFault>& fault() const { return fault_; }
  static constexpr int kGoodReadings = 10;

  // The last reading, for a person.
  const std::string& name() const { return name_; }
  const settings::SensorSection& section() const { return section_; }
  const BoardChannel& channel() const { return channel_; }
  uint32_t code() const { return code_; }  // what the board said
  double unfiltered() const { return unfiltered_; }

 private:
  double Signal();
  uint32_t Code();
  double Analog();
  double Counted();
  void Judge(bool good);

  ComediBoard& board_;
  const bus::Clock& clock_;
  std::string name_;
  settings::SensorSection section_;
  const BoardSensor* angle_;
  BoardChannel channel_;
  EncoderCount count_{0};
  Derivative derivative_;
  LowPass low_pass_;
  std::optional<bus::Clock::TimePoint> read_at_;
  double elapsed_s_ = 0;  // between the last two readings; of a rate, those of its angle
  uint32_t code_ = 0;
  double unfiltered_ = NAN;
  std::string complaint_;  // what is wrong with the last reading
  double found_ = NAN;
  double allowed_ = NAN;
  std::optional<RigFault> fault_;
  int good_readings_ = kGoodReadings;
};

}  // namespace hydro::plant
