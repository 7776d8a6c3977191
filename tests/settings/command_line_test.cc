#include "settings/command_line.h"

#include <stdexcept>

#include "tests/settings/texts.h"

namespace hydro::settings {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using ::testing::internal::CaptureStderr;
using ::testing::internal::CaptureStdout;
using ::testing::internal::GetCapturedStderr;
using ::testing::internal::GetCapturedStdout;

struct Outcome {
  std::optional<int> code;
  std::string out;
  std::string err;
};

Outcome Parse(CommandLine& line, std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "hydro-test");
  CaptureStdout();
  CaptureStderr();
  Outcome outcome;
  outcome.code = line.Parse(static_cast<int>(arguments.size()), arguments.data());
  outcome.out = GetCapturedStdout();
  outcome.err = GetCapturedStderr();
  return outcome;
}

struct Common {
  Common() { line.AddCommon(&options); }
  CommandLine line{"hydro-test", "Does nothing."};
  CommonOptions options;
};

// Tests that the common options arrive, and that --time, --duration and --seed become overrides after all
// --set.
TEST(CommandLineTest, CommonOptions) {
  Common common;
  const Outcome outcome =
      Parse(common.line, {"--time", "lockstep", "--set", "position.c1=1", "a.toml", "--set=bus.url=udpm://x",
                          "--duration", "2.5", "--seed", "7", "--log", "a.lcmlog", "--si"});
  EXPECT_EQ(outcome.code, std::nullopt) << outcome.err;
  EXPECT_EQ(common.options.config, "a.toml");
  EXPECT_THAT(common.options.overrides,
              ElementsAre("position.c1=1", "bus.url=udpm://x", "time.mode=\"lockstep\"",
                          "time.duration_s=2.5", "noise.seed=7"));
  EXPECT_EQ(common.options.log, "a.lcmlog");
  EXPECT_TRUE(common.options.si);
}

