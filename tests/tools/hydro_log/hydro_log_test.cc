#include "tools/hydro_log/hydro_log.h"

#include <gmock/gmock.h>

#include "hydro/loop_statistics_t.hpp"
#include "tests/runs/log/log_fixture.h"

namespace hydro::hydro_log {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

struct Outcome {
  int exit_code;
  std::string out;
  std::string err;
};

Outcome HydroLog(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "hydro-log");
  std::vector<const char*> argv;
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int exit_code = RunHydroLog(static_cast<int>(argv.size()), argv.data());
  std::fflush(stdout);
  return {exit_code, testing::internal::GetCapturedStdout(), testing::internal::GetCapturedStderr()};
}

// What hydro-log timing needs in a log.
log::EventContents LoopReport() {
  loop_statistics_t report{};
  report.role = "plant";
  std::string data(static_cast<size_t>(report.getEncodedSize()), '\0');
  report.encode(data.data(), 0, static_cast<int>(data.size()));
  return {"HYDRO_LOOP_STATISTICS", data, 9000};
}

class HydroLogTest : public log::LogTest {};

// Tests that equal runs print exactly "identical" and that a difference exits 1, even across suffixes.
TEST_F(HydroLogTest, Compare) {
  runs::RunMessages run = log::SampleRun(9);
  log::WriteRun(Path("a"), run);
  log::WriteRun(Path("b"), run, "_2");
  const Outcome same = HydroLog({"compare", Path("a"), Path("b")});
  EXPECT_EQ(same.exit_code, 0) << same.err;
  EXPECT_EQ(same.out, "identical\n");
  run.Of<state_t>()[4].p2 = 7;
  log::WriteRun(Path("b"), run);
  const Outcome different = HydroLog({"compare", Path("a"), Path("b")});
  EXPECT_EQ(different.exit_code, 1);
  EXPECT_THAT(different.out, AllOf(StartsWith("differ at tick 4: HYDRO_STATE.p2: "),
                                   HasSubstr(" and 7 (" + Path("b") + ")\n")));
}

// Tests that two logs without a run are not called identical.
TEST_F(HydroLogTest, CompareOfNothing) {
  log::WriteBytes(Path("a"), "");
  const Outcome outcome = HydroLog({"compare", Path("a"), Path("a")});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.out, "");
  runs::RunMessages run = log::SampleRun(9);
  log::WriteRun(Path("run"), run);
  run.Of<state_t>().clear();  // it ended before its first state
  log::WriteRun(Path("b"), run);
  const Outcome failed = HydroLog({"compare", Path("b"), Path("b")});
  EXPECT_EQ(failed.exit_code, 2);
  EXPECT_THAT(failed.err, HasSubstr("found no state, and none in " + Path("b") + ": nothing was compared"));
  EXPECT_EQ(HydroLog({"compare", Path("b"), Path("run")}).exit_code, 1);
}

// Tests that a log survives the way through a table of either kind and back.
TEST_F(HydroLogTest, ExportAndImport) {
  log::WriteRun(Path("log"), log::SampleRun(9));
  for (const char* kind : {".csv", ".mat"}) {
    const std::string first = Path("first") + kind;
    const std::string second = Path("second") + kind;
    EXPECT_EQ(HydroLog({"export", Path("log"), "-o", first}).exit_code, 0);
    EXPECT_EQ(HydroLog({"import", first, "-o", Path("imported") + kind}).exit_code, 0);
    EXPECT_EQ(HydroLog({"export", Path("imported") + kind, "-o", second}).exit_code, 0);
    EXPECT_EQ(log::ReadBytes(second), log::ReadBytes(first));
    EXPECT_GT(log::ReadBytes(first).size(), 200u);
  }
}

