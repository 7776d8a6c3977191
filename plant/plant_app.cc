#include "plant/plant_app.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "bus/output_left.h"
#include "plant/plant_pace.h"
#include "process/stop_signal.h"

namespace hydro::plant {
namespace {

// The channels on which loggers may report: a joint's logger may be that of its limb.
std::vector<bus::Channels> LoggersChannels(const settings::BusSection& bus) {
  std::vector<bus::Channels> channels{bus::Channels(bus.channel_suffix)};
  if (bus.limb_suffix) channels.emplace_back(*bus.limb_suffix);
  return channels;
}

RunStart::Options StartOf(const settings::StackConfig& config, const std::vector<std::string>& expected,
                          const std::string& program) {
  RunStart::Options options;
  options.roles = ExpectedRoles(expected);
  options.roles.insert(options.roles.begin(), {"pressure_ctrl", "position_ctrl"});
  options.joints = ExpectedJoints(expected);
  options.loggers = LoggersChannels(config.bus);
  options.timeout_s = config.time.start_timeout_s;
  options.description = DescriptionOf(config, program);
  options.description.model_file = config.model.resolved_file;
  options.description.model_text = config.model.text;
  return options;
}

}  // namespace

PlantApp::PlantApp(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config, Rig& rig,
                   const std::vector<std::string>& expected, const std::string& program,
                   std::function<bool()> heartbeat)
    : config_(config),
      rig_(rig),
      participant_(bus, clock, bus::Channels(config.bus.channel_suffix), rig.role(), config.agreed),
      safety_(participant_, config),
      tuning_(participant_, config, rig.simulated(),
              {.apply =
                   [this](const tuning::TunedValues& values) {
                     safety_.set_limits(values.limits);
                     rig_.SetNoise(values.noise);
                   },
               .held = [this] { return !safety_.Latched().empty(); }}),
      logger_watch_(participant_, LoggersChannels(config.bus),
                    bus::FromSeconds(std::max(config.limits.stale_logger_s,
                                              3 / (config.plant.rate_hz * config.time.speed)))),
      siblings_(participant_, config.siblings,
                {.follows = config.joints_concern_each_other,
                 .last_tick = config.last_tick,
                 .on_newcomer = [this] { participant_.RepeatFaults(); }}),
      start_(participant_, siblings_, StartOf(config, expected, program)),
      pacemaker_(config.time.mode == settings::TimeMode::kRealtime ? rig.pacemaker() : nullptr),
      commands_(participant_, config, safety_, start_.roll_call(), pacemaker_ != nullptr ? 1 : 0),
      launcher_watch_(std::move(heartbeat), config.limits.stale_supervisor_s, safety_),
      messages_(participant_, rig, config),
      program_(program),
      realtime_(config.time.mode == settings::TimeMode::kRealtime) {
  safety_.RefuseRearmWhile([this] {
    return tuning_.changing()
               ? "values are being changed, which may be limits: ask again when they are in force"
               : std::string();
  });
  participant_.OnRefusal([this](int64_t session, const std::string& text) { OnRefusal(session, text); });
}

int PlantApp::Run() {
  if (Begin()) Safely([this] { PlantPace(*this, config_, pacemaker_).Run(); });
  return End();
}

bool PlantApp::Begin() {
  participant_.Announce(process_status_t::READY);
  start_.Describe();
  const bool begins = start_.Await([this] { return Ended(); },
                                   [this](bus::Clock::TimePoint now) {
                                     PollDue(now);
                                     rig_.Attend();
                                   });
  if (begins) start_.Begin();
  return begins;
}

int PlantApp::End() {
  rig_.set_when_late([this] { RequestStop(); });
  const OutputLeft left = rig_.Zero();
  const std::string failure = left.accepted ? "" : NotAtZero(left);
  if (!failure.empty()) {
    if (participant_.stop()) spdlog::error("{}", failure);  // otherwise the stop request gives the reason
    participant_.RequestStop(failure, 1);
  }
  RequestStop();
  messages_.PublishOutputLeft(left);
  return participant_.Leave(failure);
}

void PlantApp::OnRigError(const RigError& error) {
  const auto explain = [&] {
    participant_.Raise(error.code(), error.what(), error.value(), error.limit(), true);
    participant_.RequestStop(error.what(), 1);
  };
  rig_.set_when_late(explain);
  rig_.Zero();  // zero volts first, explanation second
  rig_.set_when_late({});
  explain();
}

// Ends the run for every process and gives the reason, unless another process has done so already.
void PlantApp::RequestStop() {
  if (const process::StopRequest asked = process::StopReason(); !asked.reason.empty()) {
    participant_.RequestStop(asked.reason, 0, asked.role);
    return;
  }
  if (const int signal = process::StopSignal(participant_.bus()); signal != 0) {
    participant_.RequestStop(fmt::format("{} was stopped by signal {}", program_, signal), 0);
    return;
  }
  const std::string latched = safety_.Latched();
  const double time = messages_.state().time;
  participant_.RequestStop(
      latched.empty() ? fmt::format("{} after {} s", bus::kRunComplete, time)
                      : fmt::format("the run ends after {} s, stopped by {} and not re-armed", time, latched),
      latched.empty() ? 0 : 1);
}

std::string PlantApp::failure() const {
  const auto& stop = participant_.stop();
  return stop && stop->exit_code != 0 ? stop->source + ": " + stop->reason : "";
}

bool PlantApp::Ended() const {
  return participant_.stop().has_value() || process::StopSignal(participant_.bus()) != 0;
}

// A stack whose processes do not agree never starts. A process that joins a run later with another
// configuration is not obeyed and leaves, and the run goes on.
void PlantApp::OnRefusal(int64_t session, const std::string& text) {
  commands_.ForgetAllOf(session);
  if (participant_.state() == process_status_t::READY || start_.BeganWith(session)) {
    participant_.RequestStop(text, 1);
  }
}

inline void PlantApp::SetTick(int64_t tick) {
  tick_ = tick;
  commands_.SetTick(tick);
  participant_.set_tick(tick);
}

inline bus::Clock::TimePoint PlantApp::Publish(int64_t skipped_ticks, bus::Clock::TimePoint now) {
  now = commands_.BeforeSending(now);
  messages_.PublishState(tick_, skipped_ticks);
  return now;
}

bus::Clock::TimePoint PlantApp::Start(bus::Clock::TimePoint now) {
  messages_.Measure(0, 0, -1);
  SetTick(0);
  return Publish(0, now);
}

void PlantApp::AdvanceTo(int64_t tick) {
  tuning_.OnTick(tick);
  messages_.Measure(tick, voltage_, command_tick_);
  SetTick(tick);
}

bus::Clock::TimePoint PlantApp::PublishState(bus::Clock::TimePoint now) { return Publish(0, now); }

bus::Clock::TimePoint PlantApp::Wake(const WakeUp& wake_up) {
  const int64_t skipped = wake_up.elapsed - 1;
  participant_.statistics().set_missed_deadlines(wake_up.skipped);
  AdvanceTo(tick_ + wake_up.elapsed);  // under the voltage that was held during all of these ticks
  commands_.OnSlept(static_cast<double>(skipped) / (config_.plant.rate_hz * config_.time.speed));
  return Publish(skipped, wake_up.at);
}

bool PlantApp::AwaitAnswers() {
  auto now = participant_.clock().Now();
  return PlantPace(*this, config_, pacemaker_).AwaitAnswers(&now);
}

const char* PlantApp::Unanswered() const {
  if (const char* const loop = commands_.Unanswered()) return loop;
  return start_.loggers().HasTaken(tick_ - LoggerWindow::kTicks) ? nullptr : "logger";
}

void PlantApp::Check(bus::Clock::TimePoint now) {
  commands_.TakeEffect();
  if (!safety_.AllIsWell(messages_.state(), commands_.SafeInForce(), rig_.faults()) ||
      !commands_.AllIsWell(now)) {
    CheckAll(now);
  }
  if (realtime_) launcher_watch_.Check(tick_, now);
  safety_.CheckSuspended(now);
  if (!siblings_.follows()) return;
  HoldForSilence(siblings_.Silence(now));
  HoldForOthers(siblings_.Fault(now));
  if (const auto& stop = siblings_.stop()) participant_.RequestStop(stop->reason, stop->exit_code);
}

void PlantApp::CheckAll(bus::Clock::TimePoint now) {
  commands_.Check(now);
  safety_.CheckMeasured(messages_.state());
  safety_.CheckRig(rig_.faults());
  safety_.CheckOtherStack(now);
}

// Chooses the voltage of the command in force, or zero while any check fails.
void PlantApp::ChooseVoltage() {
  const motor_command_t* const obeyed = commands_.Obeyed(IsHeld());
  voltage_ = safety_.Voltage(obeyed != nullptr ? obeyed->voltage : 0);
  command_tick_ = obeyed != nullptr ? obeyed->tick : -1;
  rig_.Obey(command_tick_);
}

// Puts out the chosen voltage first and publishes the faults second.
void PlantApp::Drive() {
  voltage_ = rig_.Drive(voltage_);
  if (pacemaker_ != nullptr) command_tick_ = pacemaker_->acting_command_tick();
  messages_.PublishFaults(tick_);
  safety_.PublishFaults();
}

// The pressure loop reports its faults in its commands.
bool PlantApp::HasOwnFault() const {
  return safety_.holds_by_itself() || !rig_.faults().empty() || commands_.SafeInForce();
}

std::string PlantApp::OwnFault() const {
  if (!rig_.faults().empty()) return rig_.faults().front().code;
  const std::string cause = safety_.OwnCause();
  return cause.empty() ? "the pressure loop commands a safe output" : cause;
}

void PlantApp::HoldWhile(VoltageGuard::Cause cause, const std::string& text) {
  safety_.Set(cause, !text.empty(), [&] {
    return OutputSafety::Finding{fmt::format("tick {}: {}", tick_, text), NAN, NAN};
  });
}

void PlantApp::Poll(bus::Clock::TimePoint now) {
  const bool due = participant_.IsDue(now) || tuning_.IsDue(now) || start_.IsDue(now) ||
                   LostMessages() != participant_.statistics().lost_messages();
  if (due) PollDue(now);
}

void PlantApp::PollDue(bus::Clock::TimePoint now) {
  participant_.statistics().set_lost_messages(LostMessages());
  participant_.Poll(now);
  tuning_.Poll(now);
  start_.Poll(now);
}

}  // namespace hydro::plant
