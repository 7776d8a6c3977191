#include "pressure_ctrl/pressure_app.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "base/integers.h"

namespace hydro::pressure_ctrl {
namespace {

constexpr size_t kMostBeforeTheRun = 64;  // pressure commands; a few take a faster route than the first state

// psi, with room for rounding and half a D/A step.
double LargestPressureReference(const tuning::TunedValues& values, double half_dac_step) {
  return (1 + 1e-9) * values.position.pressure_limit + half_dac_step;
}

}  // namespace

PressureApp::PressureApp(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config,
                         OwnPressureLaw own)
    : ControlLoop(bus, clock, config, "pressure_ctrl", config.pressure_interval_ticks),
      own_(std::move(own)),
      publisher_(bus.Advertise<motor_command_t>(participant().channels().Of<motor_command_t>())),
      position_interval_(config.position_interval_ticks),
      delay_(config.plant.command_delay_ticks),
      stale_ticks_(settings::OldestPressureCommandTicks(config)),
      ramp_ticks_(static_cast<int64_t>(std::ceil(config.limits.pressure_ramp_s * config.plant.rate_hz))),
      k_2_(config.model.description.parameters.k_2),
      units_(config.model.description.units),
      half_dac_step_(config.position.dac_bits > 0
                         ? std::ldexp(config.position.dac_range_psi, -config.position.dac_bits)
                         : 0),
      stale_time_(bus::FromSeconds(config.limits.stale_input_s)),
      values_(tuning::ValuesOf(config)),
      pressure_limit_(LargestPressureReference(values_, half_dac_step_)),
      limit_before_(pressure_limit_),
      tuning_(participant(), config, [this](const tuned_settings_t& settings) { return WhyNot(settings); }),
      transfer_(std::llround(config.limits.transfer_s * config.plant.rate_hz)),
      command_monitor_(stale_time_) {
  bus.Subscribe<pressure_command_t>(
      participant().channels().Of<pressure_command_t>(),
      [this](const pressure_command_t& command) { OnPressureCommand(command); });
  participant().OnRefusal([this](int64_t session, const std::string&) {
    if (command_monitor_.session() == session) ForgetPressureCommands();
  });
  participant().Announce(process_status_t::READY);
}

PressureApp::PressureApp(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config,
                         DeviceLoop& loop)
    : PressureApp(bus, clock, config) {
  device_ = &loop;
}

void PressureApp::ForgetPressureCommands() {
  waiting_commands_.clear();
  pressure_command_.reset();
}

void PressureApp::BeginAnew() {
  ForgetPressureCommands();
  future_command_.reset();
  pending_state_.reset();
}

// Before the first state, this loop cannot tell which ticks lie far in the future. One such command at the
// head of the queue would hold up all others for good.
void PressureApp::Observe(const state_t& state) {
  if (participant().tick() >= 0) return;
  waiting_commands_.erase_if([&](const pressure_command_t& command) {
    return command.tick > SaturatingSum(state.tick, stale_ticks_);
  });
}

bool PressureApp::Answer(const state_t& state, bus::Clock::TimePoint arrival) {
  if (AwaitsPressureCommand(state.tick)) {
    pending_state_ = state;
    return false;
  }
  Compute(state, arrival);
  return true;
}

void PressureApp::OnPressureCommand(const pressure_command_t& command) {
  if (participant().Refuses(command.session)) return;
  // Before the run there is no state that a command could answer. Only a few of the commands that arrive
  // before the first state are kept.
  if (command.tick < 0 || (participant().tick() < 0 && waiting_commands_.size() >= kMostBeforeTheRun)) return;
  const auto now = participant().clock().Now();
  // A command a few ticks ahead only took a faster route through the network. One far ahead would hold up all
  // that follow it in the queue, and if it counted as the newest, it would make them old.
  const bool future =
      participant().tick() >= 0 && command.tick > SaturatingSum(participant().tick(), stale_ticks_);
  if (future && !command_monitor_.FollowsAnother(command.session, now)) {
    future_command_ = FutureCommand{command.tick, participant().tick()};
    return;
  }
  const auto verdict = command_monitor_.Observe(command.session, command.sequence, now);
  // A second sender is not obeyed; InputsAreSafe() raises the fault.
  if (verdict == bus::SequenceMonitor::Verdict::kSecondSender) return;
  if (verdict == bus::SequenceMonitor::Verdict::kDuplicate) return;
  if (verdict == bus::SequenceMonitor::Verdict::kRestarted) ForgetPressureCommands();
  if (future_command_ && future_command_->at < participant().tick()) future_command_.reset();
  waiting_commands_.push_back(command);
  if (pending_state_ && !AwaitsPressureCommand(pending_state_->tick)) {
    const state_t state = *pending_state_;
    pending_state_.reset();
    Compute(state, now);
  }
}

// In lockstep every pressure command that is due arrives sooner or later; the time of its arrival must not
// determine which command is in force.
inline bool PressureApp::AwaitsPressureCommand(int64_t state_tick) {
  const int64_t newest_allowed = SaturatingDifference(state_tick, delay_);
  if (!lockstep() || newest_allowed < 0) return false;
  const int64_t due = position_interval_.UpTo(newest_allowed);
  const int64_t known = !waiting_commands_.empty() ? waiting_commands_.back().tick
                        : pressure_command_        ? pressure_command_->tick
                                                   : -1;
  return known < due;
}

inline void PressureApp::TakePressureCommandsUpTo(int64_t tick) {
  while (!waiting_commands_.empty() && waiting_commands_.front().tick <= tick) {
    pressure_command_ = waiting_commands_.front();
    waiting_commands_.pop_front();
  }
}

std::string PressureApp::WhyNot(const tuned_settings_t& settings) const {
  if (own_) return "the pressure loop is a program of its user's own, which has its gains in itself";
  tuning::TunedValues values = values_;
  return tuning::Read(settings, k_2_, &values);
}

void PressureApp::TakeSettingsAt(int64_t tick) {
  const tuned_settings_t* settings = tuning_.TakeDueAt(tick);
  if (settings == nullptr) return;
  if (!law_before_) law_before_ = values_.pressure;
  tuning::Read(*settings, k_2_, &values_);  // valid, because it was prepared
  const double limit = LargestPressureReference(values_, half_dac_step_);
  limit_before_ = std::max(LargestReference(), limit);
  limit_from_ = tick;
  pressure_limit_ = limit;
}

// A command from before a tighter limit came into force is judged by the earlier limit.
double PressureApp::LargestReference() const {
  return pressure_command_ && pressure_command_->tick < limit_from_ ? limit_before_ : pressure_limit_;
}

// The gains have changed, and the voltage must not jump.
void PressureApp::BeginTransfer(const PressureLawInput& input, int64_t tick) {
  const double left = transfer_.Offset(tick);
  if (answered() >= 0 && acted_by_law_) {
    transfer_.Begin(UnlimitedPressureLaw(*law_before_, input) + left,
                    UnlimitedPressureLaw(values_.pressure, input), tick);
  }
  law_before_.reset();
}

inline void PressureApp::Compute(const state_t& state, bus::Clock::TimePoint now) {
  TakeSettingsAt(state.tick);
  TakePressureCommandsUpTo(SaturatingDifference(state.tick, delay_));
  motor_command_t& command = ZeroVolts(state.tick, motor_command_t::SAFE);
  follows_ = false;
  const int64_t stale = TicksStale(state.tick);
  if (pressure_command_) {
    command.pressure_ref = PressureReference(stale);
    command.pressure_command_tick = pressure_command_->tick;
  }
  if (!AllIsWell(state, stale, now) && !CheckInputs(state, stale, now)) {
    transfer_.Forget();
  } else {
    if (pressure_command_ && pressure_command_->open_loop) {
      ApplyOpenLoop(&command);
    } else {
      device_ == nullptr ? ApplyLaw(state, &command) : FollowOnDevice(state, &command);
    }
  }
  Send();
}

// The next command starts as a copy of this one.
inline motor_command_t& PressureApp::ZeroVolts(int64_t tick, int8_t status) {
  command_.tick = tick;
  command_.voltage = command_.pressure_ref = 0;
  command_.pressure_command_tick = -1;
  command_.saturated = 0;
  command_.status = status;
  return command_;
}

void PressureApp::ApplyOpenLoop(motor_command_t* command) const {
  command->status = motor_command_t::OPEN_LOOP;
  command->voltage =
      std::clamp(pressure_command_->voltage, -values_.pressure.voltage_limit, values_.pressure.voltage_limit);
  command->saturated = command->voltage != pressure_command_->voltage;
}

inline PressureLawOutput PressureApp::Law(const state_t& state, double pressure_ref) {
  if (own_) return OwnLaw(state, pressure_ref);
  PressureLawInput input{pressure_ref, state.p1, state.p2, state.motor_speed, state.arm_speed};
  if (law_before_) BeginTransfer(input, state.tick);
  input.transfer = transfer_.Offset(state.tick);
  return PressureLaw(values_.pressure, input);
}

PressureLawOutput PressureApp::OwnLaw(const state_t& state, double pressure_ref) const {
  const double asked = own_(state, pressure_ref), limit = values_.pressure.voltage_limit;
  const double voltage = std::isfinite(asked) ? std::clamp(asked, -limit, limit) : asked;
  return {.voltage = voltage, .saturated = voltage != asked};
}

inline void PressureApp::ApplyLaw(const state_t& state, motor_command_t* command) {
  const PressureLawOutput output = Law(state, command->pressure_ref);
  // The status stays SAFE.
  if (!std::isfinite(output.voltage)) return RaiseNonfinite(*command, output.voltage);
  command->status = motor_command_t::LAW;
  command->voltage = output.voltage;
  command->saturated = output.saturated;
  if (participant().any_fault()) participant().Clear("nonfinite_motor_command");
}

// The log shows the device's own answer to this state: the voltage that it has put out.
void PressureApp::FollowOnDevice(const state_t& state, motor_command_t* command) {
  law_before_.reset();  // the transition takes place on the device
  follows_ = true;
  const DeviceLoop::Answer answer = device_->Follow(state, command->pressure_ref, values_.pressure);
  command->status = answer.by_law ? motor_command_t::LAW : motor_command_t::OPEN_LOOP;
  command->voltage = answer.voltage;
  command->saturated = answer.saturated;
  if (answer.by_law) command->pressure_ref = answer.pressure_ref;
}

// The inputs are finite, but a product of gains and reference overflowed.
void PressureApp::RaiseNonfinite(const motor_command_t& command, double voltage) {
  participant().Raise("nonfinite_motor_command",
                      fmt::format("tick {}: {} gives {} V for a reference of {} {}, must be finite",
                                  command.tick, own_ ? "the loop's own law" : "eq. (16)", voltage,
                                  command.pressure_ref, units_.UnitFor("psi")),
                      voltage, NAN, false);
}

void PressureApp::Send() {
  command_.utime = participant().clock().Utime();
  command_.session = participant().session();
  command_.sequence = sequence_++;
  if (device_ != nullptr && !follows_) device_->Release();
  publisher_.Send(command_);
  set_answered(command_.tick);
  acted_by_law_ = command_.status == motor_command_t::LAW;
}

int64_t PressureApp::lost() const { return SaturatingSum(ControlLoop::lost(), command_monitor_.lost()); }

void PressureApp::OnSilence(bus::Clock::Duration silence) {
  if (silence <= stale_time_ || participant().active("stale_state")) return;
  ZeroVolts(participant().tick(), motor_command_t::SAFE);
  follows_ = false;
  Send();  // zero volts first, explanation second
  participant().Raise("stale_state",
                      fmt::format("no state for {:.0f} ms, allowed are {:.0f} ms (limits.stale_input_s)",
                                  1e3 * bus::ToSeconds(silence), 1e3 * bus::ToSeconds(stale_time_)),
                      bus::ToSeconds(silence), values_.limits.stale_input_s, false);
}

int PressureApp::Finish() {
  ZeroVolts(participant().tick(), motor_command_t::STOPPED);
  follows_ = false;
  Send();
  return participant().Leave();
}

}  // namespace hydro::pressure_ctrl