// Tests that a table in SI units is one in the base units of one system, for arms that turn and that move
// along a line and models in any units, and that it survives the way through a log and back.
TEST_F(HydroLogTest, ExportInSiAndImport) {
  int run = 0;  // names of their own: a process replaces nothing that it has read
  for (const auto& [length, force] :
       {std::pair<std::string, std::string>("in", "lbf"), {"mm", "N"}, {"cm", "daN"}, {"m", "N"}}) {
    for (const std::string& arm : {std::string("rad"), length}) {
      const auto path = [&, n = ++run](const char* name) { return Path(std::to_string(n) + name); };
      const bool linear = arm != "rad";
      log::WriteRun(path("log"), log::SampleRun(9), "", "[plant]\nrate_hz = 1000\n",
                    "units = { length = \"" + length + "\", force = \"" + force +
                        (linear ? "\", arm = \"" + arm : "") + "\" }\n");
      const Outcome exported = HydroLog({"export", path("log"), "--si", "-o", path("si.csv")});
      ASSERT_EQ(exported.exit_code, 0) << exported.err;
      const std::string table = log::ReadBytes(path("si.csv"));
      EXPECT_THAT(table,
                  StartsWith(linear ? "time_s,tick,voltage_V,pressure_ref_Pa,arm_ref_m,motor_angle_rad,"
                                      "motor_speed_rad_s,arm_angle_m,arm_speed_m_s,p1_Pa,p2_Pa\n"
                                    : "time_s,tick,voltage_V,pressure_ref_Pa,arm_ref_rad,motor_angle_rad,"
                                      "motor_speed_rad_s,arm_angle_rad,arm_speed_rad_s,p1_Pa,p2_Pa\n"));
      const Outcome imported = HydroLog({"import", path("si.csv"), "-o", path("imported")});
      ASSERT_EQ(imported.exit_code, 0) << imported.err;
      EXPECT_EQ(HydroLog({"export", path("imported"), "-o", path("again.csv")}).exit_code, 0);
      EXPECT_EQ(log::ReadBytes(path("again.csv")), table) << length << " " << linear;
      EXPECT_EQ(HydroLog({"export", path("imported"), "--si", "-o", path("si_again.csv")}).exit_code, 0);
      EXPECT_EQ(log::ReadBytes(path("si_again.csv")), table) << "it is in SI already";
    }
  }
}

// Tests what repair prints and leaves, with and without damage.
TEST_F(HydroLogTest, Repair) {
  log::WriteRun(Path("log"), log::SampleRun(9));
  const std::string whole = log::ReadBytes(Path("log"));
  EXPECT_EQ(HydroLog({"repair", Path("log")}).out, Path("log") + ": nothing to repair\n");
  EXPECT_FALSE(std::filesystem::exists(Path("log.damaged")));
  std::string flipped = whole;
  flipped[whole.size() / 2] ^= 1;
  log::WriteBytes(Path("log"), flipped);
  const Outcome broken = HydroLog({"info", Path("log")});
  EXPECT_EQ(broken.exit_code, 2);
  EXPECT_THAT(broken.out, HasSubstr("log: damaged: byte "));
  EXPECT_THAT(broken.err, HasSubstr("hydro-log repair " + Path("log")));
  const Outcome repaired = HydroLog({"repair", Path("log")});
  EXPECT_EQ(repaired.exit_code, 0);
  EXPECT_THAT(repaired.out, AllOf(HasSubstr(": kept "), HasSubstr(": lost bytes "),
                                  HasSubstr(": as it was found it is now " + Path("log.damaged") + "\n")));
  EXPECT_EQ(HydroLog({"info", Path("log")}).exit_code, 0);
}

