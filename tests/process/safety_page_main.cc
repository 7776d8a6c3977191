// safety_page [--write] PAGE: checks the table of PAGE (docs/safety.md) against process/safety; with --write,
// brings it up to date. safety_page --json: the table for other programs.
#include <cstdio>
#include <exception>
#include <fstream>
#include <string>

#include "base/text_file.h"
#include "tests/process/safety_page.h"

int main(int argc, char** argv) {
  const std::string option = argc > 1 ? argv[1] : "";
  const bool write = argc == 3 && option == "--write";
  if (argc != 2 && !write) {
    std::fprintf(stderr, "usage: safety_page [--write] PAGE | --json\n");
    return 2;
  }
  try {
    if (option == "--json") {
      std::fputs(hydro::process::SafetyJson().c_str(), stdout);
      return 0;
    }
    const std::string file = argv[argc - 1];
    const std::string page = hydro::ReadTextFile(file);
    const std::string current = hydro::process::WithSafetyTable(page, file);
    if (write) std::ofstream(file, std::ios::binary | std::ios::trunc) << current;
    if (write || page == current) return 0;
    std::fprintf(stderr, "safety_page: the table of %s is not current; `%s --write %s` writes it anew\n",
                 file.c_str(), argv[0], file.c_str());
    return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "safety_page: %s\n", error.what());
    return 2;
  }
}
