#include "launch/launch_plan.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "base/word_list.h"
#include "process/own_program.h"
#include "process/status.h"
#include "settings/limb_processes.h"
#include "settings/process_sections.h"

namespace hydro::launch {
namespace {

namespace fs = std::filesystem;

constexpr char kLogger[] = "hydro-logger";

std::string FindProgram(const std::string& program, const std::string& programs_folder) {
  const fs::path beside = fs::path(programs_folder) / program;
  if (std::error_code error; fs::is_regular_file(beside, error) && access(beside.c_str(), X_OK) == 0) {
    return beside.string();
  }
  if (std::string found = process::ProgramOnPath(program); !found.empty()) return found;
  throw InputError(program + ": program not found, neither in " + programs_folder +
                   " (beside hydro-launch) nor on PATH; build or install it");
}

bool IsHere(const std::string& host) { return host.empty() || host == "localhost"; }

bool Matches(const std::string& process_host, const std::string& wanted) {
  return IsHere(wanted) ? IsHere(process_host) : process_host == wanted;
}

std::string Join(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string RoleOf(const settings::ProcessSection& process) {
  return process.command.empty() ? process::RoleOf(process.program) : process.role;
}

// Whether the process waits for the logger before the run begins.
bool AwaitsLogger(const settings::ProcessSection& process, const LaunchRequest& request) {
  return !request.log_file.empty() && process::IsPlant(RoleOf(process));
}

// The joints that a limb's process runs, when it does not run them all.
std::vector<std::string> ChosenJoints(const settings::ProcessSection& process,
                                      const settings::StackConfig& config) {
  std::vector<std::string> joints = settings::JointsOf(process, config);
  if (process.role != "limb" || joints == config.joints) return {};
  return joints;
}

std::set<std::string> HostsOf(const settings::StackConfig& config) {
  std::set<std::string> hosts;
  for (const settings::ProcessSection& process : config.processes) {
    if (!process.host.empty()) hosts.insert(process.host);
  }
  return hosts;
}

// Throws InputError when `request.host` does not match the hosts that the configuration names.
void CheckHost(const settings::StackConfig& config, const LaunchRequest& request) {
  const std::set<std::string> hosts = HostsOf(config);
  if (request.host.empty()) {
    std::set<std::string> others = hosts;
    others.erase("localhost");
    if (others.empty()) return;
    throw InputError(
        request.config_file + ": [[process]] names the hosts " + Join(hosts) +
        "; run hydro-launch on each of them with --host NAME, or remove the hosts to run everything "
        "here");
  }
  if (!IsHere(request.host) && !hosts.contains(request.host)) {
    throw InputError("--host " + request.host + ": no such host in the [[process]] sections of " +
                     request.config_file +
                     "; allowed: " + (hosts.empty() ? "none is named there" : Join(hosts)));
  }
}

// The loops of a stack that drives a machine would wait for its driver without end. Joints of a limb may be
// driven from elsewhere.
void CheckDriverIsStarted(const settings::StackConfig& config, const LaunchRequest& request) {
  const bool starts = std::any_of(config.processes.begin(), config.processes.end(),
                                  [](const auto& process) { return process::IsPlant(RoleOf(process)); });
  if (!config.driver || !config.joints.empty() || starts) return;
  throw settings::KeyError(request.config_file, "process", "none that drives the machine of [driver]",
                           config.driver->kind == settings::DriverKind::kOwn
                               ? "a section [[process]] with command = [...] and role = \"driver\", or with "
                                 "program = \"hydro-plant\" for the model instead"
                               : "a section [[process]] with program = \"hydro-driver\", or \"hydro-plant\" "
                                 "for the model instead");
}

// The processes of this host, in the configuration's order; adds remarks on those that run elsewhere.
std::vector<settings::ProcessSection> ProcessesHere(const settings::StackConfig& config,
                                                    const LaunchRequest& request,
                                                    std::vector<std::string>* remarks) {
  const bool with_log = !request.log_file.empty();
  std::vector<settings::ProcessSection> here;
  bool names_logger = false;
  for (const settings::ProcessSection& process : config.processes) {
    if (RoleOf(process) == "driver")
      settings::CheckDriver(config, process.command.empty() ? process.program : settings::NameOf(process));
    const bool logger = process.program == kLogger;
    names_logger |= logger;
    if (logger && !with_log) continue;  // such a section only states where and how a logger would run
    if (Matches(process.host, request.host)) {
      here.push_back(process);
    } else if (IsHere(process.host)) {
      remarks->push_back(settings::NameOf(process) + " names no host in " + request.config_file +
                         " and is not started by --host " + request.host);
    } else if (logger) {
      remarks->push_back("the log is written on host " + process.host + " (its [[process]] section says so)");
    }
  }
  if (with_log && !names_logger) here.emplace_back().program = kLogger;
  return here;
}

// The joints of the limb that other processes run, here or on another host: a plant, a driver or a limb
// begins when those joints are present.
std::vector<std::string> JointsElsewhere(const settings::ProcessSection& process, const ChildSpec& child,
                                         const settings::StackConfig& config) {
  std::vector<std::string> elsewhere;
  if (!process::IsPlant(process.role)) return elsewhere;
  for (const std::string& joint : config.joints) {
    if (std::find(child.joints.begin(), child.joints.end(), joint) == child.joints.end())
      elsewhere.push_back(joint);
  }
  return elsewhere;
}

ChildSpec ChildFor(const settings::ProcessSection& process, const settings::StackConfig& config,
                   const LaunchRequest& request, const std::string& programs_folder) {
  const std::string& program = process.program;
  ChildSpec child;
  child.label = process::RoleOf(program) + (process.joint.empty() ? "" : "_" + process.joint);
  child.argv = {FindProgram(program, programs_folder), request.config_file};
  for (const std::string& override : request.overrides) {
    child.argv.push_back("--set");
    child.argv.push_back(override);
  }
  if (!process.joint.empty()) child.argv.insert(child.argv.end(), {"--joint", process.joint});
  for (const std::string& joint : ChosenJoints(process, config)) {
    child.argv.insert(child.argv.end(), {"--joints", joint});
  }
  if (program != kLogger) child.joints = settings::JointsOf(process, config);
  if (program == kLogger) {
    child.last = true;
    child.argv.insert(child.argv.end(), {"-o", request.log_file});
    if (request.force) child.argv.emplace_back("--force");
  } else if (AwaitsLogger(process, request)) {
    child.argv.insert(child.argv.end(), {"--expect", "logger"});
  }
  for (const std::string& joint : JointsElsewhere(process, child, config)) {
    child.argv.insert(child.argv.end(), {"--expect", "joint:" + joint});
  }
  return child;
}

// The program runs in the configuration's folder: every relative path in its command starts there.
ChildSpec OwnChildFor(const settings::ProcessSection& section, const settings::StackConfig& config,
                      const LaunchRequest& request, const std::string& programs_folder) {
  const fs::path file = fs::absolute(request.config_file).lexically_normal();
  OwnChild own;
  own.role = section.role;
  own.name = settings::NameOf(section);
  own.folder = file.parent_path().string();
  process::OwnTask task{section.role, file.string(), request.overrides};
  if (AwaitsLogger(section, request)) task.expected.emplace_back("logger");
  own.environment = process::OwnEnvironment(config, task, programs_folder);
  own.cpu = section.cpu;
  own.priority = section.priority;
  ChildSpec child;
  child.label = section.role;
  child.argv = section.command;
  child.argv.front() =
      process::FindOwnProgram(section.command.front(), own.folder, section.place + ": process.command");
  child.own = std::move(own);
  return child;
}

// With the options that say which bus and joint are meant; the others do not matter to a stop.
std::string StopCommand(const LaunchRequest& request) {
  std::string command = "hydro-launch " + ShellWord(request.config_file) + " --stop";
  for (const std::string& override : request.overrides) {
    if (override.starts_with("bus.") || override.starts_with("joint="))
      command += " --set " + ShellWord(override);
  }
  return command;
}

}  // namespace

LaunchPlan PlanLaunch(const settings::StackConfig& config, const LaunchRequest& request,
                      const std::string& programs_folder) {
  LaunchPlan plan;
  plan.timing_file = request.timing_file;
  plan.stop_command = StopCommand(request);
  const std::vector<settings::ProcessSection> here = ProcessesHere(config, request, &plan.remarks);
  CheckHost(config, request);
  CheckDriverIsStarted(config, request);
  if (here.empty()) {
    throw InputError(request.config_file + ": nothing to start" +
                     (request.host.empty() ? "" : " on host " + request.host) +
                     "; hydro-logger runs only with --log FILE");
  }
  plan.spread = std::any_of(
      config.processes.begin(), config.processes.end(),
      [&](const settings::ProcessSection& process) { return !Matches(process.host, request.host); });
  for (const settings::ProcessSection& process : here) {
    plan.children.push_back(process.command.empty() ? ChildFor(process, config, request, programs_folder)
                                                    : OwnChildFor(process, config, request, programs_folder));
  }
  return plan;
}

}  // namespace hydro::launch
