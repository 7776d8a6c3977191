#include "plant/driver/board_sensor.h"

#include <spdlog/fmt/fmt.h>

namespace hydro::plant {

using Source = settings::SensorSection::Source;

BoardSensor::BoardSensor(ComediBoard& board, const bus::Clock& clock, const std::string& name,
                         const settings::SensorSection& section, const BoardSensor* angle)
    : board_(board),
      clock_(clock),
      name_(name),
      section_(section),
      angle_(angle),
      low_pass_(section.low_pass_hz) {
  if (section.source == Source::kAnalog) channel_ = board.AnalogInput("driver." + name, section);
  if (section.source == Source::kCounter) {
    channel_ = board.Counter("driver." + name, section.line);
    count_ = EncoderCount(channel_.converter.max_code);
  }
}

double BoardSensor::Read() {
  if (section_.source == Source::kNone) return NAN;
  unfiltered_ = Signal();
  return low_pass_.Update(unfiltered_, elapsed_s_);
}

double BoardSensor::Signal() {
  switch (section_.source) {
    case Source::kAnalog:
      return Analog();
    case Source::kCounter:
      return Counted();
    case Source::kDerivative:
      elapsed_s_ = angle_->elapsed_s_;
      return derivative_.Update(angle_->unfiltered_, elapsed_s_);  // the angle raises the fault, if any
    case Source::kNone:
      break;
  }
  return NAN;
}

uint32_t BoardSensor::Code() {
  const auto now = clock_.Now();
  elapsed_s_ = read_at_ ? bus::ToSeconds(now - *read_at_) : 0;
  read_at_ = now;
  return board_.Read(channel_);
}

double BoardSensor::Analog() {
  code_ = Code();
  const double volts = channel_.converter.Volts(code_);
  const bool low = std::isnan(section_.minimum_V) ? code_ == 0 : volts < section_.minimum_V;
  const bool high =
      std::isnan(section_.maximum_V) ? code_ >= channel_.converter.max_code : volts > section_.maximum_V;
  if (low || high) {
    const double limit = low ? section_.minimum_V : section_.maximum_V;
    found_ = volts;
    allowed_ = std::isnan(limit) ? volts : limit;
    fault_text_ = std::isnan(limit)
                      ? fmt::format("{} reads {:.4g} V, an end of its input range: the input is saturated",
                                    name_, volts)
                      : fmt::format("{} reads {:.4g} V, {} is {:.4g} V (driver.{}.{}); a broken wire?", name_,
                                    volts, low ? "the least allowed" : "the most allowed", limit, name_,
                                    low ? "minimum_V" : "maximum_V");
  }
  Judge(!low && !high);
  return low || high ? NAN : section_.scale * volts + section_.offset;
}

double BoardSensor::Counted() {
  code_ = Code();
  const std::optional<int64_t> count = count_.Update(code_);
  if (!count) {
    throw RigError("encoder_lost",
                   fmt::format("driver.{}: the counter has moved by a quarter of its range ({} counts) or "
                               "more since the last reading; the angle is lost",
                               name_, channel_.converter.max_code));
  }
  return section_.scale * static_cast<double>(*count) + section_.offset;
}

// Several good readings in a row end the fault: a loose contact must not switch the voltage on and off at
// every tick.
void BoardSensor::Judge(bool good) {
  good_readings_ = good ? good_readings_ + 1 : 0;
  if (!good && !fault_) fault_ = RigFault{"sensor_" + name_, fault_text_, found_, allowed_};
  if (good_readings_ >= kGoodReadings) {
    good_readings_ = kGoodReadings;
    fault_.reset();
  }
}

}  // namespace hydro::plant
