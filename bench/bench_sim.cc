// How much faster than real time hydro-sim runs the whole stack at 5 kHz, with every message logged and
// without a log.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <string>

#include "log/log_writer.h"
#include "settings/stack_config.h"
#include "sim/simulation.h"

namespace hydro {
namespace {

constexpr double kDuration = 10;  // s of plant time

void Run(benchmark::State& state, bool logged) {
  const settings::StackConfig config =
      settings::LoadStackConfig(HYDRO_BENCH_CONFIG, {"time.duration_s=" + std::to_string(kDuration)});
  const std::string file = (std::filesystem::temp_directory_path() / "bench_sim.lcmlog").string();
  int64_t runs = 0;
  for (auto _ : state) {
    if (logged) {
      log::LogWriter writer(file, Opening::kTemporary);
      sim::Simulate(config, [&](const bus::RawMessage& m) {
        writer.Append(m.channel, m.data, static_cast<size_t>(m.size), m.receive_utime);
      });
      writer.Finish();
    } else {
      sim::Simulate(config, nullptr);
    }
    ++runs;
  }
  if (logged) std::filesystem::remove(file);
  state.counters["times_real_time"] =
      benchmark::Counter(kDuration * static_cast<double>(runs), benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(Run, every_message_logged, true)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(Run, without_a_log, false)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace hydro

BENCHMARK_MAIN();
