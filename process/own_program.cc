#include "process/own_program.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>

#include "base/input_error.h"
#include "base/number_text.h"
#include "base/text_file.h"

namespace hydro::process {
namespace {

namespace fs = std::filesystem;

bool IsFile(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

bool IsProgram(const fs::path& path) { return IsFile(path) && access(path.c_str(), X_OK) == 0; }

std::string Lines(const std::vector<std::string>& words) {
  std::string lines;
  for (const std::string& word : words) lines += (lines.empty() ? "" : "\n") + word;
  return lines;
}

}  // namespace

std::string ProgramOnPath(const std::string& name, const char* otherwise) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : otherwise);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path found = fs::path(folder.empty() ? "." : folder) / name;
    if (IsProgram(found)) return fs::absolute(found).string();
  }
  return "";
}

std::string FindOwnProgram(const std::string& command, const std::string& folder, const std::string& place) {
  const fs::path beside = fs::absolute(fs::path(folder) / command).lexically_normal();
  const std::string found = place + ": found " + Quoted(command);
  if (command.find('/') == std::string::npos) {
    if (std::string path = ProgramOnPath(command); !path.empty()) return path;
    if (IsFile(beside)) {
      throw InputError(found + ", which is not on PATH, allowed " + Quoted("./" + command) + " for " +
                       beside.string());
    }
    throw InputError(found + ", which is not on PATH, allowed a program there, or a path that counts from " +
                     fs::absolute(folder).lexically_normal().string());
  }
  if (!IsFile(beside)) {
    throw InputError(found + ", and there is no program " + beside.string() +
                     ", allowed a path that counts from " + fs::absolute(folder).lexically_normal().string());
  }
  if (!IsProgram(beside)) {
    throw InputError(found + ", which may not be executed, allowed a program that may; do `chmod +x " +
                     beside.string() + "`");
  }
  return beside.string();
}

std::vector<std::string> OwnEnvironment(const settings::StackConfig& config, const OwnTask& task,
                                        const std::string& programs_folder) {
  std::map<std::string, std::string> variables;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    if (const size_t equals = text.find('='); equals != std::string::npos) {
      variables[text.substr(0, equals)] = text.substr(equals + 1);
    }
  }
  const bool position = task.role == "position_ctrl";
  variables["HYDRO_ROLE"] = task.role;
  variables["HYDRO_CONFIG"] = task.config_file;
  variables["HYDRO_SET"] = Lines(task.overrides);
  variables["HYDRO_EXPECT"] = Lines(task.expected);
  variables["HYDRO_BUS_URL"] = config.bus.url;
  variables["HYDRO_CHANNEL_SUFFIX"] = config.bus.channel_suffix;
  variables["HYDRO_RATE_HZ"] = ShortestNumber(config.plant.rate_hz);
  variables["HYDRO_TIME"] = config.time.mode == settings::TimeMode::kLockstep ? "lockstep" : "realtime";
  variables["HYDRO_POSITION_EVERY"] = std::to_string(config.position_interval_ticks);
  variables["HYDRO_COMMAND_DELAY"] = std::to_string(config.plant.command_delay_ticks);
  variables["HYDRO_STALE_TICKS"] = std::to_string(settings::OldestPressureCommandTicks(config));
  variables["HYDRO_EVERY"] =
      std::to_string(position ? config.position_interval_ticks : config.pressure_interval_ticks);
  const fs::path python = fs::path(programs_folder).parent_path() / "share/hydro/python";
  if (std::error_code error; fs::is_directory(python, error)) {
    std::string& path = variables["PYTHONPATH"];
    path = python.string() + (path.empty() ? "" : ":" + path);
  }
  // Its lines arrive when it prints them, not when it ends.
  variables.emplace("PYTHONUNBUFFERED", "1");
  variables.emplace("PYTHONDONTWRITEBYTECODE", "1");  // keeps an installation unchanged
  std::vector<std::string> environment;
  environment.reserve(variables.size());
  for (const auto& [name, value] : variables) {
    std::string& entry = environment.emplace_back(name);
    entry += "=";
    entry += value;
  }
  return environment;
}

std::string OwnFolder() { return fs::read_symlink("/proc/self/exe").parent_path().string(); }

}  // namespace hydro::process
