#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "base/text_file.h"
#include "bus/udpm/udpm_bus.h"
#include "launch/doctor/doctor.h"
#include "launch/launch.h"
#include "launch/make_key.h"
#include "launch/operator_request.h"
#include "settings/command_line.h"

namespace {

int Ask(decltype(hydro::launch::StopStack)* request, const hydro::settings::CommonOptions& options) {
  const hydro::settings::StackConfig config =
      hydro::settings::LoadStackConfig(options.config, options.overrides);
  hydro::bus::UdpmBus bus(config.bus.url,
                          hydro::bus::MakeAuthenticator(config.bus.resolved_key_file,
                                                        hydro::bus::Channels(config.bus.channel_suffix)));
  const hydro::bus::WallClock clock;
  const hydro::launch::OperatorResult result = request(bus, clock, config, {});
  // Names and reasons come from the network.
  std::fprintf(result.exit_code == 0 ? stdout : stderr, "hydro-launch: %s\n",
               hydro::Printable(result.text).c_str());
  return result.exit_code;
}

// Of the flags with which nothing is started. Returns the one that is given, or nothing.
std::string TheOneOf(const std::vector<std::pair<std::string, bool>>& flags) {
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

// An option that nobody would look at may not be what was meant: a stack is not recorded by --stop --log X.
// --set and its like say which stack it is, as the command line that started it did.
void CheckNoneIgnored(const hydro::settings::CommandLine& line, const std::string& flag) {
  std::vector<std::string> allowed = {"--set", "--time", "--duration", "--seed"};
  if (flag == "--doctor") allowed.emplace_back("--host");
  for (const std::string& given : line.Given()) {
    if (given == flag || std::find(allowed.begin(), allowed.end(), given) != allowed.end()) continue;
    throw hydro::InputError(flag + ": found " + given + " beside it, allowed are CONFIG and " +
                            hydro::QuotedList(allowed));
  }
}

}  // namespace

int main(int argc, char** argv) {
  hydro::settings::CommandLine line("hydro-launch",
                                    "Starts, watches over and stops the processes of a stack.");
  hydro::settings::CommonOptions options;
  hydro::launch::LaunchRequest request;
  line.AddCommon(&options, false);
  line.AddOption("--host", &request.host,
                 "NAME start only the processes whose [[process]] section has this host");
  bool doctor = false;
  line.AddFlag(
      "--doctor", &doctor,
      "examine this machine and its network for the stack of CONFIG (without: for any in real time), and "
      "print what mends each problem; starts nothing");
  line.AddOption("--timing", &request.timing_file,
                 "REPORT.json write there how the loops kept time, and REPORT.html with plots beside it");
  bool stop = false;
  bool rearm = false;
  line.AddFlag("--stop", &stop, "stop the stack that runs, and wait until it has; starts nothing");
  line.AddFlag("--rearm", &rearm,
               "end the faults that hold the voltage at zero (limits.rearm = \"explicit\"); starts nothing");
  bool make_key = false;
  line.AddFlag("--make-key", &make_key, "write a new key into CONFIG's bus.key_file and start nothing");
  if (const auto code = line.Parse(argc, argv)) return *code;
  return hydro::settings::RunProgram("hydro-launch", [&] {
    const std::string instead =
        TheOneOf({{"--stop", stop}, {"--rearm", rearm}, {"--make-key", make_key}, {"--doctor", doctor}});
    if (!instead.empty()) CheckNoneIgnored(line, instead);
    if (doctor) return hydro::launch::RunDoctor(options.config, options.overrides, request.host);
    if (options.config.empty()) throw hydro::InputError("CONFIG is required; see --help");
    if (make_key) return hydro::launch::MakeKey(options);
    if (stop || rearm) return Ask(stop ? hydro::launch::StopStack : hydro::launch::RearmStack, options);
    request.config_file = options.config;
    request.overrides = options.overrides;
    request.log_file = options.log;
    return hydro::launch::LaunchStack(request);
  });
}
