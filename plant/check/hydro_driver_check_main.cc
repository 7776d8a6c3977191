// hydro-driver-check CONFIG: takes a driver through what docs/safety.md promises.
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "base/text_file.h"
#include "plant/check/driver_cases.h"
#include "process/stop_signal.h"
#include "settings/command_line.h"
#include "settings/process_sections.h"
#include "settings/toml/section_reader.h"

namespace {

using hydro::plant::CaseResult;
using hydro::plant::DriverCase;

// Throws InputError when the configuration names no driver, or nothing that stands for its device.
void CheckHasDriver(const hydro::settings::StackConfig& config) {
  const auto driver = std::find_if(config.processes.begin(), config.processes.end(),
                                   [](const auto& process) { return process.role == "driver"; });
  if (driver == config.processes.end()) {
    throw hydro::settings::KeyError(config.file, "process", "no driver",
                                    "a [[process]] with role = \"driver\" or program = \"hydro-driver\"");
  }
  hydro::settings::CheckDriver(config,
                               driver->command.empty() ? driver->program : hydro::settings::NameOf(*driver));
  if (config.driver->simulated_device.empty()) {
    throw hydro::settings::KeyError(
        config.file, "driver.simulated_device", "nothing",
        "a program that stands for the device (docs/own_driver.md): with a real one "
        "nobody would see what it puts out");
  }
}

std::vector<DriverCase> Chosen(const std::vector<std::string>& only) {
  std::vector<DriverCase> chosen;
  for (const std::string& name : only) {
    const auto& all = hydro::plant::DriverCases();
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& c) { return name == c.name; });
    if (found == all.end()) {
      std::vector<std::string> names(all.size());
      std::transform(all.begin(), all.end(), names.begin(), [](const auto& known) { return known.name; });
      throw hydro::InputError("--only: found " + hydro::Quoted(name) + ", allowed " +
                              hydro::QuotedList(names));
    }
    chosen.push_back(*found);
  }
  return only.empty() ? hydro::plant::DriverCases() : chosen;
}

const char* Word(CaseResult::Verdict verdict) {
  switch (verdict) {
    case CaseResult::Verdict::kKept:
      return "kept";
    case CaseResult::Verdict::kBroken:
      return "BROKEN";
    case CaseResult::Verdict::kNotTried:
      break;
  }
  return "not tried";
}

int Run(const hydro::plant::TrialSettings& settings, const std::vector<std::string>& only) {
  CheckHasDriver(hydro::settings::LoadStackConfig(settings.file, settings.overrides));
  const std::vector<DriverCase> cases = Chosen(only);
  hydro::process::CatchStopSignals();
  int count[3] = {};
  for (const DriverCase& which : cases) {
    const CaseResult result = hydro::plant::RunDriverCase(which, settings);
    if (hydro::process::StopSignal() != 0) return 1;
    if (&which == &cases.front()) std::printf("%-17s %-41s %-9s  found\n", "what happens", "promised", "");
    ++count[static_cast<int>(result.verdict)];
    std::printf("%-17s %-41s %-9s  %s\n", which.name, which.promised, Word(result.verdict),
                hydro::Printable(result.found).c_str());
    std::fflush(stdout);
    // It would end in the same way each time, and what it said would be lost among the others' words.
    if (!result.begun && &which == &cases.front() && cases.size() > 1) {
      std::printf("the driver does not begin: mend that first; nothing else was tried\n");
      return 1;
    }
  }
  std::printf("%d kept, %d broken, %d not tried\n", count[0], count[1], count[2]);
  return count[1] > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  hydro::settings::CommandLine line(
      "hydro-driver-check",
      "Takes the driver of CONFIG through what docs/safety.md promises, with the simulated device that "
      "driver.simulated_device names, and prints a table. Exit code 1 when a promise is broken.");
  line.AddExamples({"hydro-driver-check my_driver.toml                 all of it, in about half a minute",
                    "hydro-driver-check my_driver.toml --only SIGKILL --verbose"},
                   "docs/own_driver.md");
  hydro::settings::CommonOptions options;
  hydro::plant::TrialSettings settings;
  std::vector<std::string> only;
  line.AddPositional("CONFIG", &options.config, "FILE the stack's configuration");
  line.AddOption("--set", &options.overrides, "SECTION.KEY=VALUE changes one key of CONFIG");
  line.AddOption("--only", &only, "CASE only this one, a name of the table's first column");
  line.AddFlag("--verbose", &settings.verbose, "show what the driver prints");
  if (const auto code = line.Parse(argc, argv)) return *code;
  return hydro::settings::RunProgram("hydro-driver-check", [&] {
    settings.file = options.config;
    settings.overrides = options.overrides;
    return Run(settings, only);
  });
}