// Tests that repair says of logs that were joined with which command to take them apart, intact or not, with
// checksums or without, and that the command gives back what was joined, under names that end as logs do; and
// of two runs in one recording that they are two.
TEST_F(HydroLogTest, RepairOfJoinedLogs) {
  log::WriteRun(Path("a.lcmlog"), log::SampleRun(9));
  log::WriteRun(Path("b.lcmlog"), log::SampleRun(20));
  const std::string a = log::ReadBytes(Path("a.lcmlog")), b = log::ReadBytes(Path("b.lcmlog"));
  const auto take_apart = [&](const std::string& name, const std::string& bytes) {
    log::WriteBytes(Path(name), bytes);
    const Outcome outcome = HydroLog({"repair", Path(name)});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.out;
  };
  EXPECT_THAT(
      take_apart("all it's.lcmlog", a + b + a),
      AllOf(HasSubstr(": nothing to repair\n"), HasSubstr(": 3 recordings were joined in it"),
            HasSubstr("hydro-log repair --split '"), HasSubstr("all it'\\''s.lcmlog' takes them apart")));
  const Outcome all = HydroLog({"repair", "--split", Path("all it's.lcmlog")});
  EXPECT_EQ(all.exit_code, 0) << all.err;
  EXPECT_THAT(all.out, StartsWith(Path("all it's-1.lcmlog") + ": complete\n"));
  EXPECT_EQ(log::ReadBytes(Path("all it's-1.lcmlog")), a);
  EXPECT_EQ(log::ReadBytes(Path("all it's-2.lcmlog")), b);
  EXPECT_EQ(log::ReadBytes(Path("all it's-3.lcmlog")), a);
  const Outcome again = HydroLog({"repair", "--split", Path("all it's.lcmlog")});
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.err, HasSubstr("all it's-1.lcmlog"));
  std::string flipped = a;
  flipped[a.size() / 2] ^= 1;
  EXPECT_THAT(take_apart("torn.lcmlog", flipped + b),
              HasSubstr("hydro-log repair --split " + Path("torn.lcmlog.damaged")));
  EXPECT_THAT(HydroLog({"repair", "--split", Path("torn.lcmlog.damaged")}).out,
              HasSubstr("; hydro-log repair " + Path("torn-1.lcmlog") + " keeps what can be read\n"));
  EXPECT_EQ(log::ReadBytes(Path("torn-1.lcmlog")), flipped);
  EXPECT_EQ(log::ReadBytes(Path("torn-2.lcmlog")), b);
  const Outcome one = HydroLog({"repair", "--split", Path("b.lcmlog")});
  EXPECT_EQ(one.exit_code, 2);
  EXPECT_THAT(one.err, HasSubstr("b.lcmlog: found one recording"));
  EXPECT_THAT(HydroLog({"repair", "--split", Path("b.lcmlog"), "-o", Path("c")}).err,
              HasSubstr("--split: found it beside -o"));
  EXPECT_EQ(take_apart("alone", b), Path("alone") + ": nothing to repair\n");
  runs::RunMessages both = log::SampleRun(9);
  runs::RunMessages other = both;
  for (state_t& state : other.Of<state_t>()) {
    state.session = 77;
    both.Of<state_t>().push_back(state);
  }
  log::WriteRun(Path("two"), both);
  EXPECT_THAT(HydroLog({"repair", Path("two")}).out,
              AllOf(HasSubstr(": nothing to repair\n"), HasSubstr("found states from 2 senders"),
                    HasSubstr("record each into a log of its own")));
}

// Tests that each verb says of an incomplete log that it is one, and refuses a damaged one in one line that
// names file, place and cure.
TEST_F(HydroLogTest, IncompleteAndDamaged) {
  log::WriteRun(Path("whole"), log::SampleRun(400));
  const std::string whole = log::ReadBytes(Path("whole"));
  log::WriteBytes(Path("cut"), whole.substr(0, whole.size() / 2));
  std::string flipped = whole;
  flipped[whole.size() / 2] ^= 4;
  log::WriteBytes(Path("flipped"), flipped);

  const Outcome info = HydroLog({"info", Path("cut")});
  EXPECT_EQ(info.exit_code, 0);
  EXPECT_THAT(info.out, HasSubstr("\nlog: incomplete: no mark of the end at byte "));
  EXPECT_THAT(HydroLog({"info", "--json", Path("cut")}).out, HasSubstr("\"verdict\": \"incomplete\""));
  EXPECT_THAT(HydroLog({"info", Path("whole")}).out, HasSubstr("\nlog: complete\n"));
  EXPECT_THAT(
      HydroLog({"summary", Path("cut")}).out,
      AllOf(HasSubstr("\nlog: incomplete: "), HasSubstr("\nwhere this log ends (the run may go on): ")));
  const Outcome whole_summary = HydroLog({"summary", Path("whole")});
  EXPECT_THAT(whole_summary.out, testing::Not(HasSubstr("may go on")));

  const Outcome same = HydroLog({"compare", Path("cut"), Path("cut")});
  EXPECT_EQ(same.out, "identical in what is there (the logs are not whole)\n");
  for (const std::vector<std::string>& verb : std::vector<std::vector<std::string>>{
           {"export", "-o", Path("out.csv")}, {"compare", Path("cut")}, {"summary"}}) {
    std::vector<std::string> arguments = verb;
    arguments.push_back(Path("cut"));
    const Outcome cut = HydroLog(arguments);
    EXPECT_EQ(cut.exit_code, 0) << verb[0] << cut.err;
    if (verb[0] != "summary") {
      EXPECT_THAT(cut.err, StartsWith("hydro-log: warning: " + Path("cut") + ": incomplete: ")) << verb[0];
    }
    arguments.back() = Path("flipped");
    const Outcome damaged = HydroLog(arguments);
    EXPECT_EQ(damaged.exit_code, 2) << verb[0];
    EXPECT_THAT(damaged.err, AllOf(HasSubstr(Path("flipped") + ": byte "),
                                   HasSubstr("hydro-log repair " + Path("flipped"))));
  }
}

