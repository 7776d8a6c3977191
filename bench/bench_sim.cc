// What hydro-sim spends beside the model and the laws: the whole stack in one process at 5 kHz, with its
// messages, checks and statistics, beside the same ticks of model and laws alone, in pairs within one run.
// Goal: 1.6 times as long; and 1,000 times real time without a log.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <hydro/state_t.hpp>
#include <string>
#include <vector>

#include "base/maths/spread.h"
#include "bench/model_tick.h"
#include "plant/simulated_rig.h"
#include "runs/log/log_writer.h"
#include "settings/stack_config.h"
#include "sim/simulation.h"
#include "tune/design/configured_laws.h"

namespace hydro {
namespace {

constexpr int kSeconds = 10;  // of plant time
constexpr int kTicks = kSeconds * bench::kTicksPerSecond;
constexpr double kGoal = 1.6;

// Where the actuator is at the end: the two halves of a pair must agree, or they are no pair.
struct End {
  double p1 = 0;
  double p2 = 0;
  bool operator==(const End&) const = default;
};

// bench_model's loop.
End SquareWaveAlone(const settings::StackConfig& config) {
  model::Actuator actuator(config.model.description, plant::ActuatorOptionsOf(config));
  for (int tick = 0; tick < kTicks; ++tick) bench::AdvanceTick(actuator, tick);
  const model::Measurement m = actuator.Measure();
  return {m.p1, m.p2};
}

// Both loops of a configuration with one tick of delay.
End BothLoopsAlone(const settings::StackConfig& config) {
  model::Actuator actuator(config.model.description, plant::ActuatorOptionsOf(config));
  const auto pressure_law = design::PressureLawSettingsFor(config);
  position_ctrl::PositionLaw position_law(design::PositionLawSettingsFor(config));
  const auto reference = settings::MakeTrajectory(config.reference.trajectory);
  double pressure_ref = 0, asked_before = 0;
  for (int64_t tick = 0; tick < kTicks; ++tick) {
    const model::Measurement m = actuator.Measure();
    const double voltage = pressure_ctrl::PressureLaw(pressure_law, {.pressure_ref = pressure_ref,
                                                                     .p1 = m.p1,
                                                                     .p2 = m.p2,
                                                                     .motor_speed = m.motor_speed,
                                                                     .arm_speed = m.arm_speed})
                               .voltage;
    if (tick % config.position_interval_ticks == 0) {
      const double time = static_cast<double>(tick) / config.plant.rate_hz;
      pressure_ref = position_law.Update(m.arm_angle, reference->Value(time), 1);
    }
    actuator.Advance(asked_before, static_cast<double>(tick + 1) / config.plant.rate_hz);
    asked_before = voltage;
  }
  const model::Measurement m = actuator.Measure();
  return {m.p1, m.p2};
}

double SecondsOf(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void Simulate(const settings::StackConfig& config) {
  if (const auto result = sim::Simulate(config, nullptr); result.exit_code != 0) {
    std::fprintf(stderr, "bench_sim: %s\n", result.failure.c_str());
    std::exit(1);
  }
}

End EndOfSimulation(const settings::StackConfig& config) {
  state_t last{};
  sim::Simulate(config, [&](const bus::RawMessage& m) {
    if (m.channel == "HYDRO_STATE") last.decode(m.data, 0, m.size);
  });
  return {last.p1, last.p2};
}

using maths::Median;

using Alone = End (*)(const settings::StackConfig&);

void ComparePairs(const char* name, const settings::StackConfig& config, Alone alone, int pairs) {
  const bool same = alone(config) == EndOfSimulation(config);
  std::vector<double> model_s, stack_s, ratios;
  for (int i = 0; i < pairs; ++i) {
    model_s.push_back(SecondsOf([&] { alone(config); }));
    stack_s.push_back(SecondsOf([&] { Simulate(config); }));
    ratios.push_back(stack_s.back() / model_s.back());
  }
  const auto microseconds = [](const std::vector<double>& seconds) { return 1e6 * Median(seconds) / kTicks; };
  std::printf("%-34s %8.4f %8.4f %7.2f %8.1f %12.0f %s\n", name, microseconds(model_s), microseconds(stack_s),
              Median(ratios), kGoal, kSeconds / Median(stack_s), same ? "same" : "OTHER");
}

void MeasureLogged(const settings::StackConfig& config, int runs) {
  const std::string file = (std::filesystem::temp_directory_path() / "bench_sim.lcmlog").string();
  std::vector<double> seconds;
  seconds.reserve(static_cast<size_t>(runs));
  for (int i = 0; i < runs; ++i) {
    std::filesystem::remove(file);  // no log is written over another
    seconds.push_back(SecondsOf([&] {
      log::LogWriter writer(file, Opening::kTemporary);
      sim::Simulate(config, [&](const bus::RawMessage& m) {
        writer.Append(m.channel, m.data, static_cast<size_t>(m.size), m.receive_utime);
      });
      writer.Finish();
    }));
  }
  std::filesystem::remove(file);
  std::printf("%-34s %17.4f %29.0f\n", "the paper's, every message logged", 1e6 * Median(seconds) / kTicks,
              kSeconds / Median(seconds));
}

settings::StackConfig Config(std::vector<std::string> overrides) {
  overrides.push_back("time.duration_s=" + std::to_string(kSeconds));
  return settings::LoadStackConfig(HYDRO_BENCH_CONFIG, overrides);
}

// As bench_model has it: the command of a tick acts from that tick on.
settings::StackConfig SquareWave(const std::string& shaft) {
  return Config({"model.shaft=" + shaft, "plant.command_delay_ticks=0", "pressure.k_p=0.134",
                 "pressure.k_v=8.4", "reference.signal=pressure", "reference.kind=square",
                 "reference.amplitude=300", "reference.frequency_hz=10"});
}

}  // namespace
}  // namespace hydro

// bench_sim [PAIRS]
int main(int argc, char** argv) {
  using namespace hydro;
  const int pairs = argc > 1 ? std::max(1, std::atoi(argv[1])) : 31;
  std::printf("us per tick of 5 kHz, medians of %d pairs\n%-34s %8s %8s %7s %8s %12s %s\n", pairs, "",
              "alone", "stack", "ratio", "goal", "x real time", "pressures");
  ComparePairs("bench_model's, clamped", SquareWave("clamped"), SquareWaveAlone, pairs);
  ComparePairs("bench_model's, free arm", SquareWave("free"), SquareWaveAlone, pairs);
  ComparePairs("the paper's, both loops, free arm", Config({}), BothLoopsAlone, pairs);
  MeasureLogged(Config({}), pairs);
  return 0;
}
