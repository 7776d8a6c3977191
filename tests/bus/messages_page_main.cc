// messages_page [--write] PAGE FOLDER: checks PAGE (docs/messages.md) against the table of messages and the
// .lcm files of FOLDER; with --write, brings it up to date.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/text_file.h"
#include "tests/bus/messages_page.h"

int main(int argc, char** argv) {
  const bool write = argc == 4 && std::string(argv[1]) == "--write";
  if (argc != 3 && !write) {
    std::fprintf(stderr, "usage: messages_page [--write] PAGE FOLDER\n");
    return 2;
  }
  const std::string file = argv[argc - 2], folder = argv[argc - 1];
  try {
    const std::string page = hydro::bus::MessagesPage(folder);
    if (write) {
      std::ofstream(file, std::ios::binary | std::ios::trunc) << page;
    }
    if (std::filesystem::exists(file) && hydro::ReadTextFile(file) == page) return 0;
    std::fprintf(stderr, "messages_page: %s is not current; `%s --write %s %s` writes it anew\n",
                 file.c_str(), argv[0], file.c_str(), folder.c_str());
    return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "messages_page: %s\n", error.what());
    return 2;
  }
}
