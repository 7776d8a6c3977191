// How many stacks (plant, pressure loop, position loop: three processes each) one machine and one multicast
// segment can run in real time, on a port each and on one shared port with channel suffixes; how many joints
// a limb can have on one core; and how many of both hydro-sim can run in one process.
//   many_stacks [--seconds S] [--most N] [--rate HZ] [--priority P] [--joints N] [--limbs]
// Each row is compared with a single stack measured just before it, because the machine may have other work.
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/text_file.h"
#include "bench/shared_results.h"
#include "bus/udpm/open_udpm_bus.h"
#include "plant/plant_app.h"
#include "plant/simulated_rig.h"
#include "position_ctrl/position_app.h"
#include "pressure_ctrl/pressure_app.h"
#include "process/timing/real_time.h"
#include "settings/command_line.h"
#include "settings/stack_config.h"
#include "sim/limb/limb_app.h"
#include "sim/simulation.h"
#include "tests/free_udp_port.h"

namespace hydro {
namespace {

constexpr int kProcesses = 3;
constexpr int kRounds = 6;  // of the largest limb
// Deadlines count as lost when the share of ticks missed or answered late exceeds that of a single stack by
// more than this.
constexpr double kMostMissed = 0.01;

struct Options {
  int most = 16;
  double seconds = 4;
  double rate = 1000;
  int priority = 0;
  int joints = 40;  // of the largest limb
  int cpu = -1;
};

struct PlantResult {
  int64_t due = 0;       // ticks
  int64_t states = 0;    // published, one per tick that was not skipped
  int64_t commands = 0;  // motor commands received
  int64_t late = 0;      // motor commands received after the next tick
  int64_t pressure_commands = 0;
  bool done = false;
};

struct Row {
  double missed = 0;   // share of the ticks that the plant skipped
  double late = 0;     // share of the states answered after the next tick
  double cores = 0;    // processor time per plant time
  double sent = 0;     // messages a second
  double bytes = 0;    // bytes a second on Ethernet
  double arrived = 0;  // messages a second that the kernel delivered to all processes
  bool complete = true;
};

settings::StackConfig ConfigOf(const Options& options, const std::string& url, const std::string& suffix) {
  return settings::LoadStackConfig(
      HYDRO_BENCH_CONFIG, {"time.mode=realtime", "time.duration_s=" + std::to_string(options.seconds),
                           "time.start_timeout_s=60", "plant.rate_hz=" + std::to_string(options.rate),
                           "limits.stale_input_s=5", "bus.url=" + url, "bus.channel_suffix=" + suffix});
}

void RunPlant(const settings::StackConfig& config, PlantResult* result) {
  const auto opened = bus::OpenUdpmBus(config.bus.url);
  bus::UdpmBus& bus = *opened;
  bus::WallClock clock;
  const bus::Channels channels(config.bus.channel_suffix);
  plant::SimulatedRig rig(config);
  plant::PlantApp plant(bus, clock, config, rig);
  bus.Subscribe<motor_command_t>(channels.Of<motor_command_t>(), [&](const motor_command_t& command) {
    ++result->commands;
    if (command.tick < plant.tick()) ++result->late;
  });
  bus.Subscribe<pressure_command_t>(channels.Of<pressure_command_t>(),
                                    [&](const pressure_command_t&) { ++result->pressure_commands; });
  bus.Subscribe<state_t>(channels.Of<state_t>(), [&](const state_t&) { ++result->states; });
  result->done = plant.Run() == 0;
  result->due = plant.tick();
}

template <class Controller>
void RunController(const settings::StackConfig& config) {
  const auto opened = bus::OpenUdpmBus(config.bus.url);
  bus::UdpmBus& bus = *opened;
  bus::WallClock clock;
  Controller controller(bus, clock, config);
  process::RunApp(bus, clock, controller);
}

pid_t Fork(const Options& options, const std::function<void()>& work) {
  const pid_t pid = fork();
  if (pid < 0) throw std::runtime_error("fork failed; see `ulimit -u`");
  if (pid > 0) return pid;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  try {
    timing::RealTimeRequest request;
    request.priority = options.priority;
    request.cpu = options.cpu;
    timing::ApplyRealTime(request);
    work();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    _exit(1);
  }
  _exit(0);
}

// Bytes that a message takes on Ethernet: LCM, UDP and IP headers, the frame and the gap after it.
double WireBytes(const std::string& channel, int encoded_size) {
  return 8 + static_cast<double>(channel.size()) + 1 + encoded_size + 28 + 38;
}

double Seconds(const rusage& usage) {
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

Row Measure(int stacks, bool own_ports, const Options& options) {
  SharedResults<PlantResult> results(static_cast<size_t>(stacks));
  const std::string shared_url = FreeBusUrl();
  std::vector<pid_t> children;
  for (int i = 0; i < stacks; ++i) {
    const settings::StackConfig config =
        ConfigOf(options, own_ports ? FreeBusUrl() : shared_url, own_ports ? "" : "_" + std::to_string(i));
    children.push_back(Fork(options, [&] { RunController<pressure_ctrl::PressureApp>(config); }));
    children.push_back(Fork(options, [&] { RunController<position_ctrl::PositionApp>(config); }));
    children.push_back(Fork(options, [&, i] { RunPlant(config, &results[static_cast<size_t>(i)]); }));
  }
  double processor = 0;
  for (const pid_t child : children) {
    rusage usage{};
    int status = 0;
    wait4(child, &status, 0, &usage);
    processor += Seconds(usage);
  }
  const bus::Channels channels;
  Row row;
  double due = 0, states = 0, commands = 0, late = 0, pressure_commands = 0;
  for (int i = 0; i < stacks; ++i) {
    const PlantResult& result = results[static_cast<size_t>(i)];
    row.complete &= result.done;
    due += static_cast<double>(result.due);
    states += static_cast<double>(result.states);
    commands += static_cast<double>(result.commands);
    late += static_cast<double>(result.late);
    pressure_commands += static_cast<double>(result.pressure_commands);
  }
  row.missed = due > 0 ? std::max(0.0, 1 - states / due) : 1;
  row.late = commands > 0 ? late / commands : 1;
  row.cores = processor / options.seconds;
  row.sent = (states + commands + 2 * pressure_commands) / options.seconds;
  row.bytes = (states * WireBytes(channels.Of<state_t>(), state_t().getEncodedSize()) +
               commands * WireBytes(channels.Of<motor_command_t>(), motor_command_t().getEncodedSize()) +
               pressure_commands *
                   (WireBytes(channels.Of<pressure_command_t>(), pressure_command_t().getEncodedSize()) +
                    WireBytes(channels.Of<arm_reference_t>(), arm_reference_t().getEncodedSize()))) /
              options.seconds;
  row.arrived = row.sent * kProcesses * (own_ports ? 1 : stacks);
  return row;
}

void RealTime(bool own_ports, const Options& options) {
  std::printf("\nreal time at %g Hz, %s\n", options.rate,
              own_ports ? "each stack on a port of its own" : "all on one port, with channel suffixes");
  std::printf("%7s %8s %8s %12s %10s %8s %12s %12s %11s %8s\n", "stacks", "missed", "late", "missed by 1",
              "late by 1", "cores", "us/message", "messages/s", "arrivals/s", "Mbit/s");
  for (int stacks = 1; stacks <= options.most; stacks *= 2) {
    const Row alone = Measure(1, own_ports, options);
    const Row row = Measure(stacks, own_ports, options);
    std::printf("%7d %7.1f%% %7.1f%% %11.1f%% %9.1f%% %8.3f %12.1f %12.0f %11.0f %8.2f%s\n", stacks,
                100 * row.missed, 100 * row.late, 100 * alone.missed, 100 * alone.late, row.cores,
                1e6 * row.cores / row.sent, row.sent, row.arrived, 8e-6 * row.bytes,
                row.complete ? "" : "  not all ran to the end");
    std::fflush(stdout);
    if (stacks > 1 && row.missed + row.late > 2 * (alone.missed + alone.late) + kMostMissed) {
      std::printf("deadlines go at %d stacks\n", stacks);
      return;
    }
  }
  std::printf("deadlines are kept as well as by one stack, up to the %d stacks that were tried\n",
              options.most);
}

// A limb of so many joints of the same kind.
settings::LimbConfig LimbOf(int joints, const Options& options) {
  const std::filesystem::path config = std::filesystem::absolute(HYDRO_BENCH_CONFIG);
  std::string text = ReadTextFile(config.string());
  text = text.substr(0, text.find("[[process]]"));  // joints are in one process
  for (int i = 0; i < joints; ++i) text += "[[joint]]\nname = \"j" + std::to_string(i) + "\"\n";
  const std::string file = "/tmp/many_stacks-" + std::to_string(getpid()) + ".toml";
  std::ofstream(file) << text;
  const settings::LimbConfig limb = settings::LoadLimbConfig(
      file,
      {"time.mode=realtime", "time.duration_s=" + std::to_string(options.seconds),
       "plant.rate_hz=" + std::to_string(options.rate), "limits.stale_input_s=5", "bus.url=" + FreeBusUrl(),
       "model.file=" + (config.parent_path() / "models/table1.toml").string()});
  std::filesystem::remove(file);
  return limb;
}

struct LimbResult {
  int64_t ticks = 0;
  int64_t missed = 0;
  double late_p99_us = 0;
  double loop_s = 0;  // processor time between the start of the run and its end
};

double ThreadSeconds() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return Seconds(usage);
}

pid_t ForkLimb(const settings::LimbConfig& config, const Options& options, int cpu, LimbResult* result) {
  Options pinned = options;
  pinned.cpu = cpu;
  return Fork(pinned, [&] {
    const auto opened = bus::OpenUdpmBus(config.common.bus.url);
    bus::WallClock clock;
    limb::LimbApp app(*opened, clock, config, {});
    const double before = ThreadSeconds();
    app.Run();
    result->loop_s = ThreadSeconds() - before;
    const auto total = app.statistics().Total(clock.Now());
    result->ticks = app.limb().tick();
    result->missed = total.missed_deadlines;
    result->late_p99_us = total.latency_p99_us;
  });
}

// Many joints in a process on one core, and at the same time one joint on the other: whatever the machine
// does to one of them, it is likely to do to the other.
void Limbs(const Options& options) {
  std::printf(
      "\nlimbs at %g Hz: all joints in one process on core 0, telemetry at 50 Hz; beside it, at the same "
      "time, one "
      "joint on the other, in turns\n",
      options.rate);
  std::printf("%7s %8s %10s %14s | %15s %16s\n", "joints", "missed", "late p99", "us/joint/tick",
              "missed beside", "late p99 beside");
  std::vector<int> counts;
  for (int joints = 1; joints < options.joints; joints *= 4) counts.push_back(joints);
  for (int round = 0; round < kRounds; ++round) counts.push_back(options.joints);
  int turn = 0;
  for (const int joints : counts) {
    SharedResults<LimbResult> results(2);
    const settings::LimbConfig many = LimbOf(joints, options), one = LimbOf(1, options);
    const int core = turn++ % 2;  // one of them may also serve the machine's devices
    const pid_t children[] = {ForkLimb(many, options, core, &results[0]),
                              ForkLimb(one, options, 1 - core, &results[1])};
    for (const pid_t child : children) waitpid(child, nullptr, 0);
    const auto share = [](const LimbResult& r) {
      return r.ticks > 0 ? 100 * static_cast<double>(r.missed) / static_cast<double>(r.ticks) : 100.0;
    };
    std::printf("%7d %7.2f%% %10.0f %14.2f | %14.2f%% %16.0f\n", joints, share(results[0]),
                results[0].late_p99_us,
                1e6 * results[0].loop_s / static_cast<double>(joints) /
                    static_cast<double>(results[0].ticks - results[0].missed),
                share(results[1]), results[1].late_p99_us);
    std::fflush(stdout);
  }
}

// Many joints in hydro-sim, on one core.
void SimulatedLimb(const Options& options) {
  const int joints = 5 * options.joints;
  const settings::LimbConfig config = LimbOf(joints, options);
  const double before = ThreadSeconds();
  sim::SimulateLimb(config, nullptr);
  const double taken = ThreadSeconds() - before;
  std::printf("%d joints in hydro-sim: %.2f times real time on one core, %.2f us a joint and tick\n", joints,
              options.seconds / taken, 1e6 * taken / (options.seconds * options.rate * joints));
}

void Simulated(const Options& options) {
  const int stacks = std::min(options.most, 16);
  const settings::StackConfig config = settings::LoadStackConfig(
      HYDRO_BENCH_CONFIG, {"time.mode=lockstep", "time.duration_s=" + std::to_string(options.seconds),
                           "plant.rate_hz=" + std::to_string(options.rate)});
  const auto processor_time = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return Seconds(usage);
  };
  const double before = processor_time();
  for (int i = 0; i < stacks; ++i) sim::Simulate(config, nullptr);
  const double cores = (processor_time() - before) / options.seconds / stacks;
  std::printf("in hydro-sim (one process, simulated clock, the same messages and laws) at %g Hz\n",
              options.rate);
  std::printf("%d stacks: %.4f of a core for each at the pace of real time; one core carries %.0f\n", stacks,
              cores, 1 / cores);
}

}  // namespace
}  // namespace hydro

