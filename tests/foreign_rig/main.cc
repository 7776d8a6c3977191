// hydro-foreign-rig: writes what a rig records and, in another place, what was in it.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <stdexcept>
#include <string>

#include "cases.h"
#include "write.h"

namespace {

constexpr char kHelp[] =
    "hydro-foreign-rig --list\n"
    "hydro-foreign-rig --case NAME|N [--out DIR] [--key FILE] [--seed S | --seed-offset N] [--rate HZ] "
    "[--seconds T]\n"
    "Writes five runs to fit and three to hold out, and the model as given (DIR/runN.csv, heldN.csv, their "
    "sidecars,\n"
    "model.toml); FILE gets the answers. Another seed is another rig: values, sizes, runs, sensors.\n"
    "  --list       number, name, class, seed of every case\n"
    "  --seed S     instead of the case's own\n"
    "  --seed-offset N  added to it: below 20000 for development, multiples of 1000 from there on sealed\n"
    "  --rate HZ    samples a second, a divisor of 50000 (drawn: 200 to 2000)\n"
    "  --seconds T  of each run (5)\n";

using Arguments = std::map<std::string, std::string>;

Arguments Parse(int argc, char** argv) {
  Arguments given;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--help" || option == "--list") {
      given[option] = "yes";
      continue;
    }
    bool known = false;
    for (const char* name : {"--case", "--out", "--key", "--seed", "--seed-offset", "--rate", "--seconds"})
      known = known || option == name;
    if (!known || i + 1 >= argc) throw std::invalid_argument(option + ": see --help");
    given[option] = argv[++i];
  }
  return given;
}

double Number(const Arguments& given, const std::string& option, double otherwise) {
  const auto found = given.find(option);
  if (found == given.end()) return otherwise;
  char* end = nullptr;
  const double value = std::strtod(found->second.c_str(), &end);
  if (found->second.empty() || *end != '\0' || !(value > 0))
    throw std::invalid_argument(option + " " + found->second + ": a number above 0 is needed");
  return value;
}

void Make(const Arguments& given, foreign_rig::Case c) {
  if (given.contains("--seed") && given.contains("--seed-offset"))
    throw std::invalid_argument("--seed and --seed-offset: one of them");
  if (given.contains("--seed")) c.seed = static_cast<uint64_t>(Number(given, "--seed", 1));
  if (given.contains("--seed-offset")) c.seed += static_cast<uint64_t>(Number(given, "--seed-offset", 1));
  foreign_rig::Options options;
  options.rate = Number(given, "--rate", 0);
  options.seconds = Number(given, "--seconds", options.seconds);
  const foreign_rig::Solved solved = foreign_rig::Solve(c, options);
  if (given.contains("--out")) foreign_rig::WriteRuns(c, solved, options, given.at("--out"));
  if (given.contains("--key")) foreign_rig::WriteKey(c, solved, given.at("--key"));
}

int Main(int argc, char** argv) {
  const Arguments given = Parse(argc, argv);
  if (given.contains("--help")) {
    std::fputs(kHelp, stdout);
    return 0;
  }
  const auto cases = foreign_rig::AllCases();
  if (given.contains("--list")) {
    for (size_t i = 0; i < cases.size(); ++i) {
      std::printf("%zu %s %s %llu\n", i + 1, cases[i].name.c_str(), cases[i].kind.c_str(),
                  static_cast<unsigned long long>(cases[i].seed));
    }
    return 0;
  }
  if (!given.contains("--case") || !(given.contains("--out") || given.contains("--key")))
    throw std::invalid_argument("--case and --out or --key: see --help");
  const std::string& wanted = given.at("--case");
  for (size_t i = 0; i < cases.size(); ++i) {
    if (wanted != cases[i].name && wanted != std::to_string(i + 1)) continue;
    Make(given, cases[i]);
    return 0;
  }
  throw std::invalid_argument("no case " + wanted + "; --list names all");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return Main(argc, argv);
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "hydro-foreign-rig: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "hydro-foreign-rig: %s\n", error.what());
    return 1;
  }
}
