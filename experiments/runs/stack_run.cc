#include "experiments/runs/stack_run.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "base/new_file.h"
#include "bus/channels.h"
#include "bus/udpm/udpm_url.h"
#include "runs/recorded/run_table.h"
#include "settings/stack_config.h"
#include "sim/simulation.h"

namespace hydro::experiments {
namespace {

// Collects the messages of a run from the bus.
class Recording {
 public:
  void Take(const bus::RawMessage& message) {
    bus::AnyMessage([&]<class Message>(const bus::MessageRow<Message>&) {
      if (message.channel != channels_.Of<Message>()) return false;
      if (log_.messages.Of<Message>().emplace_back().decode(message.data, 0, message.size) < 0) {
        throw std::logic_error("a message of our own on " + channels_.Of<Message>() + " does not decode");
      }
      return true;
    });
  }
  const runs::RunLog& log() const { return log_; }
  runs::RunLog& log() { return log_; }

 private:
  bus::Channels channels_;
  runs::RunLog log_;
};

// Runs a program to its end with its output in `output_file`. Returns its exit code, or 128 + N when signal N
// ended it. The program gets SIGTERM when this process dies.
int RunToItsEnd(const std::vector<std::string>& command, const std::string& output_file) {
  const int output = open(output_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (output < 0) throw std::system_error(errno, std::generic_category(), output_file);
  std::vector<char*> argv;
  argv.reserve(command.size() + 1);
  for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  const pid_t us = getpid();
  const pid_t pid = fork();
  if (pid == 0) {
    // Between fork and exec in a program with threads, only certain calls are safe.
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != us) _exit(1);
    dup2(output, STDOUT_FILENO);
    dup2(output, STDERR_FILENO);
    execv(argv[0], argv.data());
    _exit(127);
  }
  const int error = errno;
  close(output);
  if (pid < 0) throw std::system_error(error, std::generic_category(), "fork");
  int status = 0;
  while (waitpid(pid, &status, 0) < 0) {
    if (errno != EINTR) throw std::system_error(errno, std::generic_category(), "waitpid");
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string LastLines(const std::string& file, size_t count) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) {
    if (line.empty()) continue;
    lines.push_back(line);
    if (lines.size() > count) lines.erase(lines.begin());
  }
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : " | ") + line;
  return text.empty() ? "it printed nothing" : text;
}

}  // namespace

tables::Table RunStackInProcess(const StackSetup& setup) {
  settings::StackConfig config =
      settings::ParseStackConfig(setup.config, setup.name, setup.model, setup.name + " (model)");
  config.bus.channel_suffix.clear();
  Recording recording;
  recording.log().file = setup.name;
  const sim::SimulationResult result =
      sim::Simulate(config, [&](const bus::RawMessage& message) { recording.Take(message); });
  if (result.exit_code != 0) throw std::runtime_error(setup.name + ": the run failed: " + result.failure);
  return runs::ExportRun(recording.log());
}

StackRunner SeparateProcesses(const std::string& program_folder, const std::string& folder) {
  // Two real-time stacks at once would compete for the processor.
  auto one_at_a_time = std::make_shared<std::mutex>();
  return [=](const StackSetup& setup) {
    const std::lock_guard lock(*one_at_a_time);
    const settings::StackConfig parsed =
        settings::ParseStackConfig(setup.config, setup.name, setup.model, setup.name + " (model)");
    std::filesystem::create_directories(folder);
    const std::string stem = folder + "/" + setup.name;
    const std::string config = stem + ".toml";
    const std::string model = setup.name + ".model.toml";
    const std::string log = stem + ".lcmlog";
    WriteWholeFile(config, setup.config);
    WriteWholeFile(folder + "/" + model, setup.model);
    const bus::ReservedPort port;
    std::vector<std::string> command = {program_folder + "/hydro-launch",
                                        config,
                                        "--time",
                                        "realtime",
                                        "--log",
                                        log,
                                        "--force",  // what is left there belongs to a run without results
                                        "--set",
                                        "model.file=" + model,
                                        "--set",
                                        "bus.url=" + port.Url()};
    if (parsed.plant.command_delay_ticks == 0) {  // a command cannot act before it is computed
      command.insert(command.end(), {"--set", "plant.command_delay_ticks=1"});
    }
    const int exit_code = RunToItsEnd(command, stem + ".txt");
    if (exit_code != 0) {
      throw std::runtime_error(setup.name + ": hydro-launch ended with exit code " +
                               std::to_string(exit_code) + ": " + LastLines(stem + ".txt", 3));
    }
    return runs::ExportRun(runs::ReadRunLog(log));
  };
}

}  // namespace hydro::experiments
