#include "plant/front_end/front_end_rig.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "base/text_file.h"
#include "bus/clock.h"
#include "plant/front_end/front_end_settings.h"
#include "plant/front_end/refusals.h"
#include "process/stop_signal.h"
#include "settings/toml/section_reader.h"

namespace hydro::plant {
namespace {

using namespace std::chrono_literals;
using Source = settings::SensorSection::Source;

constexpr auto kTurn = 1ms;           // between two turns of a waiting function
constexpr auto kZeroRepeat = 10ms;    // a lost ZERO is sent again
constexpr auto kZeroTimeout = 500ms;  // a busy computer may be late by more than a tenth of this
constexpr auto kForeign = 300ms;      // a device asked this long answers several times
constexpr double kNearZero = 0.05;    // V; offsets of converters are below it
constexpr int64_t kTicksToZero = 5;   // after any fault (docs/safety.md)
constexpr double kSampleBytes = 107;  // on the wire
constexpr double kBitsPerByte = 10;   // of a serial line, with start and stop bits

// Whether the device puts out a voltage, or reads one back, that is none of a converter's offsets.
bool HoldsVolts(const hydro_sample& sample) {
  return std::fabs(sample.voltage) > kNearZero || std::fabs(sample.read_back) > kNearZero;
}

uint32_t RandomSession() {
  std::random_device random;
  return std::uniform_int_distribution<uint32_t>(1)(random);
}

SensorEnds EndsOf(const settings::StackConfig& config) {
  const auto sections = SensorSections(*config.driver);
  SensorEnds ends;
  for (size_t i = 0; i < ends.size(); ++i)
    ends[i] = CredibleEndsOf(config, SensorName(static_cast<int>(i)), *sections[i]);
  return ends;
}

}  // namespace

FrontEndRig::FrontEndRig(const settings::StackConfig& config, const bus::Clock& clock)
    : FrontEndRig(config, clock, MakeLink(config.driver->front_end.address), RandomSession()) {}

FrontEndRig::FrontEndRig(const settings::StackConfig& config, const bus::Clock& clock,
                         std::unique_ptr<Link> link, uint32_t session)
    : config_(config),
      clock_(clock),
      connection_(config.file, std::move(link), session,
                  [this](const hydro_identity& identity) { return FrontEndSettings(config_, identity); }),
      stale_time_(bus::FromSeconds(config.limits.stale_input_s)),
      ticks_per_s_(config.plant.rate_hz),
      voltage_limit_(config.driver->voltage.limit_V),
      output_(*config.driver, stale_time_, bus::FromSeconds(config.limits.transfer_s)),
      ends_(EndsOf(config)),
      watch_(ends_) {
  CheckSpeed();
}

FrontEndRig::~FrontEndRig() {
  connection_.Zero();
  const FrameCounts& counts = connection_.counts();
  if (counts.samples == 0) return;
  spdlog::info(
      "{}: {} samples; of its frames {} were lost, {} damaged, {} repeated or late{}; of ours it found {} "
      "damaged and refused {}, "
      "and {} were left out",
      Describe(), counts.samples, counts.lost, counts.damaged, counts.refused,
      counts.jumps > 0 ? fmt::format(", and their numbers jumped {} times", counts.jumps) : "",
      counts.device_damaged, counts.device_refused, counts.left_out);
}

std::string FrontEndRig::Describe() const {
  const hydro_identity& identity = connection_.identity();
  const std::string board(identity.board, strnlen(identity.board, HYDRO_BOARD_NAME_BYTES));
  return fmt::format("{} ({}, firmware {}.{}.{}, {} ticks/s)", config_.driver->front_end.url,
                     Printable(board), identity.firmware[0], identity.firmware[1], identity.firmware[2],
                     identity.tick_rate_hz);
}

// A line that is too slow to carry all samples would fall further and further behind.
void FrontEndRig::CheckSpeed() const {
  const int baud = config_.driver->front_end.address.baud;
  const double needed = kSampleBytes * kBitsPerByte * ticks_per_s_;
  if (baud == 0 || baud >= needed) return;
  throw settings::KeyError(
      config_.file, "driver.url", fmt::format("baud={}", baud),
      fmt::format("at least {:.0f} for {:.6g} samples a second of {:.0f} bytes (plant.rate_hz)", needed,
                  ticks_per_s_, kSampleBytes));
}

bool FrontEndRig::Poll() {
  now_ = clock_.Now();
  OnLink(connection_.link().descriptor());
  connection_.Poll(now_);
  OnLink(connection_.link().descriptor());
  return connection_.is_up();
}

void FrontEndRig::Connect() {
  const auto refuse = [&](const LinkTrouble& trouble, const std::string& when) {
    return settings::KeyError(config_.file, "driver.url", trouble.found + when, trouble.allowed);
  };
  const auto deadline = clock_.Now() + bus::FromSeconds(config_.time.start_timeout_s);
  std::optional<bus::Clock::TimePoint> foreign_since;
  bool done = Poll();
  if (!connection_.link_is_open()) throw refuse(connection_.WhyNot(), "");
  while (!done && process::StopSignal() == 0) {
    // Waiting gives a device no other firmware; but one wrong answer may come from somewhere else.
    if (!connection_.hears_another_protocol()) foreign_since.reset();
    if (connection_.hears_another_protocol() && !foreign_since) foreign_since = now_;
    if (foreign_since && now_ - *foreign_since > kForeign) throw refuse(connection_.WhyNot(), "");
    if (now_ >= deadline) {
      throw refuse(connection_.WhyNot(),
                   fmt::format(" at {} within {} s (time.start_timeout_s)", config_.driver->front_end.url,
                               config_.time.start_timeout_s));
    }
    bus::SleepUntil(now_ + kTurn);
    done = Poll();
  }
  if (done) spdlog::info("{}", Describe());
}

model::Measurement FrontEndRig::Read(int64_t tick) {
  // This process stood still and commanded nothing meanwhile. Ordinary late wake-ups must not hide a device
  // that lags behind.
  if (static_cast<double>(tick - tick_) > 0.5 * config_.limits.stale_input_s * ticks_per_s_)
    driving_since_ = tick;
  tick_ = tick;
  if (!polled_) TakeTurn();
  polled_ = false;
  faults_.clear();
  read_ = {};
  if (FindSilence()) {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    driving_since_.reset();
    watch_.Forget();
    return {kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown};
  }
  read_ = connection_.sample();
  has_read_back_ |= !std::isnan(read_.read_back);
  FindSensorFaults(read_);
  FindContradictions();
  FindJumps();
  FindDeviceFaults(read_);
  FindUnaskedArming(read_);
  FindOldCommands(read_);
  trips_ = read_.trips;
  return Measured();
}

// Takes a turn within the run. What cannot be driven shall be at zero volts, whatever it is: a device that is
// not up may hold its last ones.
void FrontEndRig::TakeTurn() {
  Poll();
  if (!connection_.is_up()) AskForZero();
  if (beside_) beside_();
}

std::optional<int64_t> FrontEndRig::Arrived() {
  TakeTurn();
  polled_ = true;
  const int64_t before = std::exchange(arrived_before_, connection_.counts().samples);
  if (!connection_.is_up() || arrived_before_ == before) return std::nullopt;
  // Ticks that a device makes up must not overflow what is added to them.
  constexpr uint64_t kMost = std::numeric_limits<int64_t>::max() / 2;
  return static_cast<int64_t>(connection_.sample().tick / connection_.settings().sample_interval_ticks %
                              kMost);
}

// Meanwhile, no other program shall take the device, and no old samples shall queue up.
void FrontEndRig::Attend() {
  Poll();
  connection_.KeepAlive(now_);
  if (beside_) beside_();
}

model::Measurement FrontEndRig::Measured() {
  const hydro_sample& sample = read_;
  const settings::DriverSection& driver = *config_.driver;
  // A count is exact; an angle in single precision is not.
  const auto angle = [](const settings::SensorSection& section, float value, int32_t count,
                        DeviceCount* counted) {
    if (section.source != Source::kCounter || std::isnan(value)) return static_cast<double>(value);
    return section.scale * static_cast<double>(counted->Update(count)) + section.offset;
  };
  model::Measurement measured;
  measured.p1 = sample.value[HYDRO_P1];
  measured.p2 = sample.value[HYDRO_P2];
  const bool filtered_motor = driver.motor_angle.low_pass_hz > 0,
             filtered_arm = driver.arm_angle.low_pass_hz > 0;
  measured.motor_angle = filtered_motor ? static_cast<double>(sample.value[HYDRO_MOTOR_ANGLE])
                                        : angle(driver.motor_angle, sample.value[HYDRO_MOTOR_ANGLE],
                                                sample.motor_count, &motor_count_);
  measured.motor_speed = sample.value[HYDRO_MOTOR_SPEED];
  measured.arm_angle =
      filtered_arm ? static_cast<double>(sample.value[HYDRO_ARM_ANGLE])
                   : angle(driver.arm_angle, sample.value[HYDRO_ARM_ANGLE], sample.arm_count, &arm_count_);
  measured.arm_speed = sample.value[HYDRO_ARM_SPEED];
  return measured;
}

void FrontEndRig::AskForZero() {
  connection_.AskForZero(now_);
  asked_for_zero_ = true;
}

// Whether an armed device goes on with volts though only zero is commanded: some of the faults say so, and of
// all of them zero must follow soon.
bool FrontEndRig::Disregards(bool commanded) {
  if (commanded || !Armed()) zero_since_.reset();
  if (!commanded && Armed() && !zero_since_) zero_since_ = tick_;
  if (!zero_since_ || !HoldsVolts(read_)) return false;
  const bool found = std::any_of(faults_.begin(), faults_.end(), [](const RigFault& fault) {
    return fault.code == "output_differs" || fault.code == "device_silent";
  });
  return found || tick_ - *zero_since_ > kTicksToZero;
}

double FrontEndRig::Drive(double voltage) {
  // The motor command of a loop on the device is its answer to the very state that was read.
  acting_command_tick_ = output_.ActsByLaw(read_) ? tick_ : output_.CommandTick(read_);
  if (!connection_.is_up()) {
    arming_since_.reset();
    return read_.voltage;
  }
  const bool armed = Armed();
  const bool obeys = MayDrive() && std::isfinite(voltage);
  if (!armed && obeys) {
    if (!arming_since_) arming_since_ = now_;
    // Uses the trip count of the sample that was read: a trip that has come since must first become a fault,
    // and this is not the place to decide whether to go on.
    connection_.AskToArm(now_, read_.trips);
    asked_to_arm_at_ = now_;
    asked_for_zero_ = false;
  } else {
    arming_since_.reset();
  }
  if ((armed && !asked_to_arm_at_) || Disregards(obeys)) AskForZero();
  if (!armed) driving_since_.reset();
  if (armed && !driving_since_) driving_since_ = tick_;
  if (!armed && !obeys) {
    // A device that was asked to arm may say falsely that it is not armed, and hold its last voltage. Whoever
    // sees volts that nobody commands asks for zero.
    if ((asked_to_arm_at_ && !faults_.empty()) || HoldsVolts(read_)) AskForZero();
    connection_.KeepAlive(now_);
  } else if (armed && obeys && followed_) {
    if (!followed_->sent) SendFollowed();
    followed_->sent = false;
  } else {
    // Sends zero until the device is known to be armed.
    SendVoltage(armed && obeys ? std::clamp(voltage, -voltage_limit_, voltage_limit_) : 0.0);
  }
  return read_.voltage;
}

hydro_voltage_range FrontEndRig::Range() const {
  hydro_board_facts facts{};
  facts.output_min_V = connection_.identity().output_min_V;
  facts.output_max_V = connection_.identity().output_max_V;
  return hydro_reachable_voltages(&connection_.settings(), &facts);
}

void FrontEndRig::SendVoltage(double voltage) {
  const auto told = static_cast<float>(voltage);
  const uint32_t sequence = connection_.CommandVoltage(tick_, told);
  output_.OnTold(sequence, told, command_tick_, now_);
}

void FrontEndRig::SendFollowed() {
  const uint32_t sequence = connection_.CommandPressure(tick_, followed_->pressure_ref, followed_->gains);
  output_.OnTold(sequence, followed_->pressure_ref, followed_->gains, now_);
  followed_->sent = true;
}

pressure_ctrl::DeviceLoop::Answer FrontEndRig::Follow(const state_t& /*state*/, double pressure_ref,
                                                      const pressure_ctrl::PressureLawSettings& law) {
  followed_ = Followed{.pressure_ref = static_cast<float>(pressure_ref),
                       .gains = {.k_p = static_cast<float>(law.gains.k_p),
                                 .k_v = static_cast<float>(law.gains.k_v),
                                 .reference_feedforward = static_cast<float>(law.reference_feedforward),
                                 .arm_speed_ratio = static_cast<float>(law.arm_speed_ratio)}};
  if (!Armed() || !MayDrive()) return {};
  SendFollowed();
  // The sample from which the state was made contains the voltage that the device computed from it.
  return {.by_law = read_.source == HYDRO_SOURCE_LAW,
          .voltage = read_.voltage,
          .pressure_ref = read_.pressure_ref,
          .saturated = read_.saturated != 0};
}

OutputLeft FrontEndRig::Zero() noexcept {
  OutputLeft left{.accepted = false, .voltage = NAN};
  std::optional<int64_t> obeyed;  // number of the first sample that shows it
  try {
    const auto asked = clock_.Now();
    auto next = asked;
    do {
      if (clock_.Now() >= next) {
        connection_.Zero();
        next = clock_.Now() + kZeroRepeat;
      }
      if (when_late_ && clock_.Now() - asked > stale_time_ / 2) std::exchange(when_late_, {})();
      if (!clock_.simulated()) bus::SleepUntil(clock_.Now() + kTurn);
      const bool up = Poll();
      const hydro_sample& sample = connection_.sample();
      if (up && connection_.sampled_at() >= asked) {
        // Of what it reads back and what it reports, the one that is farther from zero.
        const bool reads_back = !std::isnan(sample.read_back);
        const double held = reads_back && std::fabs(sample.read_back) >= std::fabs(sample.voltage)
                                ? sample.read_back
                                : sample.voltage;
        left.accepted = sample.state != HYDRO_ARMED && std::fabs(held) <= output_.tolerance();
        left.voltage = reads_back || !left.accepted ? held : NAN;
        // The sample in which a device first obeys contains a read-back from just before: only a later sample
        // shows the voltage that was left.
        const int64_t samples = connection_.counts().samples;
        if (!obeyed && sample.state != HYDRO_ARMED) obeyed = samples;
        // A board that has read its output back does so again.
        const bool known = reads_back || !has_read_back_;
        if (left.accepted && known && samples > *obeyed && std::fabs(held) <= kNearZero) return left;
      }
      if (!connection_.link_is_open()) return left;
    } while (!clock_.simulated() && clock_.Now() < asked + kZeroTimeout);
  } catch (const std::exception&) {  // no memory: of the output, nothing is known
  }
  return left;
}

}  // namespace hydro::plant
