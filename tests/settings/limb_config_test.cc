#include "settings/limb_config.h"

#include <sys/inotify.h>
#include <unistd.h>

#include "settings/joint_documents.h"
#include "settings/limb_processes.h"
#include "tests/settings/texts.h"

namespace hydro::settings {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

constexpr char kJoints[] = R"(
[limb]
telemetry_hz = 100

[[joint]]
name = "hip"

[[joint]]
name = "knee"
[joint.position]
c1 = 900
[joint.pressure]
k_p = 0.1
k_v = 9
[joint.reference]
kind = "sine"
amplitude = 0.02
frequency_hz = 2
)";

class LimbConfigTest : public FolderTest {
 protected:
  std::string File(const std::string& text) {
    Write("model.toml", kModelText);
    return Write("limb.toml", text);
  }
  LimbConfig Load(const std::string& more = kJoints, const std::vector<std::string>& overrides = {}) {
    return LoadLimbConfig(File(std::string(kConfigText) + more), overrides);
  }
  std::string Error(const std::string& more, const std::vector<std::string>& overrides = {}) {
    return InputErrorOf([&] { Load(more, overrides); });
  }
};

// Tests that a joint has what all have in common, with its own over it, on channels of its own, and that a
// choice among alternatives drops the common one.
TEST_F(LimbConfigTest, OwnOverCommon) {
  const LimbConfig limb = Load();
  ASSERT_EQ(limb.joints.size(), 2U);
  EXPECT_THAT(limb.common.joints, ElementsAre("hip", "knee"));
  EXPECT_THAT(limb.common.bus.joint_suffixes, ElementsAre("_hip", "_knee"));
  EXPECT_EQ(limb.common.bus.channel_suffix, "");
  const StackConfig& hip = limb.joints[0].config;
  const StackConfig& knee = limb.joints[1].config;
  EXPECT_EQ(hip.bus.channel_suffix, "_hip");
  EXPECT_EQ(hip.position.c1, 10500);
  EXPECT_EQ(hip.reference.trajectory.kind, TrajectorySpec::Kind::kSteps);
  EXPECT_EQ(knee.position.c1, 900);
  EXPECT_EQ(knee.position.c2, hip.position.c2);
  EXPECT_EQ(knee.pressure.k_p, 0.1);
  EXPECT_FALSE(knee.pressure.damping_ratio.has_value());
  EXPECT_EQ(knee.reference.trajectory.kind, TrajectorySpec::Kind::kSine);
  EXPECT_THAT(knee.reference.trajectory.steps, IsEmpty());
  EXPECT_EQ(limb.limb.on_joint_fault, OnJointFault::kAllToZero);
  EXPECT_EQ(limb.limb.telemetry_hz, 100);
}

// Tests that each joint's noise has a seed of its own, counted up from the configuration's, and that a joint
// may state one.
TEST_F(LimbConfigTest, Seeds) {
  const std::string own = std::string(kJoints) + "[[joint]]\nname = \"ankle\"\n[joint.noise]\nseed = 77\n";
  const auto seeds = [&](const std::vector<std::string>& overrides) {
    std::vector<int64_t> all;
    for (const JointConfig& joint : Load(own, overrides).joints) all.push_back(joint.config.seed);
    return all;
  };
  EXPECT_THAT(seeds({}), ElementsAre(1, 2, 77));
  EXPECT_THAT(seeds({"noise.seed=40"}), ElementsAre(40, 41, 42));
}

// Tests that an override holds for every joint, also over its own, and one with a joint's name for that one.
TEST_F(LimbConfigTest, Overrides) {
  const LimbConfig all = Load(kJoints, {"position.c1=5"});
  EXPECT_EQ(all.joints[0].config.position.c1, 5);
  EXPECT_EQ(all.joints[1].config.position.c1, 5);
  const LimbConfig one = Load(kJoints, {"joint.hip.position.c1=6", "limb.on_joint_fault=others_go_on"});
  EXPECT_EQ(one.joints[0].config.position.c1, 6);
  EXPECT_EQ(one.joints[1].config.position.c1, 900);
  EXPECT_EQ(one.limb.on_joint_fault, OnJointFault::kOthersGoOn);
}

