#include "plant/front_end/sample_watch.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <limits>

#include "plant/front_end/refusals.h"

namespace hydro::plant {
namespace {

using namespace std::chrono_literals;

constexpr uint32_t kNoCommand = std::numeric_limits<uint32_t>::max();  // a command_age
constexpr unsigned kKnownSensors = (1U << HYDRO_SENSORS) - 1;

// A jump ahead beyond this is none that a late wake-up here or a repeated delay on the way explains.
constexpr double kJumpShare = 2, kJump_s = 1;
// The rate of the device's clock is measured over this time, and twice, because a computer that stood still
// may get old samples for a while. A timer that was set up for another frequency is wrong by 2 or more.
constexpr auto kWindow = 1s;
constexpr int kWindows = 2;
constexpr double kSlowest = 0.55, kFastest = 1.8;

constexpr double kSinglePrecision = 1e-6;  // of the terms: a few steps
constexpr double kSlackCounts = 4;         // an encoder that trembles on an edge

// What no such field holds; empty: nothing.
std::string WrongField(const hydro_sample& s) {
  if (s.state < HYDRO_READY || s.state > HYDRO_TRIPPED) {
    return fmt::format(
        "says that its state is {}, allowed are 1 (ready), 2 (armed) and 3 (tripped) while it "
        "sends samples",
        s.state);
  }
  if (s.source > HYDRO_SOURCE_LAW) {
    return fmt::format(
        "says that its voltage comes from source {}, allowed are 0 (zero), 1 (VOLTAGE) and 2 "
        "(its law)",
        s.source);
  }
  if (s.saturated > 1) return fmt::format("says {} for saturated, allowed are 0 and 1", s.saturated);
  if ((s.sensor_faults & ~kKnownSensors) == 0) return "";
  return fmt::format(
      "names sensors that it does not have among those at fault (0x{:02x}), allowed are the "
      "bits of 0x{:02x}",
      s.sensor_faults, kKnownSensors);
}

// Which fields contradict each other about what it does and by which command; empty: none.
std::string WrongAction(const hydro_sample& s, const hydro_settings& settings) {
  const bool armed = s.state == HYDRO_ARMED, commanded = s.command_age != kNoCommand;
  if (!armed && s.source != HYDRO_SOURCE_ZERO)
    return fmt::format("says that it acts by source {} and that it is not armed", s.source);
  if (s.source == HYDRO_SOURCE_LAW && settings.mode != HYDRO_LOOP_ON_DEVICE)
    return "says that its voltage comes from its law (source 2), and its mode has none: allowed are 0 and 1";
  if (armed && s.source != HYDRO_SOURCE_ZERO && !commanded)
    return "says that it acts by a command and that it has none";
  if (armed && s.source == HYDRO_SOURCE_ZERO && commanded)
    return "says that it is armed and has a command, and that it does not act by it";
  if (armed && commanded && s.command_age >= settings.watchdog_ticks) {
    return fmt::format(
        "is still armed {} of its ticks after its newest command; its watchdog must trip "
        "after {} (driver.watchdog_s)",
        s.command_age, settings.watchdog_ticks);
  }
  if (!armed && commanded) return "says that it has a command and that it is not armed";
  if (!commanded && (s.command_sequence != 0 || s.host_tick != 0)) {
    return fmt::format("says that it has no command, and names command {} for tick {}; allowed are 0 and 0",
                       s.command_sequence, s.host_tick);
  }
  if (armed && s.faults_latched != 0) {
    return fmt::format("says that it is armed and that it has tripped: {}",
                       DescribeDeviceFaults(s.faults_latched));
  }
  return "";
}

// Which field holds something though it means nothing in this mode, source or wiring; empty: none.
std::string WrongUnused(const hydro_sample& s, const hydro_settings& settings) {
  if (s.source == HYDRO_SOURCE_ZERO && s.saturated != 0)
    return "says that it puts out zero volts and that its limits allow no more (saturated is 1)";
  if (s.source != HYDRO_SOURCE_LAW && !(s.pressure_ref == 0 && s.transfer == 0)) {
    return fmt::format(
        "gives {:.6g} for pressure_ref and {:.6g} for transfer; allowed are 0 and 0 while its voltage does "
        "not come from its law",
        s.pressure_ref, s.transfer);
  }
  for (int i = 0; i < HYDRO_SENSORS; ++i) {
    if (settings.sensors[i].kind == HYDRO_SENSOR_NONE && !std::isnan(s.value[i])) {
      return fmt::format("gives {:.6g} for {}, which it was not told to measure; allowed is NaN", s.value[i],
                         SensorName(i));
    }
  }
  const auto wrong = [&](int angle, int32_t count) {
    return settings.sensors[angle].kind == HYDRO_SENSOR_COUNTER || count == 0
               ? std::string()
               : fmt::format("gives a count of {} for {}, which it has no counter for; allowed is 0", count,
                             SensorName(angle));
  };
  const std::string motor = wrong(HYDRO_MOTOR_ANGLE, s.motor_count);
  return motor.empty() ? wrong(HYDRO_ARM_ANGLE, s.arm_count) : motor;
}

// What is wrong with what the device says of itself; empty: nothing.
std::string WrongSelf(const hydro_sample& sample, const hydro_settings& settings) {
  std::string wrong = WrongField(sample);
  if (wrong.empty()) wrong = WrongAction(sample, settings);
  return wrong.empty() ? WrongUnused(sample, settings) : wrong;
}

constexpr std::array<int, 2> kAngles = {HYDRO_MOTOR_ANGLE, HYDRO_ARM_ANGLE};

std::array<int32_t, 2> CountsOf(const hydro_sample& sample) { return {sample.motor_count, sample.arm_count}; }

int32_t Moved(int32_t count, int32_t before) {
  return static_cast<int32_t>(static_cast<uint32_t>(count) - static_cast<uint32_t>(before));
}

// A count and its angle in single precision are one reading; without a low pass they agree.
std::string WrongAngle(const hydro_sensor_settings& sensor, float angle, int32_t count) {
  if (sensor.low_pass_share < 1 || !std::isfinite(angle)) return "";
  const double turned = static_cast<double>(sensor.scale) * count;
  const double expected = turned + sensor.offset;
  const double room =
      kSinglePrecision * (std::fabs(turned) + std::fabs(sensor.offset) + std::fabs(sensor.scale));
  if (std::fabs(static_cast<double>(angle) - expected) <= room) return "";
  return fmt::format("is {:.6g}, and its count of {} is {:.6g}", angle, count, expected);
}

}  // namespace

void SampleWatch::Forget() {
  before_.reset();
  window_.reset();
  wrong_windows_ = 0;
  rate_ = 1;
  wrong_tick_.clear();
  left_uncounted_ = false;
  wrong_counts_ = {};
}

void SampleWatch::Look(const ArrivedSample& arrived, const hydro_settings& settings, uint32_t tick_rate_hz,
                       std::vector<RigFault>* faults) {
  if (const std::string wrong = WrongSelf(arrived.sample, settings); !wrong.empty()) {
    faults->push_back({"device_fault", "the front end " + wrong + ": is its firmware of this version?"});
  }
  const hydro_sample& sample = arrived.sample;
  if (!before_ || arrived.number != before_->number) {
    left_uncounted_ = before_ && before_->state == HYDRO_ARMED && sample.state != HYDRO_ARMED &&
                      sample.trips == before_->trips;
  }
  if (left_uncounted_) {
    faults->push_back(
        {"device_fault",
         "the front end says that it is not armed any more, and counts no trip since it was: is "
         "its output at zero?"});
  }
  LookAtClock(arrived, tick_rate_hz, faults);
  LookAtCounts(arrived, settings, tick_rate_hz, faults);
  before_ = {sample.tick, arrived.at, arrived.number, CountsOf(sample), sample.state, sample.trips};
}

void SampleWatch::LookAtClock(const ArrivedSample& arrived, uint32_t tick_rate_hz,
                              std::vector<RigFault>* faults) {
  if (!before_ || arrived.number != before_->number) wrong_tick_ = WrongTick(arrived, tick_rate_hz);
  if (!wrong_tick_.empty()) {
    window_.reset();
    faults->push_back({"device_fault", "the front end's clock " + wrong_tick_});
    return;
  }
  MeasureRate(arrived, tick_rate_hz);
  if (wrong_windows_ < kWindows) return;
  faults->push_back(
      {"device_fault",
       fmt::format("the front end's clock makes {:.0f} ticks in a second of this computer's; it says that it "
                   "makes {}: is the timer of its firmware set for that?",
                   rate_ * tick_rate_hz, tick_rate_hz),
       rate_ * tick_rate_hz, static_cast<double>(tick_rate_hz)});
}

std::string SampleWatch::WrongTick(const ArrivedSample& arrived, uint32_t tick_rate_hz) const {
  if (!before_) return "";
  const uint64_t tick = arrived.sample.tick;
  const char* const allowed = "allowed is one that goes on from sample to sample";
  if (tick == before_->tick) return fmt::format("stands still at tick {}, {}", tick, allowed);
  if (tick < before_->tick)
    return fmt::format("runs backwards, from tick {} to tick {}, {}", before_->tick, tick, allowed);
  const double ahead_s = static_cast<double>(tick - before_->tick) / tick_rate_hz;
  const double passed_s = bus::ToSeconds(arrived.at - before_->at);
  if (ahead_s <= kJumpShare * passed_s + kJump_s) return "";
  return fmt::format("jumps by {} ticks ({:.4g} s) within {:.4g} s of this computer's, {}",
                     tick - before_->tick, ahead_s, passed_s, allowed);
}

void SampleWatch::MeasureRate(const ArrivedSample& arrived, uint32_t tick_rate_hz) {
  const Begin now = {arrived.sample.tick, arrived.at};
  if (!window_) window_ = now;
  const double passed_s = bus::ToSeconds(now.at - window_->at);
  if (passed_s < bus::ToSeconds(kWindow)) return;
  rate_ = static_cast<double>(now.tick - window_->tick) / tick_rate_hz / passed_s;
  wrong_windows_ = rate_ < kSlowest || rate_ > kFastest ? wrong_windows_ + 1 : 0;
  window_ = now;
}

void SampleWatch::LookAtCounts(const ArrivedSample& arrived, const hydro_settings& settings,
                               uint32_t tick_rate_hz, std::vector<RigFault>* faults) {
  const bool anew = !before_ || arrived.number != before_->number;
  for (size_t i = 0; i < kAngles.size(); ++i) {
    const int angle = kAngles[i];
    const hydro_sensor_settings& sensor = settings.sensors[angle];
    if (sensor.kind != HYDRO_SENSOR_COUNTER) continue;
    const int32_t count = CountsOf(arrived.sample)[i];
    if (anew) {
      wrong_counts_[i] = WrongAngle(sensor, arrived.sample.value[angle], count);
      if (wrong_counts_[i].empty()) wrong_counts_[i] = WrongMove(arrived, i, sensor, tick_rate_hz);
    }
    if (wrong_counts_[i].empty()) continue;
    faults->push_back({std::string("sensor_") + SensorName(angle),
                       fmt::format("the front end's {} {}", SensorName(angle), wrong_counts_[i])});
  }
}

std::string SampleWatch::WrongMove(const ArrivedSample& arrived, size_t i,
                                   const hydro_sensor_settings& sensor, uint32_t tick_rate_hz) const {
  if (!before_ || arrived.sample.tick <= before_->tick) return "";
  const double scale = std::fabs(sensor.scale);
  const double passed_s = static_cast<double>(arrived.sample.tick - before_->tick) / tick_rate_hz;
  const double moved =
      scale * std::fabs(static_cast<double>(Moved(CountsOf(arrived.sample)[i], before_->counts[i])));
  const CredibleEnds& ends = ends_[static_cast<size_t>(kAngles[i]) + 1];  // of its speed
  if (!(moved > ends.high.value * passed_s + kSlackCounts * scale)) return "";
  return fmt::format("has moved by {:.4g} within {:.4g} s; its speed is {}", moved, passed_s,
                     ends.Allowed(moved / passed_s));
}

}  // namespace hydro::plant
