#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "bus/channels.h"
#include "hydro/process_status_t.hpp"
#include "runs/limb_info.h"
#include "runs/measured/measured_run.h"
#include "runs/recorded/channel_suffix.h"
#include "runs/recorded/compare.h"
#include "runs/recorded/run_config.h"
#include "runs/recorded/run_table.h"
#include "runs/recorded/senders.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::runs {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

// A message by which a limb's own channels are there.
log::EventContents StatusOn(const std::string& suffix) {
  process_status_t status{};
  status.role = "limb";
  std::string data(static_cast<size_t>(status.getEncodedSize()), '\0');
  status.encode(data.data(), 0, static_cast<int>(data.size()));
  return {bus::Channels(suffix).Of<process_status_t>(), data, 0};
}

// What a limb says of itself.
log::EventContents DescriptionEvent(const std::string& config_text) {
  run_description_t description{};
  description.config_text = config_text;
  std::string data(static_cast<size_t>(description.getEncodedSize()), '\0');
  description.encode(data.data(), 0, static_cast<int>(data.size()));
  return {"HYDRO_RUN", data, 0};
}

// What a limb sends of a run: a state in `interval` ticks, numbered anew.
RunMessages Sampled(int64_t ticks, int64_t interval) {
  RunMessages run = log::SampleRun(ticks);
  auto& states = run.Of<state_t>();
  std::erase_if(states, [&](const state_t& state) { return state.tick % interval != 0; });
  for (size_t i = 0; i < states.size(); ++i) states[i].sequence = static_cast<int64_t>(i);
  run.Of<run_description_t>().emplace_back().program = "hydro-limb";
  return run;
}

class LimbLogTest : public log::LogTest {
 protected:
  // A log with these runs, each on channels of its suffix; and on those of `limbs` what the limbs say
  // themselves.
  std::string Write(const std::vector<std::pair<std::string, RunMessages>>& runs,
                    const std::vector<std::string>& limbs = {""}) {
    std::vector<log::EventContents> all;
    for (const std::string& limb : limbs) all.push_back(StatusOn(limb));
    for (const auto& [suffix, run] : runs) {
      const bool sampled = !run.Of<run_description_t>().empty();
      log::WriteRun(Path("one"), run, suffix, "[plant]\nrate_hz = 1000\n[model]\nshaft = \"free\"\n", "",
                    sampled ? "hydro-limb" : "hydro-sim");
      for (log::EventContents& event : log::ReadEvents(Path("one"))) all.push_back(std::move(event));
    }
    log::WriteEvents(Path("log"), all);
    return Path("log");
  }
  size_t StatesOf(const StackChoice& choice) const {
    return ReadRunLog(Path("log"), choice).messages.Of<state_t>().size();
  }
  std::string ErrorOf(const StackChoice& choice) const {
    return log::InputErrorOf([&] { ReadRunLog(Path("log"), choice); });
  }
};

// Tests that a joint's name chooses its channels, and that errors name the joints.
TEST_F(LimbLogTest, ChoosesAJoint) {
  Write({{"_hip", log::SampleRun(3)}, {"_knee", log::SampleRun(5)}});
  EXPECT_EQ(StatesOf({.joint = "hip"}), 3u);
  EXPECT_EQ(StatesOf({.joint = "knee"}), 5u);
  EXPECT_EQ(StatesOf({.suffix = "_knee"}), 5u);
  EXPECT_EQ(ReadRunLog(Path("log"), {.joint = "knee"}).joint, "knee");
  EXPECT_EQ(DescribeCaution(ReadRunLog(Path("log"), {.joint = "knee"})), "");
  EXPECT_THAT(ErrorOf({}),
              HasSubstr("found channels of the joints \"hip\" or \"knee\"; choose one of them with --joint"));
  EXPECT_THAT(ErrorOf({.joint = "ankle"}),
              HasSubstr("--joint: found \"ankle\", allowed \"hip\" or \"knee\""));
}