// Tests that a joint alone is the joint of the limb: the same text, and knows the others, whose faults
// concern it.
TEST_F(LimbConfigTest, JointAlone) {
  const LimbConfig limb = Load();
  const StackConfig alone = LoadStackConfig(File(std::string(kConfigText) + kJoints), {"joint=knee"});
  EXPECT_EQ(alone.text, limb.joints[1].config.text);
  EXPECT_EQ(alone.agreed, limb.joints[1].config.agreed);
  ASSERT_EQ(alone.siblings.size(), 1U);
  EXPECT_EQ(alone.siblings[0].name, "hip");
  EXPECT_EQ(alone.siblings[0].suffix, "_hip");
  const StackConfig unconcerned = LoadStackConfig(File(std::string(kConfigText) + kJoints),
                                                  {"joint=knee", "limb.on_joint_fault=others_go_on"});
  EXPECT_FALSE(unconcerned.joints_concern_each_other);
  EXPECT_TRUE(alone.joints_concern_each_other);
}

// Tests that in real time a joint alone waits for another's states as long as for any input, and three of
// their intervals.
TEST_F(LimbConfigTest, JointAloneMissesTheOthers) {
  const StackConfig alone = LoadStackConfig(File(std::string(kConfigText) + kJoints),
                                            {"joint=knee", "time.mode=realtime", "time.speed=0.5",
                                             "limb.telemetry_hz=50", "limits.stale_input_s=0.2"});
  ASSERT_EQ(alone.siblings.size(), 1U);
  EXPECT_NEAR(alone.siblings[0].silence_s, 0.2 + 3 * 0.02 / 0.5, 1e-12);
  const StackConfig lockstep =
      LoadStackConfig(File(std::string(kConfigText) + kJoints), {"joint=knee", "time.mode=lockstep"});
  EXPECT_EQ(lockstep.siblings.at(0).silence_s, 0);
}

// Tests that the text of the whole limb, read again, describes the same limb.
TEST_F(LimbConfigTest, TextDescribesItself) {
  const LimbConfig limb = Load(kJoints, {"position.c2=123", "joint.knee.limits.pressure=900"});
  const LimbConfig again = LoadLimbConfig(File(limb.common.text));
  EXPECT_EQ(again.common.text, limb.common.text);
  for (size_t i = 0; i < 2; ++i) EXPECT_EQ(again.joints[i].config.agreed, limb.joints[i].config.agreed);
}

// Tests which joints a process has, and that two processes never have the same.
TEST_F(LimbConfigTest, Processes) {
  EXPECT_THAT(JointsOf(Load().common.processes.at(0), Load().common), ElementsAre("hip", "knee"));
  const std::string mixed =
      std::string(kJoints) +
      "[[process]]\nprogram = \"hydro-limb\"\n[[process]]\nprogram = \"hydro-plant\"\n"
      "joint = \"knee\"\n[[process]]\nprogram = \"hydro-pressure-ctrl\"\njoint = \"knee\"\n";
  const LimbConfig limb = Load(mixed);
  EXPECT_THAT(JointsOf(limb.common.processes.at(0), limb.common), ElementsAre("hip"));
  EXPECT_THAT(JointsOf(limb.common.processes.at(1), limb.common), ElementsAre("knee"));
  EXPECT_EQ(limb.joints[1].config.processes.size(), 2U);
  EXPECT_THAT(
      Error(std::string(kJoints) + "[[process]]\nprogram = \"hydro-limb\"\njoints = [\"hip\"]\n[[process]]\n"
                                   "program = \"hydro-limb\"\njoints = [\"knee\", \"hip\"]\n"),
      HasSubstr("process.joints: found a second process with the joint \"hip\", allowed one"));
  EXPECT_THAT(Error(std::string(kJoints) + "[[process]]\nprogram = \"hydro-limb\"\njoints = [\"hip\"]\n"),
              HasSubstr("process: found no process that runs the joint \"knee\", allowed one"));
  EXPECT_THAT(Error(std::string(kJoints) +
                    "[[process]]\nprogram = \"hydro-limb\"\njoints = [\"hip\", \"knee\", \"hip\"]\n"),
              HasSubstr("process.joints: found \"hip\" twice, allowed each joint once"));
  EXPECT_THAT(
      Error(std::string(kJoints) + "[[process]]\nprogram = \"hydro-limb\"\njoints = [\"hip\", \"knee\"]\n"
                                   "[[process]]\nprogram = \"hydro-limb\"\n"),
      HasSubstr("process: found hydro-limb, but other processes have all joints"));
  EXPECT_THAT(Error(std::string(kJoints) + "[[process]]\nprogram = \"hydro-plant\"\n"),
              HasSubstr("found hydro-plant without a joint"));
  EXPECT_THAT(Error(std::string(kJoints) + "[[process]]\nprogram = \"hydro-plant\"\njoint = \"toe\"\n"),
              HasSubstr("process.joint: found \"toe\", allowed \"hip\" or \"knee\""));
}

