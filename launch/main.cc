#include "launch/launch.h"
#include "launch/make_key.h"
#include "settings/command_line.h"

int main(int argc, char** argv) {
  hydro::CommandLine line("hydro-launch", "Starts, watches over and stops the processes of a stack.");
  hydro::CommonOptions options;
  hydro::LaunchRequest request;
  line.AddCommon(&options);
  line.AddOption("--host", &request.host,
                 "NAME start only the processes whose [[process]] section has this host");
  bool make_key = false;
  line.AddFlag("--make-key", &make_key, "write a new key into CONFIG's bus.key_file and start nothing");
  if (const auto code = line.Parse(argc, argv)) return *code;
  return hydro::RunProgram("hydro-launch", [&] {
    if (make_key) return hydro::MakeKey(options);
    request.config_file = options.config;
    request.overrides = options.overrides;
    request.log_file = options.log;
    return hydro::LaunchStack(request);
  });
}
