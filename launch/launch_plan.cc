#include "launch/launch_plan.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>

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

bool DrivesTheRun(const std::string& program) {
  return program == "hydro-plant" || program == "hydro-driver";
}

}  // namespace

std::string RoleOf(const std::string& program) {
  std::string role = program.starts_with("hydro-") ? program.substr(6) : program;
  std::replace(role.begin(), role.end(), '-', '_');
  return role;
}

std::string OwnFolder() { return fs::read_symlink("/proc/self/exe").parent_path().string(); }

LaunchPlan PlanLaunch(const settings::StackConfig& config, const LaunchRequest& request,
                      const std::string& programs_folder) {
  const bool with_log = !request.log_file.empty();
  LaunchPlan plan;
  plan.timing_file = request.timing_file;
  std::set<std::string> hosts;
  std::vector<std::string> programs;
  bool names_logger = false;
  for (const settings::ProcessSection& process : config.processes) {
    if (process.program == "hydro-driver") settings::CheckDriver(config);
    const bool logger = process.program == kLogger;
    names_logger |= logger;
    if (!process.host.empty()) hosts.insert(process.host);
    if (logger && !with_log) continue;  // such a section only says where and how a logger would run
    if (Matches(process.host, request.host)) {
      programs.push_back(process.program);
    } else if (IsHere(process.host)) {
      plan.remarks.push_back(process.program + " names no host in " + request.config_file +
                             " and is not started by --host " + request.host);
    } else if (logger) {
      plan.remarks.push_back("the log is written on host " + process.host +
                             " (its [[process]] section says so)");
    }
  }

  if (request.host.empty()) {
    std::set<std::string> others = hosts;
    others.erase("localhost");
    if (!others.empty()) {
      throw InputError(
          request.config_file + ": [[process]] names the hosts " + Join(hosts) +
          "; run hydro-launch on each of them with --host NAME, or take the hosts out to run all here");
    }
  } else if (!IsHere(request.host) && !hosts.contains(request.host)) {
    throw InputError("--host " + request.host + ": no such host in the [[process]] sections of " +
                     request.config_file +
                     "; allowed: " + (hosts.empty() ? "none is named there" : Join(hosts)));
  }
  if (with_log && !names_logger) programs.push_back(kLogger);
  if (programs.empty()) {
    throw InputError(request.config_file + ": nothing to start" +
                     (request.host.empty() ? "" : " on host " + request.host) +
                     "; hydro-logger runs only with --log FILE");
  }
  plan.spread = std::any_of(
      config.processes.begin(), config.processes.end(),
      [&](const settings::ProcessSection& process) { return !Matches(process.host, request.host); });

  for (const std::string& program : programs) {
    ChildSpec child;
    child.label = RoleOf(program);
    child.argv = {FindProgram(program, programs_folder), request.config_file};
    for (const std::string& override : request.overrides) {
      child.argv.push_back("--set");
      child.argv.push_back(override);
    }
    if (program == kLogger) {
      child.last = true;
      child.argv.insert(child.argv.end(), {"-o", request.log_file});
    } else if (with_log && DrivesTheRun(program)) {
      child.argv.insert(child.argv.end(), {"--expect", "logger"});
    }
    plan.children.push_back(std::move(child));
  }
  return plan;
}

}  // namespace hydro::launch
