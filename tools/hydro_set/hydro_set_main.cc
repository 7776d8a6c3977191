// hydro-set [CONFIG] KEY=VALUE...: changes values while a stack runs.
#include <cstdio>
#include <string>
#include <vector>

#include "base/standard_output.h"
#include "base/text_file.h"
#include "bus/clock.h"
#include "process/stack_bus.h"
#include "process/stop_signal.h"
#include "settings/command_line.h"
#include "tools/hydro_set/set_request.h"

namespace {

using hydro::hydro_set::SetRequest;

// An argument with an '=' is a value, and the one without is CONFIG.
void Sort(const std::vector<std::string>& arguments, SetRequest* request) {
  for (const std::string& argument : arguments) {
    if (argument.find('=') != std::string::npos) {
      request->changes.push_back(argument);
    } else if (request->config_file.empty()) {
      request->config_file = argument;
    } else {
      throw hydro::InputError(hydro::Quoted(argument) +
                              ": found a second CONFIG, allowed is one, and KEY=VALUE...");
    }
  }
}

int Run(SetRequest request, const std::vector<std::string>& arguments, std::vector<std::string> overrides) {
  Sort(arguments, &request);
  hydro::hydro_set::CheckRequest(request);
  if (!request.joint.empty()) overrides.push_back("joint=" + request.joint);
  hydro::settings::BusSection section;
  if (!request.config_file.empty()) {
    const hydro::settings::StackConfig config =
        hydro::settings::LoadStackConfig(request.config_file, overrides);
    if (const std::string remark = ArmRemark(config); !remark.empty())
      hydro::Remark("hydro-set: warning: " + remark);
    section = config.bus;
  } else if (!overrides.empty()) {
    throw hydro::InputError((request.joint.empty() ? "--set: found " : "--joint: found ") +
                            hydro::Quoted(request.joint.empty() ? overrides.front() : request.joint) +
                            " without CONFIG, allowed is both");
  }
  hydro::process::CatchStopSignals();
  const auto bus = hydro::process::OpenStackBus(section);
  hydro::SayRemarks();
  return hydro::hydro_set::RunSet(
      *bus, hydro::bus::WallClock(), section, request,
      {.out = stdout, .err = stderr, .interrupted = [] { return hydro::process::StopSignal() != 0; }});
}

}  // namespace

int main(int argc, char** argv) {
  hydro::settings::CommandLine line("hydro-set",
                                    "Changes gains, limits, references and noise while a stack runs: all "
                                    "values of one request take effect on one tick, or none.");
  line.AddExamples({"hydro-set config/demo.toml position.c2=900 pressure.natural_frequency_rad_s=120",
                    "hydro-set config/demo.toml --undo", "hydro-set config/demo.toml --list"},
                   "docs/tuning.md");
  SetRequest request;
  std::vector<std::string> arguments, overrides;
  line.AddPositional("[CONFIG] KEY=VALUE", &arguments,
                     "the stack's configuration (for its bus and key), and values", false);
  line.AddOption("--set", &overrides,
                 "SECTION.KEY=VALUE changes a key of CONFIG first, as on the command line that started the "
                 "stack, e.g. bus.url");
  line.AddOption("--joint", &request.joint,
                 "NAME of a CONFIG with [[joint]] sections, the joint whose values are meant");
  line.AddFlag("--list", &request.list,
               "show what can be changed: value in force, unit, where it acts, what it does");
  line.AddFlag("--undo", &request.undo, "go back to what was in force before the last change");
  line.AddFlag("--watch", &request.watch, "show each change as it takes effect, until Ctrl-C");
  line.AddOption("--save", &request.save,
                 "FILE write CONFIG with the values in force, comments kept (without CONFIG: the whole "
                 "configuration of the run); - for the standard output");
  line.AddForce();
  if (const auto code = line.Parse(argc, argv)) return *code;
  return hydro::settings::RunProgram("hydro-set", [&] { return Run(request, arguments, overrides); });
}
