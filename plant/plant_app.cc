#include "plant/plant_app.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "bus/output_left.h"
#include "process/stop_signal.h"

namespace hydro::plant {
namespace {

using namespace std::chrono_literals;

// The time a participant may take to report its configuration; a program of the user's own never reports it.
constexpr auto kConfigurationTime = 300ms;
constexpr auto kDescriptionPeriod = 1s;  // often enough for logs and plots that start late

// The channels on which loggers may report: a joint's logger may be that of its limb.
std::vector<bus::Channels> LoggersChannels(const settings::BusSection& bus) {
  std::vector<bus::Channels> channels{bus::Channels(bus.channel_suffix)};
  if (bus.limb_suffix) channels.emplace_back(*bus.limb_suffix);
  return channels;
}

std::vector<std::string> WithControllers(std::vector<std::string> roles) {
  roles.insert(roles.begin(), {"pressure_ctrl", "position_ctrl"});
  return roles;
}

std::string NotAtZero(const OutputLeft& left) {
  const std::string holds =
      std::isnan(left.voltage) ? "cannot be read back" : fmt::format("reads back {:.4g} V", left.voltage);
  return fmt::format("the output has not taken zero volts at the end, and {}: cut the amplifier's supply",
                     holds);
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
      expected_joints_(ExpectedJoints(expected)),
      roll_call_(WithControllers(ExpectedRoles(expected))),
      program_(program),
      heartbeat_(std::move(heartbeat)),
      state_publisher_(bus.Advertise<state_t>(participant_.channels().Of<state_t>())),
      stale_time_(bus::FromSeconds(config.limits.stale_input_s)),
      stall_time_(bus::FromSeconds(config.time.stall_timeout_s)),
      realtime_(config.time.mode == settings::TimeMode::kRealtime),
      voltage_limit_((1 + 1e-9) * config.model.description.parameters.T_pmax /
                     config.model.description.parameters.k_1),
      pacemaker_(realtime_ ? rig.pacemaker() : nullptr),
      ticks_ahead_(pacemaker_ != nullptr ? 1 : 0),
      pressure_ticks_(config.pressure_interval_ticks),
      position_ticks_(config.position_interval_ticks),
      command_monitor_(stale_time_) {
  safety_.RefuseRearmWhile([this] {
    return tuning_.changing()
               ? "values are being changed, which may be limits: ask again when they are in force"
               : std::string();
  });
  const bus::Channels& channels = participant_.channels();
  bus.Subscribe<motor_command_t>(channels.Of<motor_command_t>(),
                                 [this](const motor_command_t& command) { OnMotorCommand(command); });
  bus.Subscribe<pressure_command_t>(
      channels.Of<pressure_command_t>(),
      [this](const pressure_command_t& command) { OnPressureCommand(command); });
  bus.Subscribe<process_status_t>(channels.Of<process_status_t>(),
                                  [this](const process_status_t& status) { roll_call_.Observe(status); });
  for (const bus::Channels& loggers : LoggersChannels(config.bus)) {
    bus.Subscribe<log_progress_t>(loggers.Of<log_progress_t>(), [this](const log_progress_t& progress) {
      // Only loggers that were present when the run began count, so that a flood of made-up ones is not
      // stored.
      const auto known = log_progress_.find(progress.session);
      if (known != log_progress_.end()) known->second = progress.tick;
    });
  }
  if (config.bus.limb_suffix) {
    bus.Subscribe<process_status_t>(bus::Channels(*config.bus.limb_suffix).Of<process_status_t>(),
                                    [this](const process_status_t& status) {
                                      if (status.role == "logger") roll_call_.Observe(status);
                                    });
  }
  participant_.OnRefusal([this](int64_t session, const std::string& text) { OnRefusal(session, text); });
}

void PlantApp::DescribeRun() {
  description_.session = participant_.session();
  description_.config_file = config_.file;
  description_.config_text = config_.text;
  description_.model_file = config_.model.resolved_file;
  description_.model_text = config_.model.text;
  description_.program = program_;
  description_.version = HYDRO_VERSION;
  description_.host = participant_.host();
  description_.rate_hz = config_.plant.rate_hz;
  description_.seed = config_.seed;
}

int PlantApp::Run() {
  if (Begin()) {
    Safely([this] { config_.time.mode == settings::TimeMode::kLockstep ? RunLockstep() : RunRealtime(); });
  }
  return End();
}

bool PlantApp::Begin() {
  DescribeRun();
  participant_.Announce(process_status_t::READY);
  PublishDescription();
  if (!WaitForParticipants()) return false;
  participant_.Announce(process_status_t::RUNNING);
  PublishDescription();
  took_part_ = roll_call_.Participants();
  for (const int64_t session : roll_call_.Loggers()) log_progress_.emplace(session, -1);
  return true;
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
  PublishOutputLeft(left);
  return participant_.Leave(failure);
}

void PlantApp::OnRigError(const RigError& error) {
  const auto explain = [&] {
    participant_.Raise(error.code(), error.what(), NAN, NAN, true);
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
  participant_.RequestStop(
      latched.empty()
          ? fmt::format("{} after {} s", bus::kRunComplete, state_.time)
          : fmt::format("the run ends after {} s, stopped by {} and not re-armed", state_.time, latched),
      latched.empty() ? 0 : 1);
}

std::string PlantApp::failure() const {
  const auto& stop = participant_.stop();
  return stop && stop->exit_code != 0 ? stop->source + ": " + stop->reason : "";
}

bool PlantApp::Ended() const {
  return participant_.stop().has_value() || process::StopSignal(participant_.bus()) != 0;
}

bool PlantApp::AllHaveSaidTheirConfiguration() const {
  const std::vector<int64_t> sessions = roll_call_.Participants();
  return std::all_of(sessions.begin(), sessions.end(),
                     [&](int64_t session) { return participant_.HasSaidItsConfiguration(session); });
}

// A stack whose processes do not agree never starts. A process that joins a run later with another
// configuration is not obeyed and leaves, and the run goes on.
void PlantApp::OnRefusal(int64_t session, const std::string& text) {
  ForgetCommandsOf(session);
  const std::vector<int64_t>& own = took_part_;
  const bool began_with_it = std::find(own.begin(), own.end(), session) != own.end();
  if (participant_.state() == process_status_t::READY || began_with_it) participant_.RequestStop(text, 1);
}

bool PlantApp::WaitForParticipants() {
  const auto start = participant_.clock().Now();
  const auto deadline = start + bus::FromSeconds(config_.time.start_timeout_s);
  auto next_notice = start + 2s;
  std::optional<bus::Clock::TimePoint> complete;
  while (!Ended()) {
    std::vector<std::string> absent = roll_call_.Missing();
    for (const std::string& joint : siblings_.Missing(expected_joints_)) absent.push_back(joint);
    const std::string missing = fmt::format("{}", fmt::join(absent, ", "));
    const auto now = participant_.clock().Now();
    auto until = now + 5ms;
    if (missing.empty()) {
      if (!complete) complete = now;
      if (AllHaveSaidTheirConfiguration() || now - *complete > kConfigurationTime) return true;
    } else {
      if (now >= deadline) {
        participant_.RequestStop(fmt::format("not ready after {} s (time.start_timeout_s): {}",
                                             config_.time.start_timeout_s, missing),
                                 1);
        return false;
      }
      if (now >= next_notice) {
        spdlog::info("waiting for {}", missing);
        next_notice = now + 2s;
      }
      until = std::min(now + 50ms, deadline);
    }
    participant_.bus().HandleUntil(until);
    PollDue(participant_.clock().Now());
    rig_.Attend();
  }
  return false;
}

// Puts out the chosen voltage first and publishes the faults second.
void PlantApp::Drive() {
  voltage_ = rig_.Drive(voltage_);
  if (pacemaker_ != nullptr) command_tick_ = pacemaker_->acting_command_tick();
  const std::vector<RigFault>& faults = rig_.faults();
  if (!faults.empty() || !rig_faults_.empty()) PublishRigFaults(faults);
  safety_.PublishFaults();
}

void PlantApp::PublishRigFaults(const std::vector<RigFault>& faults) {
  const auto still_there = [&](const std::string& code) {
    return std::any_of(faults.begin(), faults.end(), [&](const RigFault& f) { return f.code == code; });
  };
  for (const std::string& code : rig_faults_) {
    if (!still_there(code)) participant_.Clear(code);
  }
  rig_faults_.clear();
  for (const RigFault& fault : faults) {
    participant_.Raise(fault.code, fmt::format("tick {}: {}", tick_, fault.text), fault.value, fault.limit,
                       false);
    rig_faults_.push_back(fault.code);
  }
}

void PlantApp::PollDue(bus::Clock::TimePoint now) {
  participant_.statistics().set_lost_messages(LostMessages());
  participant_.Poll(now);
  tuning_.Poll(now);
  if (now >= next_description_) PublishDescription();
}

void PlantApp::PublishOutputLeft(const OutputLeft& left) {
  output_left_t message;
  message.utime = participant_.clock().Utime();
  message.tick = participant_.tick();
  message.session = participant_.session();
  message.role = participant_.role();
  message.accepted = left.accepted;
  message.voltage = left.voltage;
  participant_.bus().Publish(participant_.channels().Of<output_left_t>(), message);
}

void PlantApp::PublishDescription() {
  next_description_ = participant_.clock().Now() + kDescriptionPeriod;
  description_.utime = participant_.clock().Utime();
  participant_.bus().Publish(participant_.channels().Of<run_description_t>(), description_);
}

}  // namespace hydro::plant