// Tests that messages removed from a log are missing messages, not late wake-ups of the plant, and that gaps
// that are neither are said too.
TEST_F(HydroLogTest, MissingIsNotSkipped) {
  runs::RunMessages run = log::SampleRun(400);
  std::vector<state_t>& states = run.Of<state_t>();
  states.erase(states.begin() + 100, states.begin() + 250);
  states[120].skipped_ticks = 0;
  states.erase(states.begin() + 200, states.begin() + 203);  // three ticks that the plant skipped
  for (size_t k = 200; k < states.size(); ++k) states[k].sequence -= 3;
  states[200].skipped_ticks = 3;
  log::WriteRun(Path("log"), run);
  const Outcome summary = HydroLog({"summary", Path("log")});
  EXPECT_THAT(summary.out, HasSubstr(", 3 ticks skipped (late wake-ups), 150 messages missing from the log"));
  EXPECT_THAT(HydroLog({"info", Path("log")}).out,
              HasSubstr("without state: 153, of which the plant skipped 3 and 150 are missing from the log"));
  EXPECT_THAT(summary.out, Not(HasSubstr("no state")));
  // Of an imported table, whose rows are numbered anew, only the ticks tell.
  for (size_t k = 0; k < states.size(); ++k) states[k].sequence = static_cast<int64_t>(k);
  log::WriteRun(Path("imported"), run);
  EXPECT_THAT(HydroLog({"summary", Path("imported")}).out,
              HasSubstr("153 ticks have no state in the log, from the first to the last\n"));
}

