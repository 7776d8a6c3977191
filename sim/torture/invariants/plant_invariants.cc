#include "sim/torture/invariants/plant_invariants.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "process/safety/safety_table.h"

namespace hydro::torture {
namespace {

// Ticks, from docs/safety.md.
const int64_t kDeadLoop = process::TicksWithin("pressure_loop_dies");
const int64_t kStop = process::TicksWithin("stop");
const int64_t kTwoSenders = process::TicksWithin("two_motor_command_senders");
const int64_t kTwoPlants = process::TicksWithin("two_plants");
// s. The plant looks for heartbeats every 10 ms, and may wake late by 20 ms (fault_kinds.cc: slow) each time.
constexpr double kHeartbeatNoticed_s = 0.06;
constexpr TrueTime kOtherPlantAlive = 2'400'000'000;       // ns; a plant describes itself once a second
constexpr TrueTime kConfigurationNoticed = 2'500'000'000;  // ns; a plant describes itself once a second

}  // namespace

int64_t PlantInvariants::stale_ticks() const {
  const settings::StackConfig& config = observer_.config_;
  return static_cast<int64_t>(std::ceil(config.limits.stale_input_s * config.plant.rate_hz));
}

void PlantInvariants::Latch(int64_t tick, const std::string& why) {
  if (plant_.latched.empty()) plant_.latched_tick = tick;
  plant_.latched = why;
  plant_.latched_at = *observer_.now_;
}

bool PlantInvariants::IsOverLimit(int64_t tick, const model::Measurement& measured) {
  if (plant_.next_limits_at >= 0 && tick >= plant_.next_limits_at) {
    plant_.limits = plant_.next_limits;
    plant_.next_limits_at = -1;
  }
  const auto limit = [this](const char* name, double configured) {
    const auto changed = plant_.limits.find(name);
    return changed == plant_.limits.end() ? configured : changed->second;
  };
  const settings::LimitsSection& configured = observer_.config_.limits;
  const double pressure = limit("limits.pressure", configured.pressure_psi);
  return measured.p1 > pressure || measured.p2 > pressure ||
         std::fabs(measured.motor_speed) > limit("limits.motor_speed", configured.motor_speed_rad_s) ||
         std::fabs(measured.arm_angle) > limit("limits.arm_angle", configured.arm_angle_rad);
}

void PlantInvariants::OnRead(int64_t tick, const model::Measurement& measured, int64_t suspended_ns) {
  if (plant_.voltage != 0) {
    for (const auto& [code, latched] : plant_.zero_faults) {
      observer_.Report("zero volts while a fault is active",
                       fmt::format("tick {}: {:.6g} V since tick {} with {} active", tick, plant_.voltage,
                                   plant_.tick, code));
    }
  }
  const settings::LimitsSection& limits = observer_.config_.limits;
  plant_.read_tick = tick;
  PlantRecord::Tick& entry = plant_.At(tick);
  const bool over = IsOverLimit(tick, measured);
  entry.sound = !over && std::isfinite(measured.p1) && std::isfinite(measured.p2) &&
                std::isfinite(measured.motor_speed);
  plant_.over_limit = over;
  if (over && tick > 0) Latch(tick, "a limit was exceeded");
  const double suspended_s = static_cast<double>(suspended_ns - plant_.suspended_ns) * 1e-9;
  if (tick > 0 && suspended_s > limits.stale_input_s) Latch(tick, "the machine was suspended");
  plant_.suspended_ns = suspended_ns;
  if (plant_.tick >= 0 && realtime()) {
    const int64_t missed = tick - plant_.tick - 1;
    if (missed > stale_ticks()) plant_.woke_tick = tick;
  }
}

void PlantInvariants::OnDrive(int64_t tick, double voltage) {
  CheckRange(tick, voltage);
  CheckSenders(tick, voltage);
  CheckOtherPlant(tick, voltage);
  if (voltage != 0) {
    CheckOrigin(tick, voltage);
    CheckLatched(tick);
    CheckStopped(tick);
    CheckSupervised(tick);
    CheckOtherConfiguration(tick);
    observer_.last_obeyed_ = *observer_.now_;
  }
  plant_.tick = tick;
  plant_.voltage = voltage;
  if (voltage == 0) plant_.zero_tick = tick;
  plant_.driven = *observer_.now_;
}

void PlantInvariants::CheckRange(int64_t tick, double voltage) {
  const model::Parameters& parameters = observer_.config_.model.description.parameters;
  const double limit = (1 + 1e-9) * parameters.T_pmax / parameters.k_1;
  if (std::isfinite(voltage) && std::fabs(voltage) <= limit) return;
  observer_.Report("the voltage is finite and within limits",
                   fmt::format("tick {}: {} V, allowed are +/- {} V", tick, voltage, limit));
}

// Checks where a voltage comes from: it must come from a command that was received, genuine, fresh, and
// computed from sound readings.
void PlantInvariants::CheckOrigin(int64_t tick, double voltage) {
  const int64_t delay = observer_.config_.plant.command_delay_ticks;
  // A plant that wakes late may also use the ticks through which it slept.
  const int64_t slept = tick - std::max<int64_t>(plant_.tick, 0);
  const int64_t allowed =
      realtime() ? stale_ticks() + kDeadLoop + slept : observer_.config_.pressure_interval_ticks - 1;
  // Without a key, nothing tells a changed message, or one forged in a genuine sender's name, from others.
  const ReceivedCommand* const made_up = plant_.NewestFalse(voltage);
  if (made_up != nullptr && made_up->origin == Origin::kChanged) return;
  const auto command = plant_.Newest(voltage, 0, tick - delay);
  if (!command) {
    // Nor can the plant tell who belongs to the stack while it hears no other process.
    const auto alive = static_cast<TrueTime>(observer_.config_.limits.stale_input_s * 1e9);
    if (made_up != nullptr && made_up->silence > alive) return;
    observer_.Report("no command is obeyed that is forged or of another run",
                     fmt::format("tick {}: {:.17g} V, which {} commanded", tick, voltage,
                                 made_up != nullptr ? "an intruder" : "nobody"));
    return;
  }
  if (command->tick < tick - delay - allowed) {
    observer_.Report("no command is obeyed that is stale",
                     fmt::format("tick {}: {:.6g} V of the command for tick {}, allowed is {} or later", tick,
                                 voltage, command->tick, tick - delay - allowed));
  }
  if (const PlantRecord::Tick& answered = plant_.At(command->tick); !answered.sound && !answered.changed) {
    observer_.Report("no voltage from bad readings",
                     fmt::format("tick {}: {:.6g} V, computed from the readings of tick {}", tick, voltage,
                                 command->tick));
  }
  if (command->session == plant_.obeyed_session && command->tick < plant_.obeyed_tick) {
    observer_.Report("no command is obeyed that is repeated",
                     fmt::format("tick {}: {:.6g} V of the command for tick {} after that for tick {}", tick,
                                 voltage, command->tick, plant_.obeyed_tick));
  }
  plant_.obeyed_session = command->session;
  plant_.obeyed_tick = command->tick;
  if (plant_.woke_tick < 0) return;
  if (command->tick < plant_.woke_tick) {
    observer_.Report("after a hang of the plant: zero volts until a command from after it",
                     fmt::format("tick {}: {:.6g} V of the command for tick {}; it went on at tick {}", tick,
                                 voltage, command->tick, plant_.woke_tick));
  }
  plant_.woke_tick = -1;
}

void PlantInvariants::CheckLatched(int64_t tick) {
  if (plant_.latched.empty()) return;
  const bool explicit_rearm = observer_.config_.limits.rearm == settings::Rearm::kExplicit;
  if (explicit_rearm && plant_.rearm_request >= plant_.latched_at) {
    plant_.latched.clear();  // an operator has asked since then
    return;
  }
  observer_.Report("latched stays latched",
                   fmt::format("tick {}: not at zero although {} at tick {}, and nobody has re-armed", tick,
                               plant_.latched, plant_.latched_tick));
}

void PlantInvariants::CheckStopped(int64_t tick) {
  if (!plant_.stop_tick || tick <= *plant_.stop_tick + kStop) return;
  observer_.Report("zero volts after a stop",
                   fmt::format("tick {}: not at zero, stopped at tick {}", tick, *plant_.stop_tick));
}

void PlantInvariants::CheckSupervised(int64_t tick) {
  const double silence_s = bus::ToSeconds(plant_.unsupervised);
  // In lockstep a plant waits for its loops, and no launcher is needed.
  if (!realtime() || silence_s <= observer_.config_.limits.stale_supervisor_s + kHeartbeatNoticed_s) return;
  observer_.Report("zero volts without a launcher",
                   fmt::format("tick {}: not at zero, no heartbeat for {:.3f} s", tick, silence_s));
}

// Checks for two sessions within the time during which one counts as alive.
void PlantInvariants::CheckSenders(int64_t tick, double voltage) {
  // The time is reduced because the plant's clock may run fast (fault_kinds.cc: drift).
  const auto alive = static_cast<TrueTime>(0.96 * observer_.config_.limits.stale_input_s * 1e9);
  if (plant_.senders.size() < 2) return;
  std::erase_if(plant_.senders, [&](const auto& entry) { return *observer_.now_ - entry.second > alive; });
  if (plant_.senders.size() < 2) {
    plant_.two_senders_tick.reset();
    return;
  }
  if (!plant_.two_senders_tick) plant_.two_senders_tick = tick;
  if (voltage == 0 || tick <= *plant_.two_senders_tick + kTwoSenders) return;
  observer_.Report("at most one sender is obeyed",
                   fmt::format("tick {}: {:.6g} V, and two have sent commands since tick {}", tick, voltage,
                               *plant_.two_senders_tick));
}

void PlantInvariants::CheckOtherPlant(int64_t tick, double voltage) {
  if (!plant_.other_plant_tick) return;
  if (*observer_.now_ - plant_.other_plant > kOtherPlantAlive) {
    plant_.other_plant_tick.reset();
    return;
  }
  if (voltage == 0 || tick <= *plant_.other_plant_tick + kTwoPlants) return;
  observer_.Report("zero volts with another stack on the network",
                   fmt::format("tick {}: {:.6g} V, another plant was heard at tick {}", tick, voltage,
                               *plant_.other_plant_tick));
}

void PlantInvariants::CheckOtherConfiguration(int64_t tick) {
  if (observer_.other_configuration_ < 0 ||
      *observer_.now_ - observer_.other_configuration_ < kConfigurationNoticed) {
    return;
  }
  observer_.Report("processes with different configurations do not run together unnoticed",
                   fmt::format("tick {}: the motor is driven", tick));
}

}  // namespace hydro::torture
