#include "sim/torture/invariants/observer.h"

#include <fmt/format.h>

#include <cmath>

#include "bus/messages.h"
#include "process/fault_codes.h"
#include "sim/torture/invariants/plant_invariants.h"

namespace hydro::torture {
Observer::Observer(const settings::StackConfig& config, Network& network, const TrueTime* now,
                   Coverage& coverage)
    : config_(config),
      network_(network),
      now_(now),
      coverage_(coverage),
      state_(network.ChannelNumber(bus::Channels(config.bus.channel_suffix).Of<state_t>())),
      command_(network.ChannelNumber(bus::Channels(config.bus.channel_suffix).Of<motor_command_t>())),
      fault_(network.ChannelNumber(bus::Channels(config.bus.channel_suffix).Of<fault_t>())),
      stop_(network.ChannelNumber(bus::Channels(config.bus.channel_suffix).Of<stop_t>())),
      rearm_(network.ChannelNumber(bus::Channels(config.bus.channel_suffix).Of<rearm_t>())),
      configuration_(network.ChannelNumber(bus::Channels(config.bus.channel_suffix).Of<configuration_t>())),
      run_(network.ChannelNumber(bus::Channels(config.bus.channel_suffix).Of<run_description_t>())),
      statistics_(network.ChannelNumber(bus::Channels(config.bus.channel_suffix).Of<loop_statistics_t>())),
      output_left_(network.ChannelNumber(bus::Channels(config.bus.channel_suffix).Of<output_left_t>())),
      pressure_command_(
          network.ChannelNumber(bus::Channels(config.bus.channel_suffix).Of<pressure_command_t>())),
      reference_(network.ChannelNumber(bus::Channels(config.bus.channel_suffix).Of<arm_reference_t>())),
      settings_(network.ChannelNumber(bus::Channels(config.bus.channel_suffix).Of<tuned_settings_t>())) {
  if (!config.siblings.empty()) limb_.emplace(config, network, now);
}

PlantRecord& Observer::RecordOf(const SimulatedProcess& plant) {
  const auto number = static_cast<size_t>(plant.number());
  if (plants_.size() <= number) plants_.resize(number + 1);
  if (!plants_[number]) {
    plants_[number] = std::make_unique<PlantRecord>();
    newest_plant_ = plants_[number].get();
  }
  return *plants_[number];
}

void Observer::Report(const std::string& invariant, const std::string& text) {
  if (violations_.size() < 10) violations_.push_back({invariant, text, *now_});
}

void Observer::OnSent(const Packet& packet, const SimulatedProcess& sender) {
  if (limb_ && IsOfKnee(sender.role())) limb_->OnSent(packet, &coverage_);
  if (packet.channel == state_) OnState(packet, sender);
  if (packet.channel == fault_) OnFault(packet);
  if (packet.channel == stop_) OnStop(packet, sender);
  if (packet.channel == statistics_) OnStatistics(packet, sender);
  if (packet.channel == pressure_command_) OnPressureCommand(packet, sender);
  if (packet.channel == reference_) OnReference(packet, sender);
  if (packet.channel == settings_ && sender.role() == Role::kPlant) OnSettings(packet, RecordOf(sender));
  if (output_left_t left; packet.channel == output_left_ && Decode(packet, &left)) {
    PlantRecord& plant = RecordOf(sender);
    const bool zero = left.accepted != 0 && left.voltage == 0;
    (zero ? plant.left_zero : plant.left_other) = true;
  }
}

void Observer::OnStatistics(const Packet& packet, const SimulatedProcess& sender) {
  loop_statistics_t report;
  const auto counted = losses_.find(sender.number());
  if (counted == losses_.end() || !counted->second.lost() || !Decode(packet, &report) || !report.whole_run)
    return;
  if (report.lost_messages == *counted->second.lost()) return;
  Report("counts add up",
         fmt::format("{} says that it has lost {} states; {} of those sent to it did not arrive", report.role,
                     report.lost_messages, *counted->second.lost()));
}

// Whether the packet is a stop that must end this process.
bool Observer::OnStop(const Packet& packet, const SimulatedProcess& process) {
  stop_t stop;
  if (!Decode(packet, &stop)) return false;
  // A process that has heard no plant may obey any stop, because there is no run that the stop could harm.
  const bool in_a_run = process.role() == Role::kPlant || in_a_run_.contains(process.number());
  if (packet.origin == Origin::kForged && in_a_run) return false;
  stops_[process.number()].insert(stop.exit_code == 0 ? 0 : 1);
  return stop.addressee == 0 || stop.addressee == process.identity().session;
}

// A state must report the voltage that was really driven, so that a log tells what happened.
void Observer::OnState(const Packet& packet, const SimulatedProcess& sender) {
  constexpr size_t kVoltage = 8 + offsetof(state_t, voltage);
  if (sender.role() != Role::kPlant || packet.bytes.size() < kVoltage + 8) return;
  const double driven = RecordOf(sender).voltage;
  const auto said = std::bit_cast<double>(NumberAt(packet, kVoltage));
  if (said == driven) return;
  Report("a state says what was driven",
         fmt::format("tick {}: it says {:.17g} V, driven were {:.17g} V",
                     NumberAt(packet, 8 + offsetof(state_t, tick)), said, driven));
}

void Observer::OnFault(const Packet& packet) {
  fault_t fault;
  if (!Decode(packet, &fault)) return;
  if (fault.active) ++coverage_.codes[fault.code];
  const auto sender = static_cast<size_t>(packet.sender);
  if (sender >= plants_.size() || !plants_[sender] || !process::ZeroesVoltage(fault.code)) return;
  if (fault.active) {
    plants_[sender]->zero_faults[fault.code] = fault.latched;
  } else {
    plants_[sender]->zero_faults.erase(fault.code);
  }
}

// While a fault holds zero volts, an operator may loosen a limit.
void Observer::OnSettings(const Packet& packet, PlantRecord& plant) {
  tuned_settings_t settings;
  if (!Decode(packet, &settings) || settings.stage != tuned_settings_t::DECIDED) return;
  plant.next_limits_at = settings.acts_at;
  for (size_t i = 0; i < settings.names.size(); ++i) {
    if (settings.names[i].starts_with("limits.")) plant.next_limits[settings.names[i]] = settings.values[i];
  }
}

void Observer::OnHandled(const Packet& packet, const SimulatedProcess& receiver) {
  if (sealed_ && (packet.origin == Origin::kForged || packet.origin == Origin::kChanged)) {
    Report("with a key nothing forged or changed is handled",
           fmt::format("{} has handled such a message on {}", TargetName(static_cast<int>(receiver.role())),
                       network_.ChannelName(packet.channel)));
  }
  if (limb_ && receiver.role() == Role::kPlant) limb_->OnHandled(packet, receiver);
  if (packet.channel == state_ && receiver.role() == Role::kPosition)
    losses_[receiver.number()].Handle(packet);
  if (packet.channel == state_ || packet.channel == run_) in_a_run_.insert(receiver.number());
  if (packet.channel == state_) {
    if (packet.origin == Origin::kChanged) changed_state_ = *now_;
    if (packet.origin == Origin::kChanged && receiver.role() == Role::kPressure) OnChangedState(packet);
    return;
  }
  if (packet.channel == stop_ && !OnStop(packet, receiver)) return;
  // The process's plant seems to be misconfigured, so it leaves.
  if (packet.channel == configuration_ && packet.origin == Origin::kChanged)
    stops_[receiver.number()].insert(1);
  if (receiver.role() != Role::kPlant) return;
  PlantRecord& plant = RecordOf(receiver);
  if (packet.channel == command_) {
    OnCommand(packet, plant);
  } else if (packet.channel == stop_) {
    plant.Stop();
  } else if (packet.channel == rearm_) {
    rearm_t rearm;
    if (Decode(packet, &rearm) && rearm.kind == rearm_t::REQUEST &&
        rearm.addressee == receiver.identity().session) {
      plant.rearm_request = *now_;
    }
  } else if (packet.channel == run_ && packet.sender != receiver.number()) {
    run_description_t run;
    if (Decode(packet, &run) && run.session != receiver.identity().session) {
      plant.other_plant = *now_;
      if (!plant.other_plant_tick) plant.other_plant_tick = plant.tick;
    }
  }
}

// Without a key, nothing reveals that bad readings were turned into good ones on the way.
void Observer::OnChangedState(const Packet& packet) {
  constexpr size_t kTick = 8 + offsetof(state_t, tick);
  const auto sender = static_cast<size_t>(packet.sender);
  if (packet.bytes.size() < kTick + 8 || sender >= plants_.size() || !plants_[sender]) return;
  PlantRecord& plant = *plants_[sender];
  const int64_t tick = NumberAt(packet, kTick);
  if (tick >= 0 && tick <= plant.read_tick && tick > plant.read_tick - PlantRecord::kRemembered)
    plant.At(tick).changed = true;
}

void Observer::OnCommand(const Packet& packet, PlantRecord& plant) {
  constexpr bus::NumberPlaces kPlaces = bus::PlacesOf<motor_command_t>();
  constexpr size_t kVoltage = 8 + offsetof(motor_command_t, voltage);
  static const int64_t kHash = motor_command_t::getHash();
  static const auto kSize = static_cast<size_t>(motor_command_t().getEncodedSize());
  if (packet.bytes.size() < kSize || NumberAt(packet, 0) != kHash) return;  // undecodable
  ReceivedCommand command;
  command.tick = NumberAt(packet, kPlaces.tick);
  command.session = NumberAt(packet, kPlaces.session);
  command.sequence = NumberAt(packet, kPlaces.sequence);
  command.voltage = std::bit_cast<double>(NumberAt(packet, kVoltage));
  command.handled = *now_;
  if (misconfigured_.contains(command.session)) {
    // The command is refused and does not count. Until the misconfiguration is known, it may be obeyed.
    if (command.tick >= 0) plant.At(command.tick).answers[1] = command;
    return;
  }
  command.origin = packet.origin;
  plant.Receive(command);
}

void Observer::OnRead(const SimulatedProcess& plant, int64_t tick, const model::Measurement& measured,
                      int64_t suspended_ns) {
  PlantInvariants(*this, RecordOf(plant)).OnRead(tick, measured, suspended_ns);
}

void Observer::OnDrive(const SimulatedProcess& plant, int64_t tick, double voltage) {
  ++coverage_.ticks;
  PlantRecord& record = RecordOf(plant);
  if (record.heartbeat) record.unsupervised = plant.machine().Now() - *record.heartbeat;
  PlantInvariants(*this, record).OnDrive(tick, voltage);
  if (!limb_) return;
  if (const std::string wrong = limb_->OnDrive(plant, tick, voltage); !wrong.empty())
    Report("zero volts of all joints while one has a fault or is silent", wrong);
}

void Observer::SetOtherConfiguration(bool present) {
  if (!present) {
    other_configuration_ = -1;
  } else if (other_configuration_ < 0) {
    other_configuration_ = *now_;
  }
}

void Observer::CheckLeft(const PlantRecord& plant) {
  if (plant.zero_refused && (plant.left_zero || !plant.left_other)) {
    Report("a driver whose board refuses the zero says so", "the last driver did not");
  } else if (!plant.zero_refused && !plant.left_zero) {
    Report("a plant that ends leaves zero volts and says so", "the last plant did not");
  }
}

// Checks a pressure command, whatever a planner, an operator or a flipped bit asks for.
void Observer::OnPressureCommand(const Packet& packet, const SimulatedProcess& sender) {
  pressure_command_t command;
  if (sender.role() != Role::kPosition || !Decode(packet, &command)) return;
  const double limit = config_.limits.arm_torque_in_lbf / config_.model.description.parameters.k_2;
  if (std::fabs(command.pressure_ref) <= (1 + 1e-9) * limit && command.voltage == 0) return;
  Report("a pressure command is finite and within limits.arm_torque",
         fmt::format("tick {}: {} psi, {} V, allowed are +/- {} psi and 0 V", command.tick,
                     command.pressure_ref, command.voltage, limit));
}

// While the motor is held, the reference is where the arm is, and it returns from there.
void Observer::OnReference(const Packet& packet, const SimulatedProcess& sender) {
  constexpr int64_t kUnnoticed = 100;  // ticks, because states may be lost
  arm_reference_t reference;
  if (sender.role() != Role::kPosition || newest_plant_ == nullptr || !Decode(packet, &reference)) return;
  if (reference.value != reference_value_) reference_moved_ = *now_;
  reference_value_ = reference.value;
  const auto returns = static_cast<int64_t>(config_.limits.return_s * config_.plant.rate_hz);
  if (reference.tick > newest_plant_->tick ||
      reference.tick <= newest_plant_->zero_tick + returns + kUnnoticed)
    return;
  if (*now_ - changed_state_ < kChangedForgotten) return;
  if (std::fabs(reference.value) <= config_.limits.arm_angle_rad) return;
  Report("a reference is within limits.arm_angle",
         fmt::format("tick {}: {} rad, allowed are +/- {} rad", reference.tick, reference.value,
                     config_.limits.arm_angle_rad));
}

void Observer::OnEnd(const SimulatedProcess& process) {
  // LaunchInvariants checks launches.
  const bool other = process.role() == Role::kOperator || process.role() == Role::kLauncher;
  if (process.killed() || (other && process.failure().empty())) return;
  const std::string_view name = TargetName(static_cast<int>(process.role()));
  if (!process.failure().empty()) {
    Report("an application throws nothing", fmt::format("{} ended with: {}", name, process.failure()));
    return;
  }
  if (IsOfKnee(process.role())) return;  // only those of its messages matter that the others hear
  if (process.role() == Role::kPlant) {
    CheckLeft(RecordOf(process));
    // This holds however the run was ended.
    if (RecordOf(process).zero_refused && process.exit_code() == 1) return;
  }
  // A process that finds itself misconfigured leaves alone.
  if (process.misconfigured() && process.exit_code() == 1) return;
  const auto stop = stops_.find(process.number());
  const bool signalled = process.identity().stop_signal != 0;
  if (stop == stops_.end() && !signalled) {
    Report("a process ends only when told",
           fmt::format("{} ended by itself with exit code {}", name, process.exit_code()));
    return;
  }
  if (signalled && process.exit_code() == 0) return;
  if (stop != stops_.end() && stop->second.contains(process.exit_code())) return;
  Report("the exit code is that of the stop",
         fmt::format("{} ended with exit code {}", name, process.exit_code()));
}

}  // namespace hydro::torture
