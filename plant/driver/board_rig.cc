#include "plant/driver/board_rig.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/number_text.h"
#include "settings/toml/section_reader.h"

namespace hydro::plant {
namespace {

double TerminalVoltage(const settings::AmplifierSection& amplifier, double voltage) {
  return (voltage - amplifier.offset) / amplifier.scale;
}

}  // namespace

BoardRig::BoardRig(const settings::StackConfig& config, const bus::Clock& clock)
    : amplifier_(config.driver->voltage),
      board_(config.file, config.driver->device, config.driver->settle_ns),
      output_(board_.AnalogOutput("driver.voltage", amplifier_)),
      sensors_(board_, *config.driver, clock) {
  if (config.driver->watchdog) {
    watchdog_ = board_.DigitalOutput("driver.watchdog", *config.driver->watchdog);
  }
  const ConverterRange& range = output_.converter;
  const double zero_V = TerminalVoltage(amplifier_, 0);
  if (zero_V < range.minimum_V || zero_V > range.maximum_V) {
    throw settings::KeyError(config.file, "driver.voltage.offset", ShortestNumber(amplifier_.offset),
                             "one with which zero volts are within the output's range, " +
                                 ShortestNumber(range.minimum_V) + " to " + ShortestNumber(range.maximum_V) +
                                 " V at the terminal");
  }
  const auto [reach_low, reach_high] = std::minmax({amplifier_.scale * range.minimum_V + amplifier_.offset,
                                                    amplifier_.scale * range.maximum_V + amplifier_.offset});
  min_voltage_ = std::max(reach_low, -amplifier_.limit_V);
  max_voltage_ = std::min(reach_high, amplifier_.limit_V);

  zero_.device = board_.device();
  zero_.subdevice = output_.subdevice;
  zero_.channel = output_.channel;
  zero_.range = output_.range;
  zero_.reference = output_.reference;
  zero_.zero_code = range.Code(zero_V);
  if (watchdog_) {
    zero_.has_watchdog = true;
    zero_.watchdog_subdevice = watchdog_->subdevice;
    zero_.watchdog_channel = watchdog_->channel;
  }
  board_.Write(output_, zero_.zero_code);
  guardian_.emplace(zero_);
  ArmZero(zero_);
}

BoardRig::~BoardRig() {
  if (!zero_.Write()) {
    std::fprintf(stderr, "hydro-driver: %s does not accept zero volts: cut the amplifier's supply\n",
                 board_.name().c_str());
  }
  DisarmZero();
  guardian_->Dismiss();
}

model::Measurement BoardRig::Read(int64_t /*tick*/) {
  const model::Measurement measured = sensors_.Read();
  faults_.clear();
  for (const BoardSensor* sensor : sensors_.all()) {
    if (sensor->fault()) faults_.push_back(*sensor->fault());
  }
  return measured;
}

OutputLeft BoardRig::Zero() noexcept {
  OutputLeft left{.accepted = zero_.Write(), .voltage = NAN};
  if (const auto code = zero_.ReadBack()) {
    left.voltage = amplifier_.scale * output_.converter.Volts(*code) + amplifier_.offset;
  }
  return left;
}

double BoardRig::Drive(double voltage) {
  if (!std::isfinite(voltage)) voltage = 0;
  voltage = std::clamp(voltage, min_voltage_, max_voltage_);
  if (!guardian_->Watches()) {
    throw RigError(
        "guardian_gone",
        "the guardian (hydro-zero), which writes zero volts should this process be killed, has ended or "
        "stands still; allowed is a run with one: find out what ended it, and start again");
  }
  board_.Write(output_, output_.converter.Code(TerminalVoltage(amplifier_, voltage)));
  if (watchdog_) {
    watchdog_high_ = !watchdog_high_;
    board_.WriteLine(*watchdog_, watchdog_high_);
  }
  return voltage;
}

}  // namespace hydro::plant