// Tests that --help and --version exit with 0 and print to standard output.
TEST(CommandLineTest, HelpAndVersion) {
  Common help;
  Outcome outcome = Parse(help.line, {"--help"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("Does nothing."), HasSubstr("CONFIG"), HasSubstr("--set"), HasSubstr("--time"),
                    HasSubstr("--duration"), HasSubstr("--seed"), HasSubstr("--log"), HasSubstr("--si")));
  EXPECT_EQ(outcome.err, "");
  Common version;
  outcome = Parse(version.line, {"--version"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out, "hydro-test " + ProgramVersion() + "\n");
  EXPECT_THAT(ProgramVersion(), ::testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
}

// Tests that bad usage exits with 2 and one line that names the option, what was found and what is allowed.
TEST(CommandLineTest, BadUsage) {
  const struct {
    std::vector<const char*> arguments;
    const char* says;
  } usages[] = {
      {{}, "CONFIG: found nothing, allowed FILE"},
      {{"a.toml", "b.toml"}, "found the unexpected argument \"b.toml\", allowed "},
      {{"a.toml", "--sett", "x=1"}, "found the unexpected argument \"--sett"},
      {{"a.toml", "--seeds", "1"}, "did you mean \"--seed\"?"},
      {{"a.toml", "--set"}, "--set: found no value, allowed SECTION.KEY=VALUE"},
      {{"a.toml", "--time", "fast"}, "--time: found \"fast\", allowed \"realtime\" or \"lockstep\""},
      {{"a.toml", "--duration", "long"}, "--duration: found \"long\", allowed a finite number"},
      {{"a.toml", "--duration", "nan"}, "--duration: found \"nan\", allowed a finite number"},
      {{"a.toml", "--duration", "-1"}, "--duration: found \"-1\", allowed a number of seconds"},
      {{"a.toml", "--seed", "1.5"}, "--seed: found \"1.5\", allowed a whole number"},
      {{"a.toml", "--seed", "-1"}, "--seed: found \"-1\", allowed a whole number of at least 0"},
      {{"a.toml", "--seed", "99999999999999999999"},
       "--seed: found \"99999999999999999999\", allowed a whole number from 0 to 9223372036854775807"},
      {{"a.toml", "--log", ""}, "--log: found \"\", allowed FILE where to record the run"},
      {{"a.toml", "--log="}, "--log: found nothing after =, allowed a value"},
      {{"--log=", "a.toml"}, "--log: found nothing after =, allowed a value"},
      {{"a.toml", "--set", ""}, "--set: found \"\", allowed SECTION.KEY=VALUE"},
      {{""}, "CONFIG: found \"\", allowed FILE"},
      {{"a.toml", "--duration", ""}, "--duration: found \"\", allowed a finite number"},
      {{"a.toml", "--log", "x", "--log", "y"}, "--log: found it more than once, allowed once"},
  };
  for (const auto& usage : usages) {
    Common common;
    const Outcome outcome = Parse(common.line, usage.arguments);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, AllOf(StartsWith("hydro-test: "), HasSubstr(usage.says), EndsWith("\n")));
    EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
}

// Tests that what is missing is named, with what it is for and an example: the one that has the option, or
// the first one with the option behind it.
TEST(CommandLineTest, MissingWithAnExample) {
  const struct {
    std::vector<const char*> arguments;
    std::string says;
  } usages[] = {
      {{}, "CONFIG: found nothing, allowed FILE (the stack's configuration, TOML), e.g. hydro-test a.toml"},
      {{"a.toml", "--only"},
       "--only: found no value, allowed CASE (one of them), e.g. hydro-test a.toml --only x -v"},
      {{"a.toml", "--set"},
       "--set: found no value, allowed SECTION.KEY=VALUE (changes one key of CONFIG, e.g. "
       "pressure.damping_ratio=0.7), e.g. hydro-test a.toml --set SECTION.KEY=VALUE"},
      {{"a.toml", "--flag=foo"}, "--flag: found \"foo\" after =, allowed the option alone"},
  };
  for (const auto& usage : usages) {
    Common common;
    std::string only;
    bool flag = false;
    common.line.AddOption("--only", &only, "CASE one of them");
    common.line.AddFlag("--flag", &flag, "a flag");
    common.line.AddExamples({"hydro-test a.toml     all of it", "hydro-test a.toml --only x -v"},
                            "docs/a.md");
    const Outcome outcome = Parse(common.line, usage.arguments);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.err, "hydro-test: " + usage.says + "\n");
  }
}

// Tests a program's own options of each type, and that those not given keep their values.
TEST(CommandLineTest, OwnOptions) {
  CommandLine line("hydro-test", "Does nothing.");
  std::string out, kept = "kept";
  double number = 0;
  int count = 0;
  int64_t large = 0;
  bool flag = false;
  std::vector<std::string> runs, free;
  line.AddOption("-o,--out", &out, "FILE where to write", true);
  line.AddOption("--kept", &kept, "not given");
  line.AddOption("--number", &number, "X");
  line.AddOption("--count", &count, "N");
  line.AddOption("--large", &large, "N");
  line.AddOption("--free", &free, "NAME");
  line.AddFlag("--flag", &flag, "a flag");
  line.AddPositional("RUN", &runs, "RUN measured runs");
  const Outcome outcome = Parse(line, {"a", "b", "-o", "x", "--number", "-1.5e3", "--count", "-3", "--large",
                                       "8589934592", "--free", "k_1", "--free", "b", "--flag", "c"});
  EXPECT_EQ(outcome.code, std::nullopt) << outcome.err;
  EXPECT_THAT(runs, ElementsAre("a", "b", "c"));
  EXPECT_EQ(out, "x");
  EXPECT_EQ(kept, "kept");
  EXPECT_EQ(number, -1500);
  EXPECT_EQ(count, -3);
  EXPECT_EQ(large, 8589934592);
  EXPECT_THAT(free, ElementsAre("k_1", "b"));
  EXPECT_TRUE(flag);

  CommandLine other("hydro-test", "Does nothing.");
  other.AddOption("-o,--out", &out, "FILE where to write", true);
  EXPECT_THAT(Parse(other, {}).err, HasSubstr("--out: found nothing, allowed FILE (where to write"));
}

// Tests that an empty text is a value where a program says that it is one, and that what was given is known.
TEST(CommandLineTest, EmptyValuesAndGiven) {
  CommandLine line("hydro-test", "Does nothing.");
  std::optional<std::string> suffix, other;
  std::string out;
  bool flag = false;
  line.AddOption("--suffix", &suffix, "TEXT of channels");
  line.AddOption("--other", &other, "TEXT of channels");
  line.AddOption("-o,--out", &out, "FILE");
  line.AddFlag("--flag", &flag, "a flag");
  EXPECT_EQ(Parse(line, {"-o", "x", "--flag", "--suffix", ""}).code, std::nullopt);
  EXPECT_EQ(suffix, "");
  EXPECT_EQ(other, std::nullopt);
  EXPECT_THAT(line.Given(), ElementsAre("--suffix", "--out", "--flag"));
}

// Tests verbs with options of their own.
TEST(CommandLineTest, Verbs) {
  const auto run = [](std::vector<const char*> arguments, std::string* file, std::string* verb) {
    CommandLine line("hydro-test", "Reads logs.");
    CommandLine& info = line.AddVerb("info", "says what is in a log");
    info.AddPositional("LOG", file, "FILE a log");
    line.AddVerb("export", "writes a table").AddOption("-o,--out", file, "FILE the table", true);
    const Outcome outcome = Parse(line, std::move(arguments));
    *verb = line.verb();
    return outcome;
  };
  std::string file, verb;
  EXPECT_EQ(run({"info", "a.lcmlog"}, &file, &verb).code, std::nullopt);
  EXPECT_EQ(file, "a.lcmlog");
  EXPECT_EQ(verb, "info");
  EXPECT_EQ(run({"export", "-o", "a.csv"}, &file, &verb).code, std::nullopt);
  EXPECT_EQ(verb, "export");
  const struct {
    std::vector<const char*> arguments;
    const char* says;
  } usages[] = {
      {{}, "hydro-test: verb: found nothing, allowed \"info\" or \"export\""},
      {{"inof"}, "hydro-test: verb: found \"inof\", allowed \"info\" or \"export\", did you mean \"info\"?"},
      {{"info"}, "hydro-test info: LOG: found nothing, allowed FILE (a log)"},
      {{"export"}, "hydro-test export: --out: found nothing, allowed FILE (the table"},
      {{"info", "a", "--x"}, "hydro-test info: found the unexpected argument \"--x\""},
      {{"--x"}, "hydro-test: "},
  };
  for (const auto& usage : usages) {
    const Outcome outcome = run(usage.arguments, &file, &verb);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, StartsWith(usage.says));
    EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1) << outcome.err;
  }
  EXPECT_THAT(run({"info", "--help"}, &file, &verb).out, HasSubstr("says what is in a log"));
  EXPECT_THAT(run({"--help"}, &file, &verb).out, AllOf(HasSubstr("info"), HasSubstr("export")));
}

