// hydro-torture: the whole stack in simulation, under faults drawn from a seed.
#include <spdlog/spdlog.h>

#include <chrono>
#include <cstdio>

#include "settings/command_line.h"
#include "torture/torture_config.h"
#include "torture/world.h"

int main(int argc, char** argv) {
  int64_t seed = 1, count = 1;
  hydro::settings::CommandLine line("hydro-torture", "The whole stack in simulation under seeded faults.");
  line.AddOption("--seed", &seed, "N the first seed");
  line.AddOption("--count", &count, "N how many");
  if (const auto code = line.Parse(argc, argv)) return *code;
  return hydro::settings::RunProgram("hydro-torture", [&] {
    spdlog::set_level(spdlog::level::off);
    hydro::torture::Coverage all;
    const auto start = std::chrono::steady_clock::now();
    for (int64_t i = seed; i < seed + count; ++i) {
      const auto schedule = hydro::torture::DrawSchedule(static_cast<uint64_t>(i));
      const auto config = hydro::torture::ConfigFor(schedule, "");
      hydro::torture::World world(schedule, config);
      const auto outcome = world.Run();
      all.Add(outcome.coverage);
      for (const auto& v : outcome.violations) {
        std::printf("seed %lld: %.6f s: %s: %s\n", static_cast<long long>(i),
                    static_cast<double>(v.at) * 1e-9, v.invariant.c_str(), v.text.c_str());
      }
      if (!outcome.violations.empty()) std::printf("%s", ScheduleText(schedule).c_str());
      if (count == 1) std::printf("trace %016llx\n", static_cast<unsigned long long>(outcome.trace));
    }
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::printf("%.1f s simulated in %.3f s: %.0f times real time\n%s", all.simulated_s, wall,
                all.simulated_s / wall, all.Report().c_str());
    return 0;
  });
}