// Tests that what is wrong is named with its place, what was found and what is allowed.
TEST_F(LimbConfigTest, Wrong) {
  EXPECT_THAT(Error("[[joint]]\nname = \"a b\"\n"),
              HasSubstr("joint.name: found \"a b\", allowed a name of up to 24"));
  EXPECT_THAT(Error("[[joint]]\n[joint.model]\n"), HasSubstr("joint.name: found nothing"));
  EXPECT_THAT(Error("[[joint]]\nname = \"a\"\n[[joint]]\nname = \"a\"\n"), HasSubstr("a second joint \"a\""));
  EXPECT_THAT(Error("[[joint]]\nname = \"a\"\n[joint.postion]\nc1 = 1\n"),
              AllOf(HasSubstr("joint.a.postion: found a key that no joint has of its own"),
                    HasSubstr("did you mean \"position\"?")));
  for (const std::string section : {"bus", "time", "plant", "logger", "scope"}) {
    EXPECT_THAT(Error("[[joint]]\nname = \"a\"\n[joint." + section + "]\nx = 1\n"),
                HasSubstr("joint.a." + section +
                          ": found what all joints of the limb share, allowed it outside [[joint]], as [" +
                          section + "]"));
  }
  EXPECT_THAT(Error("[limb]\ntelemetry_hz = 3\n[[joint]]\nname = \"a\"\n"),
              HasSubstr("telemetry_hz: found 3"));
  EXPECT_THAT(Error("[limb]\non_joint_fault = \"panic\"\n[[joint]]\nname = \"a\"\n"),
              HasSubstr("\"all_to_zero\" or \"others_go_on\""));
  EXPECT_THAT(Error(""), HasSubstr("found no [[joint]] section"));
  EXPECT_THAT(InputErrorOf([&] { LoadStackConfig(File(std::string(kConfigText) + kJoints)); }),
              HasSubstr("joint: found joints (\"hip\" or \"knee\"), allowed a stack with one"));
  for (const std::string section : {"limb", "arm"}) {
    EXPECT_THAT(
        InputErrorOf([&] { LoadStackConfig(File(std::string(kConfigText) + "[" + section + "]\n")); }),
        HasSubstr(section + ": found it without joints, allowed it with [[joint]] sections"));
  }
}

// Tests that single brackets around the name of a list are told from other mistakes, at the line of the
// first.
TEST_F(LimbConfigTest, SingleBrackets) {
  const size_t lines = static_cast<size_t>(std::ranges::count(std::string(kConfigText), '\n'));
  const std::string one = "[joint]\nname = \"a\"\n", listed = "[[joint]]\nname = \"b\"\n";
  const std::string said = "limb.toml:" + std::to_string(lines + 1) +
                           ": joint: found a section [joint], allowed a list of sections: write [[joint]]";
  for (const std::string& text : {one, one + one, one + listed}) EXPECT_THAT(Error(text), EndsWith(said));
  EXPECT_THAT(Error(listed + one), HasSubstr("write [[joint]]"));
  EXPECT_THAT(Error(listed + "[process]\nprogram = \"hydro-limb\"\n"), HasSubstr("write [[process]]"));
  EXPECT_THAT(Error(listed + "[arm]\n[arm.link]\nmass = 1\n"), HasSubstr("write [[arm.link]]"));
}

