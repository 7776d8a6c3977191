#include "launch/launch_plan.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>

#include "process/role.h"

namespace hydro::launch {
namespace {

namespace fs = std::filesystem;

constexpr char kLogger[] = "hydro-logger";

bool IsProgram(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && access(path.c_str(), X_OK) == 0;
}

std::string FindProgram(const std::string& program, const std::string& programs_folder) {
  const fs::path beside = fs::path(programs_folder) / program;
  if (IsProgram(beside)) return beside.string();
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path found = fs::path(folder.empty() ? "." : folder) / program;
    if (IsProgram(found)) return found.string();
  }
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

bool SetsThePace(const std::string& program) { return program == "hydro-plant" || program == "hydro-driver"; }

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

// The programs of this host, in the configuration's order; adds remarks on those that run elsewhere.
std::vector<std::string> ProgramsHere(const settings::StackConfig& config, const LaunchRequest& request,
                                      std::vector<std::string>* remarks) {
  const bool with_log = !request.log_file.empty();
  std::vector<std::string> programs;
  bool names_logger = false;
  for (const settings::ProcessSection& process : config.processes) {
    if (process.program == "hydro-driver") settings::CheckDriver(config);
    const bool logger = process.program == kLogger;
    names_logger |= logger;
    if (logger && !with_log) continue;  // such a section only says where and how a logger would run
    if (Matches(process.host, request.host)) {
      programs.push_back(process.program);
    } else if (IsHere(process.host)) {
      remarks->push_back(process.program + " names no host in " + request.config_file +
                         " and is not started by --host " + request.host);
    } else if (logger) {
      remarks->push_back("the log is written on host " + process.host + " (its [[process]] section says so)");
    }
  }
  if (with_log && !names_logger) programs.push_back(kLogger);
  return programs;
}

ChildSpec ChildFor(const std::string& program, const LaunchRequest& request,
                   const std::string& programs_folder) {
  ChildSpec child;
  child.label = process::RoleOf(program);
  child.argv = {FindProgram(program, programs_folder), request.config_file};
  for (const std::string& override : request.overrides) {
    child.argv.push_back("--set");
    child.argv.push_back(override);
  }
  const bool with_log = !request.log_file.empty();
  if (program == kLogger) {
    child.last = true;
    child.argv.insert(child.argv.end(), {"-o", request.log_file});
  } else if (with_log && SetsThePace(program)) {
    child.argv.insert(child.argv.end(), {"--expect", "logger"});
  }
  return child;
}

}  // namespace

std::string OwnFolder() { return fs::read_symlink("/proc/self/exe").parent_path().string(); }

LaunchPlan PlanLaunch(const settings::StackConfig& config, const LaunchRequest& request,
                      const std::string& programs_folder) {
  LaunchPlan plan;
  plan.timing_file = request.timing_file;
  const std::vector<std::string> programs = ProgramsHere(config, request, &plan.remarks);
  CheckHost(config, request);
  if (programs.empty()) {
    throw InputError(request.config_file + ": nothing to start" +
                     (request.host.empty() ? "" : " on host " + request.host) +
                     "; hydro-logger runs only with --log FILE");
  }
  plan.spread = std::any_of(
      config.processes.begin(), config.processes.end(),
      [&](const settings::ProcessSection& process) { return !Matches(process.host, request.host); });
  for (const std::string& program : programs) {
    plan.children.push_back(ChildFor(program, request, programs_folder));
  }
  return plan;
}

}  // namespace hydro::launch
