#include "launch/new_controller.h"

#include <cstdio>

#include "launch/new_files.h"
#include "launch/own_controller_texts.h"
#include "settings/toml/toml_document.h"

namespace hydro::launch {

int NewController(const std::string& name) {
  CheckNewName("--new-controller", name);
  const std::string program = name + ".py", stack = name + ".toml";
  const std::string model = InstalledConfig("models/table1.toml");
  std::string toml =
      Replaced(kControllerStack, "hydro-launch examples/own_controller/own.toml", "hydro-launch " + stack);
  toml = Replaced(toml, "pid.py", program);
  toml = Replaced(toml, "\"../../config/models/table1.toml\"", settings::TomlString(model));
  WriteNewFiles({{program, Replaced(kControllerPython, "pid.py", program), 0777}, {stack, toml}});
  std::printf(
      "wrote %s, a position loop, and %s, a stack with it; next:\n"
      "%s"
      "  hydro-launch %s --duration 3 --log %s.lcmlog    it runs as it is\n"
      "  change answer() in %s, and run it again; --time lockstep: as fast as it can, the same each time\n"
      "  hydro-log summary %s.lcmlog; hydro-log replay --controller ./%s %s.lcmlog\n"
      "docs/own_controller.md says more\n",
      program.c_str(), stack.c_str(), StepsToBuildOn().python.c_str(), stack.c_str(), name.c_str(),
      program.c_str(), name.c_str(), program.c_str(), name.c_str());
  return 0;
}

}  // namespace hydro::launch
