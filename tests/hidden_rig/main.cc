// hydro-hidden-rig: writes what a rig records and, in another place, what was in the rig.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <stdexcept>
#include <string>

#include "cases.h"
#include "write_case.h"

namespace {

constexpr char kHelp[] =
    "hydro-hidden-rig --list\n"
    "hydro-hidden-rig --case NAME|N --out DIR [--key FILE] [--seed S] [--rate HZ] [--seconds T] [--noise X] "
    "[--driven]\n"
    "Writes the runs of a rig and the model as given (DIR/runN.csv, runN.toml, model.toml); FILE gets the "
    "answers.\n"
    "  --list       number, name, class, seed of every case\n"
    "  --seed S     instead of the case's own\n"
    "  --rate HZ    samples a second (1000)\n"
    "  --seconds T  of each run (2.5)\n"
    "  --noise X    times the case's noise (1)\n"
    "  --driven     a seventh run whose shaft is moved from outside\n"
    "  --beyond     the key also says how much of the gap no other values of the base parameters explain "
    "(slow)\n";

int Main(int argc, char** argv) {
  std::map<std::string, std::string> given;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--help") {
      std::fputs(kHelp, stdout);
      return 0;
    }
    if (option == "--list" || option == "--driven" || option == "--beyond") {
      given[option] = "yes";
      continue;
    }
    bool known = false;
    for (const char* with_value : {"--case", "--out", "--key", "--seed", "--rate", "--seconds", "--noise"}) {
      known = known || option == with_value;
    }
    if (!known || i + 1 >= argc) throw std::invalid_argument(option + ": see --help");
    given[option] = argv[++i];
  }
  const auto number = [&](const char* option, double otherwise) {
    if (!given.contains(option)) return otherwise;
    char* end = nullptr;
    const double value = std::strtod(given[option].c_str(), &end);
    if (given[option].empty() || *end != '\0' || !(value > 0)) {
      throw std::invalid_argument(std::string(option) + " " + given[option] + ": a number above 0 is needed");
    }
    return value;
  };
  const auto cases = hidden_rig::AllCases();
  if (given.contains("--list")) {
    for (size_t i = 0; i < cases.size(); ++i) {
      std::printf("%zu %s %s %llu\n", i + 1, cases[i].name.c_str(), cases[i].kind.c_str(),
                  static_cast<unsigned long long>(cases[i].seed));
    }
    return 0;
  }
  if (!given.contains("--case") || !given.contains("--out"))
    throw std::invalid_argument("--case and --out: see --help");
  for (size_t i = 0; i < cases.size(); ++i) {
    if (given["--case"] != cases[i].name && given["--case"] != std::to_string(i + 1)) continue;
    hidden_rig::Case c = cases[i];
    if (given.contains("--seed")) c.seed = static_cast<uint64_t>(number("--seed", 1));
    hidden_rig::Options options;
    options.rate = number("--rate", options.rate);
    options.seconds = number("--seconds", options.seconds);
    options.noise = number("--noise", options.noise);
    options.driven = given.contains("--driven");
    hidden_rig::Truth truth = hidden_rig::Solve(c, options);
    if (given.contains("--beyond")) truth.beyond_values = hidden_rig::GapBeyondValues(truth, c.seed, options);
    hidden_rig::WriteRuns(c, truth, options, given["--out"]);
    if (given.contains("--key")) hidden_rig::WriteKey(c, truth, given["--key"]);
    return 0;
  }
  throw std::invalid_argument("no case " + given["--case"] + "; --list names all");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return Main(argc, argv);
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "hydro-hidden-rig: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "hydro-hidden-rig: %s\n", error.what());
    return 1;
  }
}
