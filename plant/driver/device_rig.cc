#include "plant/driver/device_rig.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <thread>
#include <utility>

#include "base/number_text.h"
#include "plant/driver/described_device.h"
#include "plant/driver/zero_guardian.h"
#include "settings/toml/section_reader.h"

namespace hydro::plant {
namespace {

constexpr int kSettlingTries = 10;
constexpr auto kSettlingTry = std::chrono::milliseconds(10);
constexpr int kFirstTries = 100;  // about 1 ms each, for the first readings of all inputs

// In the run, what a driver takes for an error of the configuration is one of the device, which has changed.
template <class Step>
void InTheRun(const Step& step) {
  try {
    step();
  } catch (const InputError& error) {
    throw DeviceError(error.what());
  }
}

}  // namespace

DeviceRig::DeviceRig(const settings::StackConfig& config, const bus::Clock& clock,
                     std::unique_ptr<Device> device)
    : amplifier_(config.driver->voltage),
      clock_(clock),
      device_(std::move(device)),
      description_(Described(*device_, config.file)),
      sensors_(description_, config),
      watch_(description_, bus::FromSeconds(config.limits.stale_input_s), clock.Now()),
      zero_(Terminal(0)) {
  readings_.inputs.resize(description_.inputs.size());
  const DeviceOutput& output = description_.output;
  if (zero_ < output.low || zero_ > output.high) {
    throw settings::KeyError(config.file, "driver.voltage.offset", ShortestNumber(amplifier_.offset),
                             "one with which zero volts are within the output's range, " +
                                 ShortestNumber(output.low) + " to " + ShortestNumber(output.high) + " " +
                                 output.unit + " at the terminal");
  }
  const auto [reach_low, reach_high] = std::minmax({amplifier_.scale * output.low + amplifier_.offset,
                                                    amplifier_.scale * output.high + amplifier_.offset});
  min_voltage_ = std::max(reach_low, -amplifier_.limit_V);
  max_voltage_ = std::min(reach_high, amplifier_.limit_V);

  if (!WriteZero()) {
    device_->Drive(zero_);  // throws with the reason, which Zero() cannot give
    throw DeviceError(description_.name + " does not accept zero volts");
  }
  guardian_ = std::make_unique<ZeroGuardian>(*device_, description_.files, zero_);
  ArmZero(*device_, zero_);
}

DeviceRig::~DeviceRig() {
  if (!WriteZero()) {
    std::fprintf(stderr, "driver: %s does not accept zero volts: cut the amplifier's supply\n",
                 description_.name.c_str());
  }
  DisarmZero();
  guardian_->Dismiss();
}

// Since the rig was made, this process may have waited long for the loops. Many devices answer only when
// something is put out.
void DeviceRig::AwaitReadings() {
  const auto fresh = [&](const Reading& reading) { return clock_.Now() - reading.at <= watch_.patience(); };
  for (int i = 0; i < kFirstTries; ++i) {
    ReadDevice(*device_, description_, readings_);
    if (std::all_of(readings_.inputs.begin(), readings_.inputs.end(), fresh)) return;
    device_->Drive(zero_);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

model::Measurement DeviceRig::Read(int64_t /*tick*/) {
  InTheRun(
      [&] { std::exchange(begun_, true) ? ReadDevice(*device_, description_, readings_) : AwaitReadings(); });
  faults_.clear();
  const bus::Clock::TimePoint now = clock_.Now();
  const bool silent = watch_.Look(readings_, now, &faults_);
  // The last readings of a silent device do not measure the present.
  const model::Measurement measured = silent ? sensors_.Nothing() : sensors_.Take(readings_, now);
  for (const DeviceSensor* sensor : sensors_.all()) {
    if (sensor->fault()) faults_.push_back(*sensor->fault());
  }
  return measured;
}

// Where this process's own descriptors of the device are of no use, its guardian has its copies of them.
bool DeviceRig::WriteZero() noexcept {
  return WriteZeroTo(*device_, zero_) || (guardian_ && guardian_->WriteZero());
}

// An output behind a filter settles soon. One that still holds something else has not taken the zero,
// whatever the device says.
OutputLeft DeviceRig::Zero() noexcept {
  OutputLeft left{.accepted = WriteZero(), .voltage = NAN};
  double held = device_->ReadBack();
  const auto elsewhere = [&] {
    return !std::isnan(held) && std::fabs(held - zero_) > description_.output.tolerance;
  };
  for (int i = 0; i < kSettlingTries && elsewhere(); ++i) {
    std::this_thread::sleep_for(kSettlingTry);
    if (when_late_ && 2 * i * kSettlingTry > watch_.patience()) std::exchange(when_late_, {})();
    left.accepted = WriteZero();
    held = device_->ReadBack();
  }
  left.accepted = left.accepted && !elsewhere();
  left.voltage = amplifier_.scale * held + amplifier_.offset;
  return left;
}

double DeviceRig::Drive(double voltage) {
  if (!std::isfinite(voltage)) voltage = 0;
  voltage = std::clamp(voltage, min_voltage_, max_voltage_);
  guardian_->Require();
  const double output = Terminal(voltage);
  watch_.OnDriven(output, clock_.Now());
  InTheRun([&] { device_->Drive(output); });
  return voltage;
}

}  // namespace hydro::plant