// Tests that a simulated limb, which has no channels beside those of its joints, is read likewise, and one
// joint alone by its name or without.
TEST_F(LimbLogTest, WithoutTheLimbsOwnChannels) {
  Write({{"_hip", log::SampleRun(3)}, {"_knee", log::SampleRun(5)}}, {});
  EXPECT_EQ(StatesOf({.joint = "knee"}), 5u);
  EXPECT_THAT(ErrorOf({}), HasSubstr("--joint"));
  Write({{"_hip", log::SampleRun(3)}}, {});
  EXPECT_EQ(StatesOf({.joint = "hip"}), 3u);
  EXPECT_EQ(StatesOf({}), 3u);
}

// Tests that a joint whose name is the end of another's is told from it.
TEST_F(LimbLogTest, NamesThatEndAlike) {
  Write({{"_hip", log::SampleRun(3)}, {"_left_hip", log::SampleRun(5)}});
  EXPECT_EQ(StatesOf({.joint = "hip"}), 3u);
  EXPECT_EQ(StatesOf({.joint = "left_hip"}), 5u);
}

// Tests that of two limbs with a joint of that name --suffix says which.
TEST_F(LimbLogTest, TwoLimbs) {
  Write({{"_hip", log::SampleRun(3)}, {"_2_hip", log::SampleRun(5)}, {"_2_knee", log::SampleRun(7)}},
        {"", "_2"});
  EXPECT_EQ(StatesOf({.suffix = "_2", .joint = "hip"}), 5u);
  EXPECT_EQ(StatesOf({.suffix = "", .joint = "hip"}), 3u);
  EXPECT_EQ(StatesOf({.joint = "knee"}), 7u);
}

// Tests that a log of one stack has no joints, also where its channels end in something.
TEST_F(LimbLogTest, AStackIsNoLimb) {
  for (const std::string suffix : {"", "_2"}) {
    Write({{suffix, log::SampleRun(3)}}, {});
    EXPECT_FALSE(ReadLimbLog(Path("log"), {}).whole());
  }
  Write({{"", log::SampleRun(3)}, {"_2", log::SampleRun(5)}}, {});
  EXPECT_THAT(ErrorOf({}), HasSubstr("choose one of them with --suffix"));
  EXPECT_THAT(ErrorOf({.joint = "hip"}), HasSubstr("allowed for a log of a limb"));
}

// Tests that a limb's log is read as a whole, each joint with its own messages and channels.
TEST_F(LimbLogTest, AllJoints) {
  Write({{"_knee", log::SampleRun(5)}, {"_hip", log::SampleRun(3)}});
  const LimbLog log = ReadLimbLog(Path("log"), {});
  ASSERT_EQ(log.joints.size(), 2u);
  EXPECT_EQ(log.joints[0].joint, "hip");
  EXPECT_EQ(log.joints[1].messages.Of<state_t>().size(), 5u);
  EXPECT_EQ(log.limb.messages.Of<process_status_t>().size(), 1u);
  for (const ChannelSummary& channel : log.joints[0].channels)
    EXPECT_THAT(channel.channel, testing::EndsWith("_hip"));
  EXPECT_FALSE(ReadLimbLog(Path("log"), {.joint = "hip"}).whole());
}

// Tests that joints come in the order of the limb's configuration where the log has it, that those it does
// not name come last, and that text that is no configuration changes nothing.
TEST_F(LimbLogTest, JointsInTheOrderOfTheConfiguration) {
  const auto names = [&](const std::string& config_text) {
    Write({{"_ankle", log::SampleRun(3)}, {"_hip", log::SampleRun(3)}, {"_knee", log::SampleRun(3)}});
    std::vector<log::EventContents> all = log::ReadEvents(Path("log"));
    all.insert(all.begin(), DescriptionEvent(config_text));
    log::WriteEvents(Path("log"), all);
    std::vector<std::string> joints;
    for (const RunLog& joint : ReadLimbLog(Path("log"), {}).joints) joints.push_back(joint.joint);
    return joints;
  };
  EXPECT_THAT(names("[[joint]]\nname = 'knee'\n[[joint]]\nname = 'hip'\n"),
              ElementsAre("knee", "hip", "ankle"));
  for (const std::string text : {"", "[[joint", "joint = 5", "joint = [1, {name = 2}]"})
    EXPECT_THAT(names(text), ElementsAre("ankle", "hip", "knee")) << text;
  names("[[joint]]\nname = 'knee'\n[[joint]]\nname = 'hip'\n");
  const LimbLog ordered = ReadLimbLog(Path("log"), {});
  EXPECT_THAT(LimbSummaryText(SummariseLimb(ordered, false)), HasSubstr("--joint knee and so on"));
  Write({{"_ankle", log::SampleRun(3)}, {"_hip", log::SampleRun(3)}, {"_knee", log::SampleRun(3)}});
  EXPECT_EQ(FirstDifference(ordered, "a", ReadLimbLog(Path("log"), {}), "b"), std::nullopt);
}

