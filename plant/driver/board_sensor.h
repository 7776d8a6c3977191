// One measured signal of a rig: its source on the board, its scaling, and whether its readings are credible.
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
  // `name`: of its section, e.g. "p1". `angle`: for source "derivative" the sensor whose rate this one is; it
  // must outlive this one and be read before it. Throws InputError when the board has no such channel.
  BoardSensor(ComediBoard& board, const bus::Clock& clock, const std::string& name,
              const settings::SensorSection& section, const BoardSensor* angle = nullptr);

  // Reads the signal. The clock is read right beside the board, and rates and low passes use that time, so
  // that a late wake-up causes no false speed. NaN: not measured, or not credible (an analog input at an end
  // of its range or outside minimum_V to maximum_V). Throws RigError: "board_error" when the board does not
  // answer, "encoder_lost" when a counter has moved too far to be followed.
  double Read();

  // The fault "sensor_NAME": lasts from the first reading that is not credible until kGoodReadings good ones
  // in a row.
  const std::optional<RigFault>& fault() const { return fault_; }
  static constexpr int kGoodReadings = 10;

  // The last reading, for display.
  const std::string& name() const { return name_; }
  const settings::SensorSection& section() const { return section_; }
  const BoardChannel& channel() const { return channel_; }
  uint32_t code() const { return code_; }  // the board's raw value
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
  std::string fault_text_;  // what is wrong with the last reading
  double found_ = NAN;
  double allowed_ = NAN;
  std::optional<RigFault> fault_;
  int good_readings_ = kGoodReadings;
};

}  // namespace hydro::plant
