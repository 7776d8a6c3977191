#include "plant/driver/driver_main.h"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>

#include "plant/driver/check_sensors.h"
#include "plant/driver/device.h"
#include "plant/driver/device_rig.h"
#include "plant/plant_app.h"
#include "process/child_lines.h"
#include "process/own_program.h"
#include "process/process_main.h"
#include "process/spawn.h"
#include "process/stderr_log.h"
#include "process/stop_signal.h"
#include "process/timing/real_time.h"
#include "settings/process_sections.h"
#include "settings/stack_config.h"

namespace hydro::plant {
namespace {

constexpr std::chrono::seconds kStart(5);  // of the program that stands for the device
constexpr int kExit_ms = 1000;             // its time to end

// driver.simulated_device: a program that stands for a device and that the driver starts and ends.
class StandIn {
 public:
  // If the configuration names a program, starts it in the configuration's folder and waits for its line
  // "ready". Throws InputError when there is no such program, or when it does not become ready.
  explicit StandIn(const settings::StackConfig& config);
  ~StandIn() { End(); }
  StandIn(const StandIn&) = delete;
  StandIn& operator=(const StandIn&) = delete;

 private:
  void End();

  pid_t pid_ = -1;
};

StandIn::StandIn(const settings::StackConfig& config) {
  const std::vector<std::string>& command = config.driver->simulated_device;
  if (command.empty()) return;
  const std::string folder = std::filesystem::absolute(config.file).lexically_normal().parent_path().string();
  process::SpawnRequest request;
  request.argv = command;
  request.argv.front() =
      process::FindOwnProgram(command.front(), folder, config.file + ": driver.simulated_device");
  request.folder = folder;
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) {
    throw DeviceError("driver.simulated_device: cannot make a pipe for it: " + process::ReasonOf(errno));
  }
  request.out = ends[1];
  try {
    pid_ = process::Spawn(request).pid;
  } catch (...) {
    close(ends[0]);
    close(ends[1]);
    throw;
  }
  close(ends[1]);
  const std::string instead =
      process::ChildLines(ends[0]).Await("ready", std::chrono::steady_clock::now() + kStart);
  close(ends[0]);  // the program ignores SIGPIPE; its further output is lost
  if (!instead.empty()) {
    End();
    throw settings::KeyError(config.file, "driver.simulated_device", command.front() + ", which " + instead,
                             "a program that says \"ready\" within " + std::to_string(kStart.count()) +
                                 " s: start it by hand to see why (docs/own_driver.md)");
  }
  spdlog::warn("{} stands for the device (driver.simulated_device): nothing real moves", command.front());
}

void StandIn::End() {
  if (pid_ < 0) return;
  kill(-pid_, SIGTERM);  // and what it has started
  for (int i = 0; i < kExit_ms; ++i) {
    if (waitpid(pid_, nullptr, WNOHANG) != 0) return;
    usleep(1000);
  }
  kill(-pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

constexpr char kOurs[] = "hydro-driver";

std::vector<std::string> LinesOf(const char* variable) {
  const char* text = std::getenv(variable);
  std::istringstream stream(text != nullptr ? text : "");
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// Reads what hydro-launch passes to a program of the user's own, whose command line belongs to the user.
void AddFromEnvironment(settings::CommonOptions* options, std::vector<std::string>* expected) {
  if (!options->config.empty()) return;
  if (const char* config = std::getenv("HYDRO_CONFIG")) options->config = config;
  if (options->config.empty()) {
    throw InputError("found no CONFIG, allowed the stack's configuration, as an argument or in HYDRO_CONFIG");
  }
  const std::vector<std::string> overrides = LinesOf("HYDRO_SET");
  options->overrides.insert(options->overrides.begin(), overrides.begin(), overrides.end());
  const std::vector<std::string> awaited = LinesOf("HYDRO_EXPECT");
  expected->insert(expected->end(), awaited.begin(), awaited.end());
}

// hydro-launch sets the processor and the priority of a program of the user's own; but only the program
// itself can lock its memory.
void LockMemory(const settings::StackConfig& config) {
  const settings::ProcessSection* section = settings::OwnProgramFor(config, "driver");
  if (section == nullptr || section->priority == 0) return;
  timing::RealTimeRequest request;
  request.lock_memory = true;
  timing::ApplyRealTime(request);
}

std::unique_ptr<Device> Open(const OpenDevice& open, const settings::StackConfig& config,
                             const bus::Clock& clock, bool drives) {
  settings::SectionReader own(config.driver->own, "driver.own");
  DeviceSettings settings{config, config.driver->device, own, clock, drives};
  std::unique_ptr<Device> device = open(settings);
  own.Finish();
  return device;
}

int CheckSensorsOf(const RigProgram& program, const settings::CommonOptions& options) {
  const settings::StackConfig config = settings::LoadStackConfig(options.config, options.overrides);
  settings::CheckDriver(config, program.name);
  process::CatchStopSignals();
  const process::StderrLog log(program.name);  // lines of the same form as in a run
  const StandIn stand_in(config);
  const bus::WallClock clock;
  return program.check_sensors(config, clock);
}

int RunStack(const RigProgram& program, const settings::CommonOptions& options,
             const std::vector<std::string>& expected, const std::string& described) {
  return process::RunProcess(
      program.name, options, [&](bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config) {
        settings::CheckDriver(config, program.name);
        if (program.name != kOurs) LockMemory(config);
        const StandIn stand_in(config);  // must outlive the rig, which leaves it at zero volts
        const std::unique_ptr<Rig> rig = program.make_rig(config, clock);
        PlantApp app(bus, clock, config, *rig, expected, described, process::HeartbeatArrived);
        const std::function<void()> end_beside =
            program.beside ? program.beside(bus, clock, config, *rig) : std::function<void()>();
        const int exit_code = app.Run();
        if (end_beside) end_beside();
        return exit_code;
      });
}

}  // namespace

int RunRigProgram(int argc, char** argv, const RigProgram& program) {
  const std::string file = std::filesystem::path(argc > 0 ? argv[0] : "driver").filename().string();
  const bool own = program.name != kOurs;
  const std::string shown = own ? file : program.name;
  settings::CommandLine command_line(shown, program.about);
  command_line.AddExamples(program.examples, program.page);
  settings::CommonOptions options;
  std::vector<std::string> expected;
  bool check_sensors = false;
  command_line.AddCommon(&options, !own);
  command_line.AddOption(
      "--expect", &expected,
      "ROLE also wait for this process, besides the two controllers, e.g. logger; or for joint:NAME of "
      "the same limb");
  command_line.AddFlag("--check-sensors", &check_sensors,
                       "print the sensors' readings and drive nothing, for --duration or until stopped");
  if (const auto exit_code = command_line.Parse(argc, argv)) return *exit_code;
  return settings::RunProgram(shown, [&] {
    if (own) AddFromEnvironment(&options, &expected);
    return check_sensors ? CheckSensorsOf(program, options) : RunStack(program, options, expected, shown);
  });
}

int RunDriver(int argc, char** argv, const std::string& about, const OpenDevice& open) {
  RigProgram program;
  program.name = "driver";
  program.about = about;
  program.page = "docs/own_driver.md";
  program.make_rig = [&](const settings::StackConfig& config, const bus::Clock& clock) {
    return std::make_unique<DeviceRig>(config, clock, Open(open, config, clock, true));
  };
  program.check_sensors = [&](const settings::StackConfig& config, const bus::Clock& clock) {
    return CheckSensors(config, clock, *Open(open, config, clock, false));
  };
  return RunRigProgram(argc, argv, program);
}

}  // namespace hydro::plant