// Tests that a value's name may have an ending, as in a usage and in an error.
TEST(CommandLineTest, NameWithEnding) {
  std::string report;
  CommandLine line("hydro-test", "tests");
  line.AddOption("--timing", &report, "REPORT.json where to write");
  EXPECT_THAT(Parse(line, {"--help"}).out, ContainsRegex("--timing REPORT\\.json +where to write"));
  CommandLine other("hydro-test", "tests");
  other.AddOption("--timing", &report, "REPORT.json where to write");
  EXPECT_THAT(Parse(other, {"--timing"}).err, HasSubstr("--timing: found no value, allowed REPORT.json"));
}

// Tests that -o and --log are one file, never one of two in silence.
TEST(CommandLineTest, FileToRecord) {
  EXPECT_EQ(FileToRecord("", ""), "");
  EXPECT_EQ(FileToRecord("a", ""), "a");
  EXPECT_EQ(FileToRecord("", "b"), "b");
  try {
    FileToRecord("a", "b");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "--log: found \"b\" beside -o \"a\", allowed one of them");
  }
}

// Tests how the body's exceptions are reported.
TEST(RunProgramTest, ExitCodes) {
  EXPECT_EQ(RunProgram("p", [] { return 0; }), 0);
  EXPECT_EQ(RunProgram("p", [] { return 1; }), 1);
  CaptureStderr();
  EXPECT_EQ(RunProgram("p", []() -> int { throw InputError("a.toml:1: x: found 1, allowed 2"); }), 2);
  EXPECT_EQ(GetCapturedStderr(), "p: a.toml:1: x: found 1, allowed 2\n");
  CaptureStderr();
  EXPECT_EQ(RunProgram("p", []() -> int { throw std::runtime_error("it broke"); }), 1);
  EXPECT_EQ(GetCapturedStderr(), "p: it broke\n");
  CaptureStderr();
  EXPECT_EQ(RunProgram("p", []() -> int { throw std::bad_alloc(); }), 1);
  EXPECT_EQ(
      GetCapturedStderr(),
      "p: out of memory: it needs more than this process may have; a larger limit (ulimit -v) or a smaller "
      "input is needed\n");
}

}  // namespace
}  // namespace hydro::settings