int main(int argc, char** argv) {
  hydro::settings::CommandLine line("many_stacks",
                                    "How many stacks a machine and a multicast segment carry.");
  hydro::Options options;
  bool limbs_alone = false;
  line.AddOption("--most", &options.most, "N the most stacks to try (default 16); rows are powers of two");
  line.AddOption("--seconds", &options.seconds, "S plant time of each run (default 4)");
  line.AddOption("--rate", &options.rate, "HZ ticks a second (default 1000)");
  line.AddOption("--joints", &options.joints, "N joints of the largest limb (default 40)");
  line.AddFlag("--limbs", &limbs_alone, "leave out stacks of processes");
  line.AddOption("--priority", &options.priority, "P SCHED_FIFO priority of all processes (default 0: none)");
  if (const auto code = line.Parse(argc, argv)) return *code;
  return hydro::settings::RunProgram("many_stacks", [&] {
    if (options.most < 1 || options.seconds < 1 || options.rate < 1 || options.joints < 1) {
      throw hydro::InputError(
          "--most, --seconds, --rate and --joints: found less than 1, allowed is 1 or more");
    }
    hydro::Simulated(options);
    hydro::SimulatedLimb(options);
    hydro::Limbs(options);
    if (limbs_alone) return 0;
    hydro::RealTime(true, options);
    hydro::RealTime(false, options);
    return 0;
  });
}
