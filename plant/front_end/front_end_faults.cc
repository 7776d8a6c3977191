// What FrontEndRig finds wrong with the newest sample.
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "plant/front_end/front_end_rig.h"
#include "plant/front_end/refusals.h"

namespace hydro::plant {
namespace {

double SecondsOf(double ticks, double ticks_per_s) { return ticks / ticks_per_s; }

// Whether a signal is one that can be. A little beyond an end is the rounding of single precision.
bool IsCredible(const CredibleEnds& ends, const hydro_sensor_settings& sensor, double signal) {
  const auto room = [&](double end) {
    return std::isfinite(end) ? 1e-5 * (std::fabs(end) + std::fabs(sensor.scale)) : 0;
  };
  return !(signal < ends.low.value - room(ends.low.value)) &&
         !(signal > ends.high.value + room(ends.high.value));
}

// What tripped the device, in words.
std::string Reason(uint16_t faults) {
  return faults != 0 ? DescribeDeviceFaults(faults) : "it does not say why (its faults_latched is 0)";
}

}  // namespace

void FrontEndRig::Add(std::string code, std::string text, double value, double limit) {
  faults_.push_back({std::move(code), std::move(text), value, limit});
}

// Returns true when the newest sample no longer counts.
bool FrontEndRig::FindSilence() {
  const double silence = bus::ToSeconds(now_ - connection_.sampled_at());
  const double allowed = config_.limits.stale_input_s;
  const std::string& url = config_.driver->front_end.url;
  if (!connection_.link_is_open()) {
    Add("device_silent",
        fmt::format("the link to {} is cut; allowed is one that stays: plug it in again", url), silence,
        allowed);
    return true;
  }
  if (!connection_.unfit().empty()) {
    Add("device_fault",
        fmt::format("the front end at {} {}; it was sent a ZERO; allowed is the one with which the "
                    "run began, as it was then",
                    url, connection_.unfit()));
    ForgetDevice();
    return true;
  }
  if (resets_ != connection_.resets()) {
    Add("device_fault",
        fmt::format(
            "the front end at {} has reset itself, or another one has taken its place{}; allowed is one "
            "that keeps its supply: it gets its settings anew",
            url, connection_.change().empty() ? "" : ": " + connection_.change()));
    if (connection_.is_up()) resets_ = connection_.resets();
    ForgetDevice();
    return true;
  }
  if (connection_.is_up() && now_ - connection_.sampled_at() <= stale_time_) return false;
  if (!connection_.is_up()) {
    Add("device_silent",
        fmt::format(
            "no sample from {} for {:.0f} ms; found {}; it {}; allowed is one that goes on as it began", url,
            1e3 * silence, connection_.WhyNot().found,
            connection_.IsAnothers(now_) ? "is left to that program" : "was sent a ZERO"),
        silence, allowed);
    return true;
  }
  const std::string& elsewhere = connection_.elsewhere();
  Add("device_silent",
      fmt::format("no sample from {} for {:.0f} ms, allowed are {:.0f} ms (limits.stale_input_s){}", url,
                  1e3 * silence, 1e3 * allowed,
                  elsewhere.empty() ? "" : "; found answers from " + elsewhere + ", which are not used"),
      silence, allowed);
  return true;
}

// What it has counted so far tells nothing of what it counts from now on.
void FrontEndRig::ForgetDevice() {
  trips_.reset();
  sensor_faults_ = {};
  motor_count_.Forget();
  arm_count_.Forget();
}

void FrontEndRig::HoldSensorFault(int sensor, size_t faults_before) {
  SensorFault& held = sensor_faults_[static_cast<size_t>(sensor)];
  if (faults_.size() > faults_before) {
    held = {faults_.back(), 0};
    return;
  }
  if (!held.fault) return;
  if (++held.good_readings >= kGoodReadings) {
    held = {};
    return;
  }
  faults_.push_back(*held.fault);
  read_.value[sensor] = std::numeric_limits<float>::quiet_NaN();
}

// A signal that is not a number is missing, whatever the device reports. A rate that is missing is a fault of
// its angle.
void FrontEndRig::FindSensorFaults(const hydro_sample& sample) {
  const bool answered = (sample.faults_present & HYDRO_FAULT_CONVERTER) == 0;
  for (int i = 0; i < HYDRO_SENSORS; ++i) {
    const uint8_t kind = connection_.settings().sensors[i].kind;
    const bool by_device = (sample.sensor_faults & (1 << i)) != 0;
    const bool of_angle = kind == HYDRO_SENSOR_RATE && !std::isfinite(sample.value[i - 1]);
    const bool expected = kind != HYDRO_SENSOR_NONE && answered && !of_angle;
    const std::string code = std::string("sensor_") + SensorName(i);
    const size_t faults_before = faults_.size();
    if (by_device) {
      Add(code, fmt::format("the front end's reading of {} is not credible: an end of its range, or outside "
                            "of what driver.{} allows",
                            SensorName(i), SensorName(i)));
    } else if (const CredibleEnds& ends = ends_[static_cast<size_t>(i)];
               expected && std::isfinite(sample.value[i]) &&
               !IsCredible(ends, connection_.settings().sensors[i], sample.value[i])) {
      Add(code, fmt::format("the front end gives {:.6g} {} for {} and reports no fault of it; driver.{} "
                            "allows no such reading: {}",
                            sample.value[i], ends.unit, SensorName(i), SensorName(i),
                            ends.Allowed(sample.value[i])));
      read_.value[i] = std::numeric_limits<float>::quiet_NaN();
    } else if (expected && !std::isfinite(sample.value[i])) {
      Add(code, fmt::format("the front end gives {} for {} and reports no fault of it; allowed is a number",
                            sample.value[i], SensorName(i)));
    }
    // No process shall take this value for a signal.
    if (kind == HYDRO_SENSOR_NONE || !std::isfinite(sample.value[i]))
      read_.value[i] = std::numeric_limits<float>::quiet_NaN();
    HoldSensorFault(i, faults_before);
  }
}

void FrontEndRig::FindContradictions() {
  const ArrivedSample newest = {connection_.sample(), connection_.sampled_at(), connection_.counts().samples};
  watch_.Look(newest, connection_.settings(), connection_.identity().tick_rate_hz, &faults_);
  if (watch_.MotorCountIsWrong()) read_.value[HYDRO_MOTOR_ANGLE] = std::numeric_limits<float>::quiet_NaN();
  if (watch_.ArmCountIsWrong()) read_.value[HYDRO_ARM_ANGLE] = std::numeric_limits<float>::quiet_NaN();
}

void FrontEndRig::FindJumps() {
  if (jumps_ == connection_.counts().jumps) return;
  jumps_ = connection_.counts().jumps;
  const auto [before, after] = connection_.jump();
  Add("device_fault",
      fmt::format("the numbers of the front end's frames jump from {} to {}, and it cannot have sent so many "
                  "meanwhile; allowed is one more in each: has it reset itself, or is its memory damaged?",
                  before, after),
      after, before);
}

void FrontEndRig::FindDeviceFaults(const hydro_sample& sample) {
  if ((sample.faults_present & HYDRO_FAULT_READ_BACK) == 0) {
    output_.Look(sample, Range(), connection_.settings().sample_interval_ticks, now_, &faults_);
  } else {
    Add("output_differs",
        std::isnan(sample.read_back)
            ? fmt::format("the front end's output is not the {:.4g} V that it was set to; it does not say "
                          "what it reads back",
                          sample.voltage)
            : fmt::format(
                  "the front end says that its output is not what it was set to: it reads back {:.4g} "
                  "V, and {:.4g} V are put out now",
                  sample.read_back, sample.voltage),
        sample.read_back, sample.voltage);
  }
  const bool tripped = trips_ && *trips_ != sample.trips;
  // Those that have a fault of their own here. A sensor that is well again is named by no other.
  const unsigned named = HYDRO_FAULT_READ_BACK | (sample.sensor_faults != 0 ? HYDRO_FAULT_SENSOR : 0);
  const unsigned others = sample.faults_present & ~named;
  if (others == 0 && !tripped) return;
  const auto reasons = static_cast<uint16_t>(others | (tripped ? sample.faults_latched : 0U));
  // A ZERO leads to READY and latches nothing; a fault leads to TRIPPED.
  const bool told = reasons == 0 && sample.state == HYDRO_READY;
  if (told && asked_for_zero_) return;  // by this driver, for a fault that has its own name
  Add("device_fault",
      told ? "the front end has gone to zero volts: it was sent a ZERO, as anyone may do"
           : fmt::format("the front end {}: {}", tripped ? "put out zero volts by itself" : "reports",
                         Reason(reasons)));
}

// Armed, it may drive at any moment. The answer to a request may be late, and is then a fault of its own.
void FrontEndRig::FindUnaskedArming(const hydro_sample& sample) {
  if (sample.state != HYDRO_ARMED) {
    if (asked_to_arm_at_ && now_ - *asked_to_arm_at_ > 2 * stale_time_) asked_to_arm_at_.reset();
    return;
  }
  if (asked_to_arm_at_) {
    asked_to_arm_at_ = now_;
    return;
  }
  Add("device_fault",
      fmt::format("the front end says that it is armed with {:.4g} V and was not asked to arm; allowed is "
                  "one that arms "
                  "when it is asked: cut the amplifier's supply",
                  sample.voltage),
      sample.voltage, 0);
}

// Its samples may be current and yet tell that it does not get what it is sent; or they are old ones that
// were queued somewhere.
void FrontEndRig::FindOldCommands(const hydro_sample& sample) {
  const double allowed = config_.limits.stale_input_s;
  if (arming_since_ && now_ - *arming_since_ > stale_time_ && sample.state != HYDRO_ARMED) {
    const double waited = bus::ToSeconds(now_ - *arming_since_);
    Add("device_fault",
        fmt::format("the front end was asked to arm {:.0f} ms ago and has not, allowed are {:.0f} ms",
                    1e3 * waited, 1e3 * allowed),
        waited, allowed);
  }
  if (!driving_since_ || sample.state != HYDRO_ARMED) return;
  const auto age = static_cast<double>(tick_ - std::max(sample.host_tick, *driving_since_));
  if (sample.source != HYDRO_SOURCE_ZERO && sample.host_tick > tick_) {
    Add("output_differs",
        fmt::format("the front end says that it acts by a command for tick {}; the newest is for tick {}",
                    sample.host_tick, tick_));
    return;
  }
  if (age <= allowed * ticks_per_s_ + 1) {
    // Its own word on the tick of a command is not all: the command's number tells when it was sent.
    if (output_.ActsByAnOldCommand(sample)) {
      Add("device_silent",
          fmt::format(
              "the front end acts by a command that was sent more than {:.0f} ms ago, allowed are {:.0f} ms "
              "(limits.stale_input_s)",
              1e3 * allowed, 1e3 * allowed));
    }
    return;
  }
  Add("device_silent",
      fmt::format(
          "the front end obeys commands of {:.0f} ms ago, allowed are {:.0f} ms (limits.stale_input_s)",
          1e3 * SecondsOf(age, ticks_per_s_), 1e3 * allowed),
      SecondsOf(age, ticks_per_s_), allowed);
}

}  // namespace hydro::plant
