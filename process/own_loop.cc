#include "process/own_loop.h"

#include <cstdlib>
#include <hydro/arm_reference_t.hpp>
#include <sstream>
#include <utility>

#include "process/process_main.h"

namespace hydro::process {
namespace {

constexpr char kRole[] = "position_ctrl";

settings::CommonOptions OptionsOfEnvironment() {
  settings::CommonOptions options;
  if (const char* config = std::getenv("HYDRO_CONFIG")) options.config = config;
  if (options.config.empty()) {
    throw InputError(
        "HYDRO_CONFIG: found nothing, allowed the path of the stack's configuration; hydro-launch sets it "
        "for a "
        "[[process]] with a command");
  }
  const char* set = std::getenv("HYDRO_SET");
  std::istringstream lines(set != nullptr ? set : "");
  for (std::string line; std::getline(lines, line);) options.overrides.push_back(line);
  return options;
}

}  // namespace

OwnPositionLoop::OwnPositionLoop(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config,
                                 PositionAnswer answer, ArmReference reference)
    : ControlLoop(bus, clock, config, kRole, config.position_interval_ticks),
      answer_(std::move(answer)),
      reference_(std::move(reference)) {
  participant().Announce(process_status_t::READY);
}

bool OwnPositionLoop::Answer(const state_t& state, bus::Clock::TimePoint /*arrival*/) {
  CountIntervals(state.tick);
  set_answered(state.tick);
  command_ = {};
  command_.tick = state.tick;
  command_.session = participant().session();
  command_.sequence = sequence_++;
  command_.utime = participant().clock().Utime();
  answer_(state, &command_);
  if (reference_) SendReference(state);
  Send();
  return true;
}

void OwnPositionLoop::SendReference(const state_t& state) {
  arm_reference_t reference{};
  reference.utime = command_.utime;
  reference.tick = state.tick;
  reference.session = participant().session();
  reference.sequence = command_.sequence;
  reference.signal = arm_reference_t::ARM_ANGLE;
  reference.value = reference_(state);
  participant().bus().Publish(participant().channels().Of<arm_reference_t>(), reference);
}

void OwnPositionLoop::Send() {
  participant().bus().Publish(participant().channels().Of<pressure_command_t>(), command_);
}

int OwnPositionLoop::Finish() {
  if (!participant().stop() && answered() >= 0) {
    command_ = {};
    command_.utime = participant().clock().Utime();
    command_.tick = participant().tick();
    command_.session = participant().session();
    command_.sequence = sequence_++;
    command_.open_loop = true;
    Send();
  }
  return participant().Leave();
}

int RunOwnLoop(const std::string& role, const ProcessBody& body) {
  return settings::RunProgram(role, [&] { return RunProcess(role, OptionsOfEnvironment(), body); });
}

int RunOwnPositionLoop(const PositionAnswer& answer, const ArmReference& reference) {
  return RunOwnLoop(kRole, [&](bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config) {
    OwnPositionLoop loop(bus, clock, config, answer, reference);
    return RunApp(bus, clock, loop);
  });
}

}  // namespace hydro::process
