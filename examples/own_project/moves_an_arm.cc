// moves_an_arm MODEL LOG: the simulated actuator under both laws moves its arm to 0.3 rad in two seconds.
// Every state goes over a bus into a log; prints what the log holds.
#include <cstdio>

#include "base/input_error.h"
#include "bus/in_process_bus.h"
#include "hydro/state_t.hpp"
#include "model/actuator.h"
#include "model/terms/parameter_info.h"
#include "position_ctrl/law/position_law.h"
#include "pressure_ctrl/law/pressure_law.h"
#include "process/fault_codes.h"
#include "runs/log/log_reader.h"
#include "runs/log/log_writer.h"
#include "settings/model_file.h"

namespace {

constexpr double kTarget = 0.3;   // rad
constexpr double kTick = 0.0002;  // s
constexpr int kTicks = 10'000;
constexpr int kTicksOfPosition = 25;  // 200 Hz

void Run(const hydro::model::ModelDescription& description, const std::string& file) {
  hydro::model::Actuator actuator(description, {});
  const hydro::model::Parameters& p = description.parameters;
  const auto gains = hydro::pressure_ctrl::DerivePressureGains(p, 0, 150, 0.5, 1);
  const hydro::pressure_ctrl::PressureLawSettings pressure{
      .gains = gains,
      .voltage_limit = p.T_pmax / p.k_1,
      .reference_feedforward = SteadyStateFeedforward(p, gains),
      .arm_speed_ratio = p.c / p.D};
  hydro::position_ctrl::PositionLaw position(
      {.c1 = 6000, .c2 = 1200, .sample_interval = kTick * kTicksOfPosition});

  hydro::bus::SimulatedClock clock;
  hydro::bus::InProcessBus bus(&clock);
  hydro::log::LogWriter log(file, hydro::Opening::kTemporary);
  bus.Subscribe<hydro::state_t>("HYDRO_STATE", [&](const hydro::state_t& state) {
    log.AppendMessage("HYDRO_STATE", state, state.utime);
  });
  double pressure_ref = 0;
  for (int tick = 0; tick < kTicks; ++tick) {
    const hydro::model::Measurement now = actuator.Measure();
    if (tick % kTicksOfPosition == 0) pressure_ref = position.Update(now.arm_angle, kTarget, 1);
    const double voltage = PressureLaw(pressure, {.pressure_ref = pressure_ref,
                                                  .p1 = now.p1,
                                                  .p2 = now.p2,
                                                  .motor_speed = now.motor_speed,
                                                  .arm_speed = now.arm_speed})
                               .voltage;
    hydro::state_t state{};
    state.utime = static_cast<int64_t>(actuator.time() * 1e6);
    state.tick = tick;
    state.time = tick * kTick;
    state.arm_angle = now.arm_angle;
    bus.Publish("HYDRO_STATE", state);
    bus.HandleUntil(clock.Now());
    actuator.Advance(voltage, (tick + 1) * kTick);
  }
  log.Finish();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    Run(hydro::settings::LoadModelFile(argv[1]), argv[2]);
  } catch (const hydro::InputError& error) {  // one line that says what is wrong with a file
    std::fprintf(stderr, "moves_an_arm: %s\n", error.what());
    return 2;
  }

  hydro::log::LogReader log(argv[2]);
  hydro::log::LogEvent event;
  hydro::state_t last{};
  int events = 0;
  for (; log.Next(event); ++events) {
    if (!DecodeAs(event, last)) return 1;
  }
  std::printf("%d states, arm at %.4f rad, %zu effects in the catalogue\n", events, last.arm_angle,
              hydro::model::EffectCatalogue().size());
  return 0;
}