// Tests that a mistake in a joint's own section, or one that only this joint makes, names the joint; one of
// all joints does not.
TEST_F(LimbConfigTest, ErrorsNameTheJoint) {
  const std::string text = "[[joint]]\nname = \"hip\"\n[[joint]]\nname = \"knee\"\n";
  EXPECT_THAT(Error(text + "[joint.position]\nC2 = 1\n"),
              AllOf(HasSubstr(": joint knee: position: \"C2\": found an unknown key"),
                    HasSubstr("did you mean \"c2\"?")));
  EXPECT_THAT(Error(text + "[joint.reference]\nkind = \"sin\"\n"),
              ContainsRegex("limb.toml:[0-9]+: joint knee: reference.kind: found \"sin\""));
  EXPECT_THAT(Error(text, {"joint.knee.position.c1=-1"}),
              StartsWith("--set joint.knee.position.c1=-1: joint knee: position.c1: found -1"));
  EXPECT_THAT(Error(text, {"position.c1=-1"}), StartsWith("--set position.c1=-1: position.c1: found -1"));
  const std::string alone = InputErrorOf([&] {
    LoadStackConfig(File(std::string(kConfigText) + text), {"joint=knee", "joint.knee.limits.return_s=-1"});
  });
  EXPECT_THAT(alone, HasSubstr("joint knee: limits.return_s"));
  // Steps that all share, and that go too far for the knee alone.
  EXPECT_THAT(Error(text + "[joint.limits]\narm_angle_rad = 0.05\n"),
              ContainsRegex("limb.toml:[0-9]+: joint knee: reference.steps: found arm angle"));
}

// Tests that an arm is for joints that turn, all in one system of units, and that its values may have units
// of their own.
TEST_F(LimbConfigTest, AnArmIsOfJointsThatTurn) {
  const std::string link = "[[arm.link]]\nmass = 0.02\nlength = \"38.1 cm\"\ncentre = 7\ninertia = 0.4\n";
  const std::string arm = "[arm]\ngravity = \"9.80665 m/s^2\"\n" + link + link;
  const LimbConfig limb = Load(std::string(kJoints) + arm);
  EXPECT_NEAR(limb.arm->gravity, 386.089, 1e-3);
  EXPECT_DOUBLE_EQ(limb.arm->links[1].length, 15);
  const std::string linear = "units = { length = \"in\", force = \"lbf\", arm = \"in\" }\n";
  Write("linear.toml", linear + kModelText);
  EXPECT_THAT(
      Error(std::string(kJoints) + "[joint.model]\nfile = \"linear.toml\"\n" + arm),
      HasSubstr("arm: found it with the joint knee, whose arm moves along a line (linear.toml), allowed "
                "joints that turn"));
  Write("other.toml", "units = { length = \"in\", force = \"N\" }\n" + std::string(kModelText));
  EXPECT_THAT(Error(std::string(kJoints) + "[joint.model]\nfile = \"other.toml\"\n" + arm),
              HasSubstr("arm: found joints in different units: hip in in and lbf, knee in in and N"));
}

