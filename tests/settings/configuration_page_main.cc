// configuration_page [--write] PAGE: checks the tables of PAGE (docs/configuration.md) against the readers of
// the configuration's sections; with --write, brings them up to date.
#include <cstdio>
#include <exception>
#include <fstream>
#include <string>

#include "base/text_file.h"
#include "tests/settings/configuration_page.h"

int main(int argc, char** argv) {
  const bool write = argc == 3 && std::string(argv[1]) == "--write";
  if (argc != 2 && !write) {
    std::fprintf(stderr, "usage: configuration_page [--write] PAGE\n");
    return 2;
  }
  const std::string file = argv[argc - 1];
  try {
    const std::string page = hydro::ReadTextFile(file);
    const std::string current =
        hydro::settings::CurrentConfigurationPage(page, file, hydro::settings::ConfigurationFacts());
    if (current == page) return 0;
    if (write && std::ofstream(file, std::ios::binary | std::ios::trunc) << current << std::flush) return 0;
    std::fprintf(stderr, "configuration_page: %s is not current; `%s --write %s` writes its tables anew\n",
                 file.c_str(), argv[0], file.c_str());
    return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "configuration_page: %s\n", error.what());
    return 2;
  }
}
