// hydro-scope CONFIG | LOG: shows a running stack, or a log, in the browser.
#include <string>

#include "base/input_error.h"
#include "scope/scope_app.h"
#include "settings/command_line.h"

int main(int argc, char** argv) {
  hydro::settings::CommandLine line(
      "hydro-scope",
      "Shows a running stack, or a log, in the browser: prints the address of its page. "
      "Example: hydro-scope config/demo.toml. See docs/scope.md.");
  line.AddExamples({"hydro-scope config/demo.toml        beside a running stack", "hydro-scope run.lcmlog"},
                   "docs/scope.md");
  hydro::scope::ScopeRequest request;
  int port = -1;
  line.AddPositional("CONFIG|LOG", &request.input, "FILE the stack's configuration, or a log (.lcmlog)");
  line.AddOption("--set", &request.overrides,
                 "SECTION.KEY=VALUE as for the stack's programs; may be repeated");
  line.AddOption("--joint", &request.joint, "NAME of a limb, or a log of one, show this joint only");
  line.AddOption("--port", &port, "N TCP port, instead of scope.port; 0: any free one");
  line.AddOption("--page", &request.page,
                 "DIR serve the page's files from this folder (for work on the page)");
  if (const auto code = line.Parse(argc, argv)) return *code;
  return hydro::settings::RunProgram("hydro-scope", [&] {
    if (port != -1) {
      if (port < 0 || port > 65535) {
        throw hydro::InputError("--port: found " + std::to_string(port) + ", allowed is 0 to 65535");
      }
      request.port = port;
    }
    return hydro::scope::RunScope(request);
  });
}
