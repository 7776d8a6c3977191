// hydro-launch CONFIG: starts, supervises and stops the processes of a stack; or asks something of one that
// runs.
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "base/text_file.h"
#include "launch/doctor/doctor.h"
#include "launch/launch.h"
#include "launch/logic/operator_request.h"
#include "launch/make_key.h"
#include "launch/stop_stack.h"
#include "process/stack_bus.h"
#include "settings/command_line.h"

namespace {

struct Options {
  hydro::settings::CommonOptions common;
  hydro::launch::LaunchRequest request;
  // Instead of starting anything; at most one.
  bool stop = false;
  bool rearm = false;
  bool make_key = false;
  bool doctor = false;
};

void AddOptions(hydro::settings::CommandLine* line, Options* options) {
  line->AddCommon(&options->common, false);
  line->AddOption("--host", &options->request.host,
                  "NAME start only the processes whose [[process]] section has this host");
  line->AddFlag(
      "--doctor", &options->doctor,
      "examine this machine and its network for the stack of CONFIG (without CONFIG: for any real-time "
      "stack), and print what fixes each problem; starts nothing");
  line->AddOption("--timing", &options->request.timing_file,
                  "REPORT.json where to write how the loops kept time; REPORT.html beside it has plots");
  line->AddFlag("--stop", &options->stop,
                "stop the running stack and wait until it has ended; starts nothing");
  line->AddFlag("--rearm", &options->rearm,
                "end the faults that hold the voltage at zero (limits.rearm = \"explicit\"); starts nothing");
  line->AddFlag("--make-key", &options->make_key,
                "write a new key into CONFIG's bus.key_file; starts nothing");
}

// The one flag given of those that start nothing; empty when none is. Throws InputError when two are.
std::string FlagInstead(const Options& options) {
  const std::vector<std::pair<std::string, bool>> flags = {{"--stop", options.stop},
                                                           {"--rearm", options.rearm},
                                                           {"--make-key", options.make_key},
                                                           {"--doctor", options.doctor}};
  std::string first;
  for (const auto& [flag, given] : flags) {
    if (!given) continue;
    if (!first.empty()) {
      throw hydro::InputError(first + ": found " + flag + " beside it, allowed is one of them");
    }
    first = flag;
  }
  return first;
}

// Refuses options that `flag` would ignore, because they cannot be what was meant: --stop --log X records
// nothing. --set and its like say which stack it is, as they did on the command line that started it.
void CheckNoneIgnored(const hydro::settings::CommandLine& line, const std::string& flag) {
  std::vector<std::string> allowed = {"--set", "--time", "--duration", "--seed"};
  if (flag == "--doctor") allowed.emplace_back("--host");
  for (const std::string& given : line.Given()) {
    if (given == flag || std::find(allowed.begin(), allowed.end(), given) != allowed.end()) continue;
    throw hydro::InputError(flag + ": found " + given + " beside it, allowed are CONFIG and " +
                            hydro::QuotedList(allowed));
  }
}

hydro::launch::OperatorResult Rearm(const hydro::settings::StackConfig& config) {
  const auto bus = hydro::process::OpenStackBus(config.bus);
  return hydro::launch::RearmStack(*bus, hydro::bus::WallClock(), config);
}

int RunOperatorRequest(const hydro::settings::CommonOptions& options, bool stop) {
  const hydro::settings::StackConfig config =
      hydro::settings::LoadStackConfig(options.config, options.overrides);
  const hydro::launch::OperatorResult result = stop ? hydro::launch::StopStack(config) : Rearm(config);
  // Names and reasons come from the network.
  std::fprintf(result.exit_code == 0 ? stdout : stderr, "hydro-launch: %s\n",
               hydro::Printable(result.text).c_str());
  return result.exit_code;
}

int Run(const hydro::settings::CommandLine& line, const Options& options) {
  const std::string& config = options.common.config;
  if (const std::string flag = FlagInstead(options); !flag.empty()) CheckNoneIgnored(line, flag);
  if (options.doctor) {
    return hydro::launch::RunDoctor(config, options.common.overrides, options.request.host);
  }
  if (config.empty()) throw hydro::InputError("CONFIG is required; see --help");
  if (options.make_key) return hydro::launch::MakeKey(options.common);
  if (options.stop) return RunOperatorRequest(options.common, true);
  if (options.rearm) return RunOperatorRequest(options.common, false);
  hydro::launch::LaunchRequest request = options.request;
  request.config_file = config;
  request.overrides = options.common.overrides;
  request.log_file = options.common.log;
  return hydro::launch::LaunchStack(request);
}

}  // namespace

int main(int argc, char** argv) {
  hydro::settings::CommandLine line("hydro-launch", "Starts, supervises and stops the processes of a stack.");
  Options options;
  AddOptions(&line, &options);
  if (const auto code = line.Parse(argc, argv)) return *code;
  return hydro::settings::RunProgram("hydro-launch", [&] { return Run(line, options); });
}
