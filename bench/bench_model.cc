// One 5 kHz tick of the clamped plant (alpha = 0, Table 1) with its pressure loop, eq. (16), held between
// samples and following a +/-300 psi square wave of 10 Hz. Each path runs the same second repeatedly. The
// table at the end gives the time per tick, its ratio to the fastest path of the same run, and the largest
// difference from a tight reference.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "bench/model_tick.h"
#include "model/actuator.h"

namespace hydro {
namespace {

using bench::Table1Model;

constexpr int kTicks = bench::kTicksPerSecond;

// p2 - p1 at 0.05, 0.1, ... 1 s, by event-located integration with steps of 1e-6 s.
constexpr double kReference[] = {296.568239647, -318.759357681, 320.915787611, -320.29413467,
                                 320.064136811, -320.026163565, 320.038213305, -320.045615907,
                                 320.050248253, -320.052854252, 320.054262393, -320.055009572,
                                 320.055402546, -320.055608311, 320.055715807, -320.055771898,
                                 320.055801149, -320.055816398, 320.055824347, -320.055828489};

model::ActuatorOptions Clamped(model::Integrator integrator, double tolerance) {
  model::ActuatorOptions options;
  options.shaft = model::Shaft::kClamped;
  options.integrator = integrator;
  options.relative_tolerance = tolerance;
  return options;
}

struct Row {
  double us = 0;
  double error = 0;
};
std::map<std::string, Row> rows;  // sorted by name
std::vector<std::string> order;

void Tick(benchmark::State& state, const std::string& name, const model::ModelDescription& model,
          const model::ActuatorOptions& options, bool has_reference) {
  double error = 0;
  int64_t seconds = 0;
  for (auto _ : state) {
    model::Actuator actuator(model, options);
    for (int tick = 0; tick < kTicks; ++tick) {
      bench::AdvanceTick(actuator, tick);
      if ((tick + 1) % 250 == 0) {
        const model::Measurement m = actuator.Measure();
        error = std::max(error, std::abs(m.p2 - m.p1 - kReference[tick / 250]));
      }
    }
    ++seconds;
  }
  state.SetItemsProcessed(seconds * kTicks);
  state.counters["per_tick"] = benchmark::Counter(static_cast<double>(seconds) * kTicks,
                                                  benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  if (has_reference) state.counters["error_psi"] = error;
  if (!rows.contains(name)) order.push_back(name);
  rows[name].error = has_reference ? error : std::nan("");
}

void Register(const std::string& name, const model::ModelDescription& model,
              const model::ActuatorOptions& options, bool has_reference) {
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    Tick(state, name, model, options, has_reference);
  })->Unit(benchmark::kMillisecond);
}

// Keeps each path's time per tick for the table, and prints as usual.
class Reporter : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type == Run::RT_Iteration)
        rows[run.benchmark_name()].us = run.GetAdjustedCPUTime() * 1e3 / kTicks;
    }
    ConsoleReporter::ReportRuns(runs);
  }
};

}  // namespace
}  // namespace hydro

int main(int argc, char** argv) {
  using namespace hydro;
  Register("fast", Table1Model(), Clamped(model::Integrator::kFast, 1e-8), true);
  Register("auto", Table1Model(), Clamped(model::Integrator::kAuto, 1e-8), true);
  Register("erk", Table1Model(), Clamped(model::Integrator::kErk, 1e-8), true);
  Register("cvode", Table1Model(), Clamped(model::Integrator::kCvode, 1e-8), true);
  model::ActuatorOptions free = Clamped(model::Integrator::kFast, 1e-8);
  free.shaft = model::Shaft::kFree;
  Register("fast, free arm", Table1Model(), free, false);
  model::ModelDescription stribeck = Table1Model();
  stribeck.effects.push_back({"pump.stribeck", {{"static_excess", 0.5}, {"speed", 3.0}}, {}});
  Register("fast, pump.stribeck", stribeck, Clamped(model::Integrator::kFast, 1e-8), false);
  model::ModelDescription wave = Table1Model();
  wave.effects.push_back(
      {"line.wave", {{"frequency", 300.0}, {"volume_fraction", 0.2}, {"damping", 0.05}}, {}});
  Register("fast, line.wave", wave, Clamped(model::Integrator::kFast, 1e-8), false);
  benchmark::Initialize(&argc, argv);
  Reporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  double fastest = INFINITY;
  for (const std::string& name : order) fastest = std::min(fastest, rows[name].us);
  std::printf("\n%-22s %12s %8s %14s\n", "path", "us per tick", "ratio", "error, psi");
  for (const std::string& name : order) {
    std::printf("%-22s %12.4f %8.1f", name.c_str(), rows[name].us, rows[name].us / fastest);
    if (std::isfinite(rows[name].error)) std::printf(" %14.2g", rows[name].error);
    std::printf("\n");
  }
  return 0;
}
