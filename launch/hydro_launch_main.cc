// hydro-launch CONFIG: starts, supervises and stops the processes of a stack, or sends a request to a running
// one.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "base/text_file.h"
#include "base/word_list.h"
#include "launch/doctor/doctor.h"
#include "launch/launch.h"
#include "launch/logic/operator_request.h"
#include "launch/rearm_json.h"
#include "launch/starters.h"
#include "launch/stop_stack.h"
#include "process/stack_bus.h"
#include "settings/command_line.h"
#include "settings/limb_config.h"

namespace {

struct Options {
  hydro::settings::CommonOptions common;
  hydro::launch::LaunchRequest request;
  // Requests that replace a start; at most one may be given.
  bool stop = false;
  bool rearm = false;
  bool make_key = false;
  bool doctor = false;
  std::string new_controller;
  std::string new_driver;
};

void AddOptions(hydro::settings::CommandLine* line, Options* options) {
  line->AddCommon(&options->common, false);
  line->AddOption(
      "--host", &options->request.host,
      "NAME start only the processes whose [[process]] section has host = NAME (docs/network.md); "
      "localhost: those that name none");
  line->AddFlag(
      "--doctor", &options->doctor,
      "examine this machine and its network for the stack of CONFIG (without CONFIG: for any real-time "
      "stack), and print what fixes each problem; starts nothing");
  line->AddOption("--timing", &options->request.timing_file,
                  "REPORT.json write how the loops kept time (periods, latencies, missed deadlines of every "
                  "process) when the run ends; "
                  "REPORT.html beside it has the plots (docs/timing.md)");
  line->AddFlag("--quiet", &options->request.quiet, "print errors and warnings only");
  line->AddFlag("--json", &options->request.json,
                "print a JSON object a line: each line of the processes, how they are doing twice a second, "
                "the exit code");
  line->AddFlag(
      "--stop", &options->stop,
      "stop the running stack and wait until it has ended; starts nothing. Also: hydro-launch stop CONFIG");
  line->AddFlag(
      "--rearm", &options->rearm,
      "end the faults that hold the voltage at zero (limits.rearm = \"explicit\"), and say where the machine "
      "moves by it, with --json as numbers too; starts nothing. Also: hydro-launch rearm CONFIG");
  line->AddFlag("--make-key", &options->make_key,
                "write a new key into CONFIG's bus.key_file; starts nothing");
  line->AddOption(
      "--new-controller", &options->new_controller,
      "NAME write a controller of your own to begin with, NAME.py, and a stack with it, NAME.toml, "
      "into this folder; starts nothing. Also: hydro-launch new-controller NAME");
  line->AddOption(
      "--new-driver", &options->new_driver,
      "NAME make a folder NAME with a driver of your own to begin with, a simulated device for it, and a "
      "stack with both, NAME/NAME.toml; starts nothing. Also: hydro-launch new-driver NAME");
}

// The one flag given among those that start nothing; empty when there is none. Throws InputError when there
// are two.
std::string FlagInstead(const Options& options) {
  const std::vector<std::pair<std::string, bool>> flags = {
      {"--stop", options.stop},
      {"--rearm", options.rearm},
      {"--make-key", options.make_key},
      {"--doctor", options.doctor},
      {"--new-controller", !options.new_controller.empty()},
      {"--new-driver", !options.new_driver.empty()}};
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

// Refuses options that `flag` would ignore, because the user cannot have meant them: --stop --log X records
// nothing. --set and similar options identify the stack, as they did on the command line that started it.
void CheckNoneIgnored(const hydro::settings::CommandLine& line, const std::string& flag) {
  std::vector<std::string> allowed = {"--set", "--time", "--duration", "--seed", "--joint"};
  if (flag == "--doctor") allowed.emplace_back("--host");
  if (flag == "--rearm") allowed.emplace_back("--json");
  if (flag.starts_with("--new-")) allowed.clear();
  for (const std::string& given : line.Given()) {
    if (given == flag || std::find(allowed.begin(), allowed.end(), given) != allowed.end()) continue;
    throw hydro::InputError(
        flag + ": found " + given + " beside it, allowed " +
        (allowed.empty() ? "is NAME alone" : "are CONFIG and " + hydro::QuotedList(allowed)));
  }
}

hydro::launch::OperatorResult Rearm(const hydro::settings::StackConfig& config) {
  const auto bus = hydro::process::OpenStackBus(config.bus);
  return hydro::launch::RearmStack(*bus, hydro::bus::WallClock(), config);
}

int RunOperatorRequest(const hydro::settings::CommonOptions& options, bool stop, bool json) {
  const hydro::settings::StackConfig config =
      hydro::settings::LoadCommonConfig(options.config, options.overrides);
  const hydro::launch::OperatorResult result = stop ? hydro::launch::StopStack(config) : Rearm(config);
  if (json) {
    std::printf("%s\n", hydro::launch::RearmJson(result).c_str());
    return result.exit_code;
  }
  if (result.exit_code == 0 && !stop) {
    std::fputs(hydro::launch::TerminalText(result).c_str(), stdout);
    return 0;
  }
  // Names and reasons come from the network, so they may hold any characters.
  std::fprintf(result.exit_code == 0 ? stdout : stderr, "hydro-launch: %s\n",
               hydro::Printable(result.text).c_str());
  return result.exit_code;
}

int Run(const hydro::settings::CommandLine& line, const Options& options) {
  const std::string& config = options.common.config;
  const std::string flag = FlagInstead(options);
  if (!flag.empty()) CheckNoneIgnored(line, flag);
  if (flag.starts_with("--new-") && !config.empty())
    throw hydro::InputError(flag + ": found " + config + ", allowed is NAME alone");
  if (!options.new_controller.empty()) return hydro::launch::NewController(options.new_controller);
  if (!options.new_driver.empty()) return hydro::launch::NewDriver(options.new_driver);
  if (options.doctor) {
    return hydro::launch::RunDoctor(config, options.common.overrides, options.request.host);
  }
  if (config.empty()) {
    throw hydro::InputError(
        "CONFIG: found nothing, allowed FILE (the stack's configuration, TOML), e.g. hydro-launch " +
        (flag.empty() ? "" : flag.substr(2) + " ") + "config/demo.toml");
  }
  if (options.make_key) return hydro::launch::MakeKey(options.common);
  if (options.stop) return RunOperatorRequest(options.common, true, false);
  if (options.rearm) return RunOperatorRequest(options.common, false, options.request.json);
  hydro::launch::LaunchRequest request = options.request;
  request.config_file = config;
  request.overrides = options.common.overrides;
  request.log_file = options.common.log;
  request.force = options.common.force;
  return hydro::launch::LaunchStack(request);
}

constexpr std::pair<const char*, const char*> kVerbs[] = {{"stop", "--stop"},
                                                          {"rearm", "--rearm"},
                                                          {"doctor", "--doctor"},
                                                          {"make-key", "--make-key"},
                                                          {"new-controller", "--new-controller"},
                                                          {"new-driver", "--new-driver"}};

// Throws InputError where NAME is missing behind a verb that needs it.
void CheckHasName(const std::string& verb, int argc, char** argv) {
  if (!verb.starts_with("new-") || (argc > 2 && argv[2][0] != '-' && argv[2][0] != '\0')) return;
  throw hydro::InputError(verb +
                          ": found no NAME, allowed letters, digits and underscores, e.g. hydro-launch " +
                          verb + " crane");
}

// Turns `hydro-launch stop CONFIG` into `hydro-launch --stop CONFIG`. Throws InputError for a word that is
// close to a verb and does not name a file: `hydro-launch stopp CONFIG`.
std::vector<const char*> WithFlagForVerb(int argc, char** argv) {
  std::vector<const char*> arguments(argv, argv + argc);
  if (argc < 2) return arguments;
  const std::string first = arguments[1];
  const std::string second = argc > 2 ? arguments[2] : "";
  std::vector<std::string> verbs;
  for (const auto& [verb, flag] : kVerbs) {
    if (first == verb || first == flag) {
      if (second == "--help" || second == "-h") return {argv[0], argv[2]};
      CheckHasName(verb, argc, argv);
    }
    if (first == verb) arguments[1] = flag;
    verbs.emplace_back(verb);
  }
  if (first != arguments[1] || first.starts_with('-') || std::filesystem::exists(first)) return arguments;
  if (const std::string meant = hydro::DidYouMean(first, verbs); !meant.empty()) {
    throw hydro::InputError("found " + hydro::Quoted(first) + meant + ", allowed a verb, " +
                            hydro::QuotedList(verbs) + ", or CONFIG, a file");
  }
  return arguments;
}

}  // namespace

int main(int argc, char** argv) {
  hydro::settings::CommandLine line("hydro-launch",
                                    "Starts, supervises and stops the processes of a stack. On a terminal it "
                                    "shows how each is doing; in a pipe it prints plain lines.");
  line.AddExamples(
      {"hydro-launch config/demo.toml --log run.lcmlog      start, record, until the run ends or Ctrl-C",
       "hydro-launch stop config/demo.toml                  end the stack that runs, from anywhere",
       "hydro-launch doctor config/demo.toml                is this machine fit for it?",
       "hydro-launch new-controller NAME                    a controller of your own to begin with",
       "hydro-launch new-driver NAME                        a driver of your own to begin with"},
      "docs/launch.md");
  Options options;
  AddOptions(&line, &options);
  return hydro::settings::RunProgram("hydro-launch", [&] {
    const std::vector<const char*> arguments = WithFlagForVerb(argc, argv);
    if (const auto code = line.Parse(static_cast<int>(arguments.size()), arguments.data())) return *code;
    return Run(line, options);
  });
}
