// safety_page [--write] SAFETY TESTS: checks the tables of two pages (docs/safety.md and
// docs/developers/safety_tests.md) against process/safety. With --write, it brings both up to date.
// safety_page --json: both tables for other programs.
#include <cstdio>
#include <exception>
#include <fstream>
#include <string>
#include <utility>

#include "base/text_file.h"
#include "tests/process/safety_page.h"

namespace {

struct Page {
  std::string file, found, current;
};

Page Read(const std::string& file, const std::string& table) {
  std::string found = hydro::ReadTextFile(file);
  std::string current = hydro::process::WithTable(found, file, table);
  return {file, std::move(found), std::move(current)};
}

}  // namespace

int main(int argc, char** argv) {
  const std::string option = argc > 1 ? argv[1] : "";
  const bool json = argc == 2 && option == "--json";
  const bool write = argc == 4 && option == "--write";
  const bool check = argc == 3 && !option.starts_with("--");
  if (!json && !write && !check) {
    std::fprintf(stderr, "usage: safety_page [--write] SAFETY_PAGE TESTS_PAGE | --json\n");
    return 2;
  }
  try {
    if (json) {
      std::fputs(hydro::process::SafetyJson().c_str(), stdout);
      return 0;
    }
    // Both pages are read before one is written: a page without marks leaves the other as it was.
    const Page pages[] = {Read(argv[argc - 2], hydro::process::SafetyMarkdown()),
                          Read(argv[argc - 1], hydro::process::SafetyTestsMarkdown())};
    int code = 0;
    for (const Page& page : pages) {
      if (page.found == page.current) continue;
      if (write) {
        std::ofstream(page.file, std::ios::binary | std::ios::trunc) << page.current;
        continue;
      }
      std::fprintf(stderr, "safety_page: the table of %s is not current; `%s --write %s %s` writes it anew\n",
                   page.file.c_str(), argv[0], pages[0].file.c_str(), pages[1].file.c_str());
      code = 1;
    }
    return code;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "safety_page: %s\n", error.what());
    return 2;
  }
}
