#include "position_ctrl/position_app.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "base/input_error.h"
#include "model/sides.h"
#include "tune/design/configured_laws.h"

namespace hydro::position_ctrl {
namespace {

int8_t SignalCode(settings::ReferenceSignal signal) {
  switch (signal) {
    case settings::ReferenceSignal::kArmAngle:
      return arm_reference_t::ARM_ANGLE;
    case settings::ReferenceSignal::kPressure:
      return arm_reference_t::PRESSURE;
    case settings::ReferenceSignal::kTorque:
      return arm_reference_t::TORQUE;
    case settings::ReferenceSignal::kVoltage:
      return arm_reference_t::VOLTAGE;
  }
  return arm_reference_t::ARM_ANGLE;
}

}  // namespace

PositionApp::PositionApp(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config)
    : ControlLoop(bus, clock, config, "position_ctrl", config.position_interval_ticks),
      reference_publisher_(bus.Advertise<arm_reference_t>(participant().channels().Of<arm_reference_t>())),
      command_publisher_(
          bus.Advertise<pressure_command_t>(participant().channels().Of<pressure_command_t>())),
      signal_(config.reference.signal),
      reference_text_(settings::ReferenceText(config)),
      torque_per_pressure_(config.model.description.parameters.k_2),
      stop_(model::TravelOf(config.model.description).nearer()),
      areas_(model::DifferencesOf(config.model.description).areas),
      section_(config.position),
      parameters_(config.model.description.parameters),
      units_(config.model.description.units),
      start_angle_(config.model.arm_angle_rad),
      rate_hz_(config.plant.rate_hz),
      values_(tuning::ValuesOf(config)),
      law_(values_.position),
      curve_(design::BrakingCurveFor(config)),
      tuning_(participant(), config, [this](const tuned_settings_t& settings) { return WhyNot(settings); }),
      transfer_(std::llround(config.limits.transfer_s * config.plant.rate_hz)),
      return_(std::llround(config.limits.return_s * config.plant.rate_hz)) {
  bus.Subscribe<arm_plan_t>(participant().channels().Of<arm_plan_t>(),
                            [this](const arm_plan_t& plan) { OnPlan(plan); });
  bus.Subscribe<fault_t>(participant().channels().Of<fault_t>(), [this](const fault_t& fault) {
    pressure_faults_.Observe(fault, participant().clock().Now());
  });
  bus.Subscribe<active_faults_t>(participant().channels().Of<active_faults_t>(),
                                 [this](const active_faults_t& active) {
                                   pressure_faults_.Observe(active, participant().clock().Now());
                                 });
  bus.Subscribe<process_status_t>(participant().channels().Of<process_status_t>(),
                                  [this](const process_status_t& status) {
                                    if (status.role == "pressure_ctrl")
                                      pressure_faults_.ForgetOthersOfRole(status.role, status.session);
                                  });
  reference_in_force_ = reference_text_;
  Follow(config.reference.trajectory);
  participant().Announce(process_status_t::READY);
}

void PositionApp::BeginAnew() {
  return_.Reset();
  if (planner_) planner_->Reset();
}

// In lockstep no process is late, and the pressure loop's own reports may come at any tick.
void PositionApp::Observe(const state_t& state) {
  // A record that is replayed from its middle (on simulated time) is no such run: its loop had been there
  // before.
  const bool joins = answered() < 0 && state.tick > tuning::kJoiningSamples * interval().of();
  if (!lockstep() && joins && !participant().clock().simulated()) return_.Join();
  const bool safe = !lockstep() && pressure_faults_.any(participant().clock().Now());
  return_.Observe(state.tick, state.command_tick >= 0 && !safe, Present(state));
}

bool PositionApp::Answer(const state_t& state, bus::Clock::TimePoint /*arrival*/) {
  TakeSettingsAt(state.tick);
  if (answered() < 0) law_.Reset();
  const int64_t intervals = CountIntervals(state.tick);
  set_answered(state.tick);

  const PlannedPoint planned = planner_ ? planner_->At(state.tick) : PlannedPoint{};
  if (planner_) NotePlanner(state.tick);
  const double wanted = planner_ ? planned.angle : reference_->Value(state.time - reference_from_);
  const double reference = return_.Reference(wanted, state.tick);
  arm_reference_.tick = state.tick;
  arm_reference_.signal = SignalCode(signal_);
  arm_reference_.value = reference;

  pressure_command_.tick = state.tick;
  pressure_command_.open_loop = signal_ == settings::ReferenceSignal::kVoltage;
  pressure_command_.voltage = pressure_command_.open_loop ? reference : 0;
  double pressure_ref = 0;
  switch (signal_) {
    case settings::ReferenceSignal::kArmAngle:
      if (std::isfinite(state.arm_angle)) {
        pressure_ref =
            AskedByLaw(state, reference, reference == wanted ? planned : PlannedPoint{}, intervals);
        if (participant().any_fault()) participant().Clear("nonfinite_arm_angle");
      } else {
        // At zero volts, because without the arm's angle no pressure is safe.
        pressure_command_.open_loop = true;
        law_.Reset();
        transfer_.Forget();
        participant().Raise(
            "nonfinite_arm_angle",
            fmt::format("tick {}: the arm angle is {}, must be finite", state.tick, state.arm_angle),
            state.arm_angle, NAN, false);
      }
      break;
    case settings::ReferenceSignal::kPressure:
      pressure_ref = reference;
      break;
    case settings::ReferenceSignal::kTorque:
      pressure_ref = reference / torque_per_pressure_;
      break;
    case settings::ReferenceSignal::kVoltage:
      break;
  }
  pressure_ref = law_.Limited(pressure_ref);
  pressure_command_.pressure_ref = QuantiseDac(pressure_ref, section_.dac_bits, section_.dac_range_psi);

  arm_reference_.sequence = pressure_command_.sequence = sequence_++;
  arm_reference_.session = pressure_command_.session = participant().session();
  Send();
  return true;
}

// The present value of the quantity to which the reference refers.
inline double PositionApp::Present(const state_t& state) const {
  switch (signal_) {
    case settings::ReferenceSignal::kArmAngle:
      return state.arm_angle;
    case settings::ReferenceSignal::kPressure:
      return model::LoadPressure(areas_, state.p1, state.p2);
    case settings::ReferenceSignal::kTorque:
      return model::LoadPressure(areas_, state.p1, state.p2) * torque_per_pressure_;
    case settings::ReferenceSignal::kVoltage:
      return 0;
  }
  return 0;
}

void PositionApp::Send() {
  arm_reference_.utime = pressure_command_.utime = participant().clock().Utime();
  // The pressure command goes last: in lockstep the plant waits for it, so that a log has both before the
  // next state.
  reference_publisher_.Send(arm_reference_);
  command_publisher_.Send(pressure_command_);
}

void PositionApp::PollOthers(bus::Clock::TimePoint now) {
  tuning_.Poll(now);
  if (plans_refused_ == 0) return;
  refused_plans_.Update(
      plans_refused_, now,
      [&](int64_t count) {
        return fmt::format("{} plans in all are not followed; the newest: {}", count, plan_refused_);
      },
      participant());
}

int PositionApp::Finish() {
  if (!participant().stop() && participant().tick() >= 0) {
    // The run goes on without this loop, whose last pressure must not stay in force until it is stale.
    pressure_command_.utime = participant().clock().Utime();
    pressure_command_.tick = participant().tick();
    pressure_command_.session = participant().session();
    pressure_command_.sequence = sequence_++;
    pressure_command_.open_loop = true;
    pressure_command_.voltage = 0;
    pressure_command_.pressure_ref = 0;
    command_publisher_.Send(pressure_command_);
  }
  return participant().Leave();
}

}  // namespace hydro::position_ctrl