// Tests that an arm has a link for each joint, is read, and is checked.
TEST_F(LimbConfigTest, Arm) {
  const std::string link = "[[arm.link]]\nmass = 0.02\nlength = 15\ncentre = 7\ninertia = 0.4\n";
  const LimbConfig limb =
      Load(std::string(kJoints) + "[arm]\ngravity = 386\n" + link + link + "angle_rad = 0.5\n");
  ASSERT_TRUE(limb.arm.has_value());
  EXPECT_EQ(limb.arm->gravity, 386);
  ASSERT_EQ(limb.arm->links.size(), 2U);
  EXPECT_EQ(limb.arm->links[0].centre, 7);
  EXPECT_EQ(limb.arm->links[1].angle, 0.5);
  EXPECT_THAT(Error(std::string(kJoints) + "[arm]\n" + link),
              HasSubstr("arm.link: found 1 links, allowed 2, a section [[arm.link]] for each joint"));
  EXPECT_THAT(Error(std::string(kJoints) + "[arm]\n" + link + "[[arm.link]]\nmass = -1\n"),
              HasSubstr("mass: found -1"));
  EXPECT_THAT(Error(std::string(kJoints) + "[arm]\n" + link + "[[arm.link]]\nmass = 1\n"),
              HasSubstr("length"));
  EXPECT_THAT(Error(std::string(kJoints) + "[arm]\n" + link + link +
                    "[[process]]\nprogram = \"hydro-limb\"\njoints = [\"hip\"]\n[[process]]\nprogram = "
                    "\"hydro-limb\"\n"),
              HasSubstr("found some of the joints of an [arm], allowed all of them in one hydro-limb"));
}

// Tests that numbers keep their units in limbs as in stacks: under a model of an option, of all joints or of
// one, and under a joint's own model beside sections that hold for all.
TEST_F(LimbConfigTest, NumbersKeepTheirUnits) {
  Write("si.toml", std::string("units = \"si\"\n") + kModelText);
  const auto refusal =
      AllOf(HasSubstr("model.file: found a model in m, N, Pa, and numbers for one in in, lbf, psi ("),
            HasSubstr("allowed a model in the same units, or values with a unit"));
  EXPECT_THAT(Error(kJoints, {"model.file=si.toml"}), AllOf(refusal, HasSubstr("joint hip: ")));
  EXPECT_THAT(Error(kJoints, {"joint.knee.model.file=si.toml"}), AllOf(refusal, HasSubstr("joint knee: ")));
  const std::string own = std::string(kJoints) + "[joint.model]\nfile = \"si.toml\"\n";
  EXPECT_THAT(Error(own), AllOf(refusal, HasSubstr("joint knee: ")));
  EXPECT_THAT(
      InputErrorOf([&] {
        LoadStackConfig(File(std::string(kConfigText) + kJoints), {"joint=knee", "model.file=si.toml"});
      }),
      refusal)
      << "the stack of one joint";
}

// Counts how often this process opens a file.
class Openings {
 public:
  explicit Openings(const std::string& file) : queue_(inotify_init1(IN_NONBLOCK)) {
    EXPECT_GE(inotify_add_watch(queue_, file.c_str(), IN_OPEN | IN_CLOSE), 0) << file;
  }
  ~Openings() { close(queue_); }
  Openings(const Openings&) = delete;
  Openings& operator=(const Openings&) = delete;

  // Since the last call. Watches closings too, because the kernel merges equal events in a row.
  int Count() {
    alignas(inotify_event) char events[4096];
    int count = 0;
    for (ssize_t size = read(queue_, events, sizeof events); size > 0;
         size = read(queue_, events, sizeof events))
      count += static_cast<int>(size / static_cast<ssize_t>(sizeof(inotify_event)));
    return count / 2;
  }

 private:
  int queue_;
};

// Tests that a limb reads a model once, however many joints share it and whatever is asked of its units.
TEST_F(LimbConfigTest, ReadsEachModelOnce) {
  const std::string file = File(std::string(kConfigText) + kJoints);
  Openings openings(Write("model.toml", kModelText));
  EXPECT_EQ(LoadLimbConfig(file, {}).joints.size(), 2U);
  EXPECT_EQ(openings.Count(), 1);
  LoadStackConfig(file, {"joint=knee"});
  EXPECT_EQ(openings.Count(), 1);
  Write("other.toml", kModelText);
  LoadLimbConfig(file, {"joint.knee.model.file=other.toml"});
  EXPECT_EQ(openings.Count(), 1);
  const std::string own =
      Write("own.toml", std::string(kConfigText) + kJoints + "[joint.model]\nfile = \"other.toml\"\n");
  Openings others((folder_ / "other.toml").string());
  LoadLimbConfig(own, {});
  EXPECT_EQ(openings.Count(), 1);
  EXPECT_EQ(others.Count(), 1);
}

}  // namespace
}  // namespace hydro::settings
