// What a machine of hydro-experiment fig10_uncertainty costs, and its parts: the draw, the shortest possible
// settling time, the step; beside the bare model under the voltages of such a step. One thread.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "experiments/runs/shipped_models.h"
#include "experiments/runs/stack_run.h"
#include "experiments/studies/uncertain_machines.h"
#include "model/actuator.h"
#include "model/terms/description.h"
#include "tune/design/bang_bang.h"

namespace hydro::experiments {
namespace {

constexpr double kStep = 0.1;       // rad
constexpr double kWatched = 2;      // s
constexpr uint64_t kMachines = 64;  // different ones, in turns

const tune::StepTrial& Trial() {
  static const tune::StepTrial trial = RetunedTrial(kStep, kWatched);
  return trial;
}

// Machines a second, and of `state.iterations()` machines the ticks.
void Count(benchmark::State& state, bool ticks) {
  const auto count = static_cast<double>(state.iterations());
  state.counters["machines_per_s"] = benchmark::Counter(count, benchmark::Counter::kIsRate);
  if (!ticks) return;
  state.counters["s_per_tick"] = benchmark::Counter(
      count * (kWatched / Trial().tick + 1), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void Draw(benchmark::State& state) {
  uint64_t machine = 0;
  for (auto _ : state) benchmark::DoNotOptimize(model::DrawnModel(Trial().model, 1, machine++ % kMachines));
  Count(state, false);
}
BENCHMARK(Draw)->Unit(benchmark::kMicrosecond);

void ShortestSettling(benchmark::State& state) {
  const design::RigidDrive drive = design::MakeRigidDrive(Trial().model.parameters, 628);
  for (auto _ : state) benchmark::DoNotOptimize(design::FastestSettling(drive, kStep, 0.02));
  Count(state, false);
}
BENCHMARK(ShortestSettling)->Unit(benchmark::kMicrosecond);

void WholeMachine(benchmark::State& state) {
  uint64_t machine = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(StepOf(Trial(), model::DrawnModel(Trial().model, 1, machine++ % kMachines)));
  }
  Count(state, true);
}
BENCHMARK(WholeMachine)->Unit(benchmark::kMicrosecond);

// Table 1's own step, and its model alone under that step's voltages, from the stack.
void Table1(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(StepOf(Trial(), Trial().model));
  Count(state, true);
}
BENCHMARK(Table1)->Unit(benchmark::kMicrosecond);

void Table1ModelAlone(benchmark::State& state) {
  const std::string config = ShippedStackText(
      "retuned", {"reference.steps=[[0, 0.1]]", "time.duration_s=" + std::to_string(kWatched)});
  const tables::Table run = RunStackInProcess({"step", config, ShippedModelText("table1")});
  const std::vector<double>& voltages = run.Find("voltage_V")->values;
  for (auto _ : state) {
    model::Actuator actuator(Trial().model, {});
    for (size_t k = 0; k < voltages.size(); ++k) {
      actuator.Advance(voltages[k], static_cast<double>(k + 1) * Trial().tick);
    }
    benchmark::DoNotOptimize(actuator.Measure());
  }
  Count(state, true);
}
BENCHMARK(Table1ModelAlone)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace hydro::experiments

BENCHMARK_MAIN();