// Tests that of a log whose description is damaged, info and the messages can be had, and that the verbs that
// need the description say so.
TEST_F(HydroLogTest, DamagedDescription) {
  log::WriteRun(Path("log"), log::SampleRun(20), "", "[plant]\nrate_hz = 1000\n", "name \x1d \"Table 1\"\n");
  for (const std::vector<std::string>& verb : std::vector<std::vector<std::string>>{
           {"summary", Path("log")}, {"replay", Path("log")}, {"export", Path("log"), "-o", "-"}}) {
    const Outcome outcome = HydroLog(verb);
    EXPECT_EQ(outcome.exit_code, 2) << verb[0];
    EXPECT_THAT(outcome.err,
                AllOf(HasSubstr("run description: model:1: syntax: "),
                      HasSubstr("description of its run (HYDRO_RUN) is damaged: hydro-log info, and "
                                "export --channel HYDRO_STATE, do without it\n")));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
  EXPECT_EQ(HydroLog({"info", Path("log")}).exit_code, 0);
  const Outcome states = HydroLog({"export", Path("log"), "--channel", "HYDRO_STATE", "-o", "-"});
  EXPECT_EQ(states.exit_code, 0);
  EXPECT_THAT(states.err, HasSubstr("is damaged: "));
  EXPECT_THAT(states.err, HasSubstr("; exported without units\n"));
  EXPECT_EQ(std::count(states.out.begin(), states.out.end(), '\n'), 21);
  const Outcome all = HydroLog({"export", Path("log"), "-o", Path("all.mcap")});
  EXPECT_EQ(all.exit_code, 0) << all.err;
  EXPECT_THAT(all.err, HasSubstr("; exported without the run's table and units\n"));
  EXPECT_EQ(HydroLog({"export", Path("log"), "--channel", "HYDRO_STATE", "--si", "-o", "-"}).exit_code, 2);
}

// Tests that an undecodable message, which a foreign program may send, is no reason to refuse the log: info
// counts it, and the other verbs mention it in one line; only verbs that promise the same bits refuse.
TEST_F(HydroLogTest, UndecodableMessages) {
  runs::RunMessages run = log::SampleRun(9);
  log::WriteRun(Path("whole"), run);
  std::vector<log::EventContents> events = log::ReadEvents(Path("whole"));
  events.push_back(LoopReport());
  log::WriteEvents(Path("whole"), events);
  events.insert(events.begin() + 4, {"HYDRO_MOTOR_COMMAND", "\x1b[2J not of this stack", 5});
  events.insert(events.begin() + 8, {"HYDRO_STATE", "torn", 5});
  log::WriteEvents(Path("log"), events);

  const Outcome text = HydroLog({"info", Path("log")});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_EQ(text.err, "");
  EXPECT_THAT(text.out, AllOf(HasSubstr("  1 undecodable\n"), HasSubstr("event 4 on HYDRO_MOTOR_COMMAND")));
  EXPECT_THAT(HydroLog({"info", Path("log"), "--json"}).out, HasSubstr("\"undecodable\": 1"));
  EXPECT_THAT(HydroLog({"info", Path("whole")}).out, testing::Not(HasSubstr("undecodable")));

  for (const std::vector<std::string>& verb :
       {std::vector<std::string>{"summary"}, {"timing"}, {"export", "-o", Path("out.csv")}}) {
    std::vector<std::string> arguments = verb;
    arguments.insert(arguments.begin() + 1, Path("log"));
    const Outcome outcome = HydroLog(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << verb[0] << outcome.err;
    EXPECT_THAT(outcome.err, StartsWith("hydro-log: warning: " + Path("log") + ": left out 2 messages"));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
  EXPECT_EQ(HydroLog({"export", Path("whole"), "-o", Path("whole.csv")}).err, "");
  EXPECT_EQ(log::ReadBytes(Path("out.csv")), log::ReadBytes(Path("whole.csv")));

  const Outcome compared = HydroLog({"compare", Path("whole"), Path("log")});
  EXPECT_EQ(compared.exit_code, 2);
  EXPECT_THAT(compared.err, HasSubstr("hydro-log repair " + Path("log")));
}

// Tests that bad usage and bad input exit 2 with one line that names the place, and leave no file.
TEST_F(HydroLogTest, BadUsageAndInput) {
  log::WriteRun(Path("log"), log::SampleRun(3));
  log::WriteEvents(Path("timed"), {LoopReport()});
  log::WriteBytes(Path("bad.csv"), "time_s,p1_psi\n0,1\n1,x\n");
  log::WriteBytes(Path("good.csv"), "time_s,p1_psi\n0,1\n1,2\n");
  log::WriteRun(Path("log.csv"), log::SampleRun(3));
  log::WriteBytes(Path("empty"), "");
  const std::string out = Path("out.csv");
  const struct {
    std::vector<std::string> arguments;
    std::string says;
  } cases[] = {
      {{}, "verb"},
      {{"examine", Path("log")}, "examine"},
      {{"info"}, "LOG"},
      {{"info", Path("none")}, Path("none") + ": cannot be read: No such file or directory"},
      {{"info", Path("log"), "--suffix", "_9"}, "no channel with suffix '_9'"},
      {{"export", Path("log")}, "--output"},
      {{"export", Path("log"), "-o", Path("out.txt")}, Path("out.txt")},
      {{"export", Path("log"), "-o", Path("none/out.csv")}, Path("none/out.csv") + ": cannot be created"},
      {{"export", Path("empty"), "-o", out}, "found no message on HYDRO_STATE"},
      {{"export", Path("bad.csv"), "-o", out}, Path("bad.csv") + ": found text, allowed an LCM event log"},
      {{"import", Path("bad.csv"), "-o", out}, Path("bad.csv") + ": line 3, column p1_psi: found \"x\""},
      {{"import", Path("log"), "-o", out}, Path("log")},
      {{"compare", Path("log"), Path("none")}, Path("none")},
      {{"repair", Path("bad.csv"), "-o", out}, "found text, allowed an LCM event log"},
      {{"import", Path("good.csv"), "-o", Path("good.csv")},
       Path("good.csv") + ": found the name of a file that is read"},
      {{"export", Path("log.csv"), "-o", Path("log.csv")},
       Path("log.csv") + ": found the name of a file that is read"},
      {{"timing", Path("log"), "--json", Path("log")},
       Path("log") + ": found the name of a file that is read"},
      {{"timing", Path("log"), "--page", Path("log")},
       Path("log") + ": found the name of a file that is read"},
      {{"timing", Path("timed"), "--json", Path("none/x")}, Path("none/x") + ": cannot be created"},
      {{"timing", Path("timed"), "--page", Path("none/x")}, Path("none/x") + ": cannot be created"},
      {{"summary", Path("log"), "--json", Path("none/x")}, Path("none/x") + ": cannot be created"},
      {{"timing", Path("timed"), "--json", ""}, "--json: found \"\", allowed FILE"},
      {{"info", ""}, "LOG: found \"\", allowed FILE"},
      {{"summary", Path("log"), "--json", Path("log")},
       Path("log") + ": found the name of a file that is read"},
  };
  for (const auto& bad : cases) {
    const Outcome outcome = HydroLog(bad.arguments);
    EXPECT_EQ(outcome.exit_code, 2) << bad.says;
    EXPECT_EQ(outcome.out, "") << bad.says;
    EXPECT_THAT(outcome.err, HasSubstr(bad.says));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(out)) << bad.says;
    EXPECT_FALSE(std::filesystem::exists(out + ".part")) << bad.says;
  }
}

// Tests that JSON and a page go to the standard output where their file is -, and nothing else then does.
TEST_F(HydroLogTest, StandardOutput) {
  log::WriteRun(Path("log"), log::SampleRun(9));
  log::WriteEvents(Path("timed"), {LoopReport()});
  const struct {
    std::string verb, log, option, begins;
  } cases[] = {{"summary", Path("log"), "--json", "{\n"},
               {"timing", Path("timed"), "--json", "{\n"},
               {"timing", Path("timed"), "--page", "<!DOCTYPE html>"}};
  for (const auto& one : cases) {
    const Outcome beside = HydroLog({one.verb, one.log, one.option, Path("file")});
    const Outcome piped = HydroLog({one.verb, one.log, one.option, "-"});
    EXPECT_EQ(piped.exit_code, 0) << piped.err;
    EXPECT_THAT(piped.out, StartsWith(one.begins));
    EXPECT_EQ(piped.out, log::ReadBytes(Path("file")));
    EXPECT_EQ(piped.err, beside.out + beside.err);
    EXPECT_FALSE(std::filesystem::exists("-"));
  }
  const Outcome both = HydroLog({"timing", Path("timed"), "--json", "-", "--page", "-"});
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_THAT(both.err, HasSubstr("-: found two outputs of this name"));
}

// Tests that a full disk is a failure of the work, not bad input.
TEST_F(HydroLogTest, DiskFull) {
  log::WriteRun(Path("log"), log::SampleRun(3));
  const Outcome outcome = HydroLog({"repair", Path("log"), "-o", "/dev/full"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("/dev/full: cannot be written: No space left on device"));
}

// Tests that a log with two joints is read whole without --joint, and one joint with it.
TEST_F(HydroLogTest, Joints) {
  log::WriteRun(Path("hip"), log::SampleRun(9), "_hip");
  log::WriteRun(Path("knee"), log::SampleRun(5), "_knee");
  std::vector<log::EventContents> both = log::ReadEvents(Path("hip"));
  for (const log::EventContents& event : log::ReadEvents(Path("knee"))) both.push_back(event);
  const std::string limb = Path("limb");
  log::WriteEvents(limb, both);
  for (const char* verb : {"info", "summary"}) {
    const Outcome all = HydroLog({verb, limb});
    EXPECT_EQ(all.exit_code, 0) << all.err;
    EXPECT_THAT(all.out, AllOf(HasSubstr("a limb with 2 joints"), HasSubstr("\nhip "), HasSubstr("\nknee ")));
    const Outcome one = HydroLog({verb, limb, "--joint", "knee"});
    EXPECT_EQ(one.exit_code, 0) << one.err;
    EXPECT_THAT(one.out, testing::Not(HasSubstr("a limb with")));
    EXPECT_EQ(one.err, "");
  }
  EXPECT_EQ(HydroLog({"compare", limb, limb}).out, "identical\n");
  EXPECT_EQ(HydroLog({"compare", limb, Path("knee"), "--joint", "knee"}).out, "identical\n");
  EXPECT_EQ(HydroLog({"export", limb, "-o", Path("limb.csv")}).exit_code, 0);
  EXPECT_THAT(log::ReadBytes(Path("limb.csv")),
              AllOf(StartsWith("run,"), HasSubstr("\nlimb_hip,"), HasSubstr("\nlimb_knee,")));
  const Outcome several = HydroLog({"import", Path("limb.csv"), "-o", Path("again")});
  EXPECT_EQ(several.exit_code, 2);
  EXPECT_THAT(several.err, AllOf(HasSubstr("line 2, column run: found \"limb_hip\", allowed a number"),
                                 HasSubstr("export one, a limb's joint with hydro-log export --joint NAME")));
  EXPECT_EQ(HydroLog({"export", limb, "--joint", "hip", "-o", Path("hip.csv")}).exit_code, 0);
  EXPECT_THAT(log::ReadBytes(Path("hip.csv")), StartsWith("time_s,"));
  const Outcome wrong = HydroLog({"summary", limb, "--joint", "ankle"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_EQ(wrong.err, "hydro-log: " + limb + ": --joint: found \"ankle\", allowed \"hip\" or \"knee\"\n");
}

}  // namespace
}  // namespace hydro::hydro_log