// Tests that a joint of a limb with an [arm] is known as one, by its limb's description.
TEST_F(LimbLogTest, JointOfAnArm) {
  for (const bool arm : {false, true}) {
    Write({{"_hip", log::SampleRun(30)}, {"_knee", log::SampleRun(30)}});
    std::vector<log::EventContents> all = log::ReadEvents(Path("log"));
    all.push_back(DescriptionEvent(std::string("[[joint]]\nname = 'hip'\n") + (arm ? "[arm]\n" : "")));
    log::WriteEvents(Path("log"), all);
    EXPECT_EQ(ReadMeasuredRun(Path("log") + "#knee").in_an_arm, arm);
  }
}

// Tests that limbs are compared joint by joint, and that a joint in one of them alone is a difference.
TEST_F(LimbLogTest, Compares) {
  const LimbLog a = ReadLimbLog(Write({{"_hip", log::SampleRun(3)}, {"_knee", log::SampleRun(5)}}), {});
  EXPECT_EQ(FirstDifference(a, "a", a, "b"), std::nullopt);
  RunMessages other = log::SampleRun(5);
  other.Of<state_t>()[2].p1 = 7;
  const LimbLog b = ReadLimbLog(Write({{"_hip", log::SampleRun(3)}, {"_knee", other}}), {});
  EXPECT_THAT(FirstDifference(a, "a", b, "b").value_or(""),
              testing::StartsWith("joint knee: differ at tick 2"));
  const LimbLog c = ReadLimbLog(Write({{"_hip", log::SampleRun(3)}, {"_ankle", other}}), {});
  EXPECT_EQ(FirstDifference(a, "a", c, "c"), "differ: the joint knee is in a alone");
  EXPECT_EQ(FirstDifference(c, "c", a, "a"), "differ: the joint ankle is in c alone");
  const LimbLog one = ReadLimbLog(Write({{"_hip", log::SampleRun(3)}}), {});
  EXPECT_THAT(log::InputErrorOf([&] { FirstDifference(a, "a", one, "one"); }),
              HasSubstr("allowed are two of a kind"));
}

// Tests that info and summary have a row for each joint, with the names of faults, and all of each in JSON.
TEST_F(LimbLogTest, ARowForEachJoint) {
  Write({{"_hip", log::SampleRun(3)}, {"_knee", Sampled(101, 20)}});
  const LimbInfo info = SummariseLimb(ReadLimbLog(Path("log"), {}), false);
  for (const std::string& text : {LimbInfoText(info), LimbSummaryText(info)}) {
    EXPECT_THAT(text,
                AllOf(HasSubstr("a limb with 2 joints"), HasSubstr("\nhip "), HasSubstr("\nknee "),
                      HasSubstr("stale_state"), HasSubstr("a state every 20 ticks (limb.telemetry_hz)")));
  }
  EXPECT_THAT(LimbInfoText(info), HasSubstr("fault: tick 2: hip pressure_ctrl: stale_state begins"));
  for (const std::string& text : {LimbInfoJson(info), LimbSummaryJson(info)}) {
    const auto json = nlohmann::json::parse(text);
    EXPECT_TRUE(json["joints"]["hip"].contains("tracking"));
    EXPECT_EQ(json["joints"]["knee"]["faults"].size(), 1u);
    EXPECT_EQ(json["faults"].size(), 2u);
  }
}

