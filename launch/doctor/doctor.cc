#include "launch/doctor/doctor.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstdio>
#include <set>

#include "base/text_file.h"
#include "process/status.h"
#include "settings/limb_config.h"

namespace hydro::launch {
namespace {

// The real-time checks assume this priority, that of config/realtime.toml, when there is no configuration.
constexpr int kUsualPriority = 80;

bool IsOf(const settings::ProcessSection& process, const std::string& host) {
  return host.empty() || process.host.empty() || process.host == host;
}

DoctorTask TaskOf(const std::string& config_file, const std::vector<std::string>& overrides,
                  const std::string& host) {
  DoctorTask task;
  if (config_file.empty()) {
    task.url = bus::ParseUdpmUrl(settings::BusSection().url);
    task.priority = task.plant_priority = kUsualPriority;
    task.rate_hz = settings::PlantSection().rate_hz;
    return task;
  }
  const settings::StackConfig config = settings::LoadCommonConfig(config_file, overrides);
  task.config = config_file;
  task.url = bus::ParseUdpmUrl(config.bus.url);
  task.channel_suffix = config.bus.channel_suffix;
  task.joint_suffixes = config.bus.joint_suffixes;
  task.open_network = task.url.ttl > 0 && config.bus.key_file.empty();
  if (config.time.mode == settings::TimeMode::kRealtime) task.stale_input_s = config.limits.stale_input_s;
  std::set<std::string> hosts;
  for (const settings::ProcessSection& process : config.processes) {
    hosts.insert(process.host);
    if (!IsOf(process, host)) continue;
    task.priority = std::max(task.priority, process.priority);
    if (process.cpu >= 0) task.cpus.push_back(process.cpu);
    const std::string role = process.command.empty() ? process::RoleOf(process.program) : process.role;
    if (config.time.mode != settings::TimeMode::kRealtime || !process::IsPlant(role)) continue;
    task.rate_hz = config.plant.rate_hz * config.time.speed;
    task.plant_priority = process.priority;
    task.plant_cpu = process.cpu;
  }
  if (!host.empty() && host != "localhost" && !hosts.contains(host)) {
    throw InputError("--host " + host + ": no such host in the [[process]] sections of " + config_file);
  }
  hosts.erase("");
  hosts.erase("localhost");
  task.several_hosts = hosts.size() > 1;
  return task;
}

}  // namespace

std::vector<Finding> Diagnose(const DoctorTask& task, const MachineFacts& facts) {
  std::vector<Finding> findings = DiagnoseNetwork(task, facts);
  for (Finding& finding : DiagnoseMachine(task, facts)) findings.push_back(std::move(finding));
  return findings;
}

int Problems(const std::vector<Finding>& findings) {
  return static_cast<int>(
      std::count_if(findings.begin(), findings.end(), [](const Finding& finding) { return !finding.ok; }));
}

std::string FindingsText(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& finding : findings) {
    text += fmt::format("{:<8} {:<19} {}\n", finding.ok ? "ok" : "problem", finding.check, finding.found);
    if (!finding.ok) text += fmt::format("{:<8} {:<19} fix: {}\n", "", "", finding.cure);
  }
  const int problems = Problems(findings);
  if (problems == 0) return text + "all is well\n";
  return text + fmt::format("{} problem{}; the fixes need root\n", problems, problems == 1 ? "" : "s");
}

int RunDoctor(const std::string& config_file, const std::vector<std::string>& overrides,
              const std::string& host) {
  const DoctorTask task = TaskOf(config_file, overrides, host);
  const std::vector<Finding> findings = Diagnose(task, GatherFacts(task));
  std::fputs(PrintableLines(FindingsText(findings)).c_str(), stdout);
  return Problems(findings) == 0 ? 0 : 1;
}

}  // namespace hydro::launch