// Tests that a joint with states of several runs has no figures over them, and that its limb is refused where
// one run is wanted.
TEST_F(LimbLogTest, SeveralRunsOfAJoint) {
  RunMessages two = log::SampleRun(5);
  const RunMessages first = two;
  for (state_t state : first.Of<state_t>()) {
    state.session = 21;
    state.arm_angle += 100;
    two.Of<state_t>().push_back(state);
  }
  Write({{"_hip", log::SampleRun(3)}, {"_knee", two}});
  const LimbLog log = ReadLimbLog(Path("log"), {});
  EXPECT_THAT(log::InputErrorOf([&] { RequireOneRun(log); }),
              HasSubstr("found states from 2 senders on HYDRO_STATE_knee"));
  const LimbInfo info = SummariseLimb(log, false);
  EXPECT_TRUE(info.joints[0].tracking.has_reference);
  EXPECT_FALSE(info.joints[1].tracking.has_reference);
  EXPECT_EQ(info.joints[1].info.senders.size(), 2u);
  EXPECT_THAT(LimbInfoText(info), HasSubstr("joint knee has states of several runs: --joint shows each"));
}

// Tests that what a limb leaves out on purpose is neither missing nor lost, and that what is missing besides
// is.
TEST_F(LimbLogTest, SamplesAreNotGaps) {
  RunMessages run = Sampled(401, 20);
  EXPECT_EQ(SampleTicks(run), 20);
  run.Of<state_t>()[3].skipped_ticks = 2;
  run.Of<state_t>().erase(run.Of<state_t>().begin() + 10);
  Write({{"_hip", run}}, {});
  const LogInfo info = Summarise(ReadRunLog(Path("log")), false);
  EXPECT_EQ(info.ticks.sampled, 20);
  EXPECT_EQ(info.ticks.gaps, 1);
  EXPECT_EQ(info.ticks.missing, 20 + 2);
  EXPECT_EQ(info.ticks.announced, 2);
  EXPECT_THAT(InfoText(info), HasSubstr("sampled: a state every 20 ticks"));

  RunMessages lossy = log::SampleRun(401);
  std::erase_if(lossy.Of<state_t>(), [](const state_t& state) { return state.tick % 20 != 0; });
  EXPECT_EQ(SampleTicks(lossy), 1);  // the numbers say that messages are missing
  EXPECT_EQ(SampleTicks(log::SampleRun(5)), 1);
}

// Tests that a table of samples has the voltage that is known, and that a model is not fitted to samples.
TEST_F(LimbLogTest, SamplesAsATable) {
  Write({{"_hip", Sampled(101, 20)}, {"_knee", log::SampleRun(30)}});
  const tables::Table table = ExportRun(ReadRunLog(Path("log"), {.joint = "hip"}));
  ASSERT_EQ(table.rows(), 6u);
  EXPECT_EQ(table.Find("voltage_V")->values[1], -0.5 + 20 - 1);
  EXPECT_THAT(log::InputErrorOf([&] { ReadMeasuredRun(Path("log") + "#hip"); }),
              AllOf(HasSubstr("joint hip: found a state every 20 ticks"),
                    HasSubstr("limb.telemetry_hz = \"every_tick\"")));
}

// Tests that LOG#NAME is a joint, and that a file with such a name is a file.
TEST_F(LimbLogTest, RunNames) {
  EXPECT_EQ(ParseRunName("limb.lcmlog#hip").file, "limb.lcmlog");
  EXPECT_EQ(ParseRunName("limb.lcmlog#hip").joint, "hip");
  EXPECT_EQ(ParseRunName("run.csv").joint, std::nullopt);
  log::WriteBytes(Path("odd#name"), "");
  EXPECT_EQ(ParseRunName(Path("odd#name")).joint, std::nullopt);
  EXPECT_THAT(log::InputErrorOf([&] { ReadMeasuredRun(Path("run.csv") + "#hip"); }), HasSubstr("of a table"));
}

// Tests that the configuration of a limb is listed joint by joint.
TEST_F(LimbLogTest, ConfigEntriesByJoint) {
  run_description_t description{};
  description.config_text =
      "[time]\nmode = 'realtime'\n[[joint]]\nname = 'hip'\n[joint.limits]\npressure_psi = 5\n";
  EXPECT_THAT(
      ConfigEntries(description, "log"),
      ElementsAre(testing::Pair("joint.hip.limits.pressure_psi", "5"),
                  testing::Pair("joint.hip.name", "'hip'"), testing::Pair("time.mode", "'realtime'")));
}

}  // namespace
}  // namespace hydro::runs
