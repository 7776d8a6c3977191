#include "sim/limb/limb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <hydro/rearm_t.hpp>

#include "tests/sim/limb/limb_fixture.h"

namespace hydro::limb {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::JointRecord;
using testing::SmallLimb;

class LimbTest : public ::testing::Test {
 protected:
  void Make(const settings::LimbConfig& config) {
    records_.clear();
    limb_ = std::make_unique<Limb>(config, LimbOptions{});
    for (auto& joint : limb_->joints()) records_.push_back(std::make_unique<JointRecord>(*joint));
  }

  int Run() {
    if (limb_->Begin()) {
      while (limb_->StepLockstep()) {
        if (on_tick_) on_tick_(limb_->tick());
      }
    }
    return limb_->End({});
  }

  const std::vector<state_t>& States(size_t joint) const { return records_[joint]->states; }

  // The first tick from which on the voltage of that joint was zero, as the states tell; -1: never.
  int64_t ZeroFrom(size_t joint) const {
    int64_t from = -1;
    for (const state_t& state : States(joint)) {
      if (state.voltage != 0) {
        from = -1;
      } else if (from < 0) {
        from = state.tick;
      }
    }
    return from;
  }

  std::unique_ptr<Limb> limb_;
  std::vector<std::unique_ptr<JointRecord>> records_;
  std::function<void(int64_t tick)> on_tick_;
};

// A limit that the second joint passes within the run, and the others do not.
settings::LimbConfig WithALowLimit(settings::OnJointFault policy, settings::Rearm rearm, size_t which) {
  settings::LimbConfig config = SmallLimb({"hip", "knee", "ankle"});
  config.limb.on_joint_fault = policy;
  for (auto& joint : config.joints) joint.config.limits.rearm = rearm;
  config.joints[which].config.limits.motor_speed_rad_s = 1;
  return config;
}

// Tests that all joints run to the end, each with states for every tick and moving as it is told.
TEST_F(LimbTest, AllJointsRunToTheEnd) {
  Make(SmallLimb({"hip", "knee", "ankle"}));
  EXPECT_EQ(Run(), 0);
  EXPECT_EQ(limb_->failure(), "");
  EXPECT_EQ(limb_->tick(), 100);
  for (size_t i = 0; i < 3; ++i) {
    ASSERT_EQ(States(i).size(), 101U);
    EXPECT_THAT(records_[i]->Codes(), IsEmpty());
  }
  EXPECT_GT(States(0).back().arm_angle, 1e-4);
  EXPECT_LT(States(1).back().arm_angle, -1e-4);
  EXPECT_NE(States(0).back().p1, States(2).back().p1);
}

// Tests that only the wanted joints are run.
TEST_F(LimbTest, SomeJoints) {
  const settings::LimbConfig config = SmallLimb({"hip", "knee", "ankle"});
  Limb limb(config, LimbOptions{.joints = {"ankle", "hip"}});
  ASSERT_EQ(limb.joint_count(), 2U);
  EXPECT_EQ(limb.joints()[0]->name(), "hip");
  EXPECT_EQ(limb.joints()[1]->name(), "ankle");
}

// Tests that a fault of one joint holds the others at zero volts from the very tick at which it is seen,
// whichever of them is first, and that they say why.
TEST_F(LimbTest, FaultOfOneHoldsTheOthers) {
  for (const size_t which : {size_t{0}, size_t{1}, size_t{2}}) {
    Make(WithALowLimit(settings::OnJointFault::kAllToZero, settings::Rearm::kExplicit, which));
    EXPECT_EQ(Run(), 1);  // it was not re-armed
    const int64_t zero = ZeroFrom(which);
    ASSERT_GT(zero, 1);
    for (size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(ZeroFrom(i), zero) << i;
      if (i == which) continue;
      EXPECT_THAT(records_[i]->Codes(), ElementsAre("+other_joint"));
      EXPECT_THAT(records_[i]->faults[0].text,
                  HasSubstr("joint " + limb_->joints()[which]->name() + " has the fault motor_speed_limit"));
    }
    EXPECT_THAT(records_[which]->Codes(), Contains("+motor_speed_limit"));
    EXPECT_THAT(records_[which]->Codes(), ::testing::Not(Contains("+other_joint")));
  }
}

// Tests that they go on by themselves once the joint that had the fault has been re-armed, although none of
// them is asked.
TEST_F(LimbTest, OneRearmLetsAllGoOn) {
  settings::LimbConfig config =
      WithALowLimit(settings::OnJointFault::kAllToZero, settings::Rearm::kExplicit, 1);
  for (auto& joint : config.joints) joint.config.last_tick = 2000;
  config.common.last_tick = 2000;
  Make(config);
  Joint& knee = *limb_->joints()[1];
  on_tick_ = [&](int64_t tick) {
    if (tick != 500 && tick != 900) return;
    rearm_t request;
    request.tick = tick - 1;
    request.session = 7;
    request.addressee = knee.plant().participant().session();
    request.kind = rearm_t::REQUEST;
    knee.bus().Publish(bus::Channels("_knee").Of<rearm_t>(), request);
  };
  Run();
  for (const size_t other : {size_t{0}, size_t{2}}) {
    const std::vector<std::string> codes = records_[other]->Codes();
    ASSERT_GE(codes.size(), 2U);
    EXPECT_EQ(codes[0], "+other_joint");
    EXPECT_EQ(codes[1], "-other_joint");
    EXPECT_TRUE(std::any_of(States(other).begin(), States(other).end(),
                            [](const state_t& s) { return s.tick > 502 && s.voltage != 0; }));
  }
}

// Tests that two joints with faults do not hold each other for ever: each is re-armed by itself.
TEST_F(LimbTest, TwoFaultsAreRearmedOneAfterTheOther) {
  settings::LimbConfig config =
      WithALowLimit(settings::OnJointFault::kAllToZero, settings::Rearm::kExplicit, 1);
  config.joints[0].config.limits.motor_speed_rad_s = 1;
  for (auto& joint : config.joints) joint.config.last_tick = 1200;
  config.common.last_tick = 1200;
  Make(config);
  std::vector<int8_t> answers;
  for (auto& joint : limb_->joints()) {
    joint->bus().Subscribe<rearm_t>(bus::Channels("_" + joint->name()).Of<rearm_t>(), [&](const rearm_t& r) {
      if (r.kind != rearm_t::REQUEST) answers.push_back(r.kind);
    });
  }
  on_tick_ = [&](int64_t tick) {
    if (tick == 600 || tick == 620) {  // the second joint's own, while the first one's holds it
      fault_t fault{};
      fault.session = 55;
      fault.source = "pressure_ctrl";
      fault.code = "nonfinite_state";
      fault.active = tick == 600;
      Joint& joint = *limb_->joints()[1];
      joint.bus().Publish(bus::Channels("_" + joint.name()).Of<fault_t>(), fault);
    }
    if (tick != 800 && tick != 801) return;
    Joint& joint = *limb_->joints()[static_cast<size_t>(tick - 800)];
    rearm_t request;
    request.tick = tick - 1;
    request.session = 7;
    request.addressee = joint.plant().participant().session();
    request.kind = rearm_t::REQUEST;
    joint.bus().Publish(bus::Channels("_" + joint.name()).Of<rearm_t>(), request);
  };
  Run();
  EXPECT_THAT(answers, ElementsAre(rearm_t::ACCEPTED, rearm_t::ACCEPTED));
}

// Tests that the others go on where the configuration says so, and that the run has failed all the same.
TEST_F(LimbTest, OthersGoOn) {
  Make(WithALowLimit(settings::OnJointFault::kOthersGoOn, settings::Rearm::kRestart, 1));
  EXPECT_EQ(Run(), 1);
  EXPECT_THAT(limb_->failure(), HasSubstr("knee: pressure_ctrl: fault motor_speed_limit"));
  EXPECT_EQ(limb_->tick(), 100);
  EXPECT_LT(States(1).back().tick, 100);
  for (const size_t other : {size_t{0}, size_t{2}}) {
    EXPECT_EQ(States(other).back().tick, 100);
    EXPECT_THAT(records_[other]->Codes(), IsEmpty());
    EXPECT_NE(States(other).back().voltage, 0);
  }
}

// Tests that a limit that ends the run of one joint ends all, where its faults concern them.
TEST_F(LimbTest, EndOfOneEndsAll) {
  Make(WithALowLimit(settings::OnJointFault::kAllToZero, settings::Rearm::kRestart, 2));
  EXPECT_EQ(Run(), 1);
  EXPECT_LT(limb_->tick(), 100);
  EXPECT_THAT(limb_->failure(), HasSubstr("ankle: pressure_ctrl: fault motor_speed_limit"));
}

// Tests that a fault elsewhere in the limb holds all joints while it lasts.
TEST_F(LimbTest, FaultElsewhere) {
  settings::LimbConfig config = SmallLimb({"hip", "knee"});
  Make(config);
  on_tick_ = [&](int64_t tick) {
    if (tick == 40) limb_->HoldForOthers("joint ankle has the fault pressure_limit (plant)", "");
    if (tick == 60) limb_->HoldForOthers("", "");
  };
  EXPECT_EQ(Run(), 0);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_THAT(records_[i]->Codes(), ElementsAre("+other_joint", "-other_joint"));
    for (const state_t& state : States(i)) {
      if (state.tick <= 40 || state.tick > 60) continue;
      EXPECT_EQ(state.voltage, 0) << state.tick;
    }
    EXPECT_NE(States(i).back().voltage, 0);
  }
}

}  // namespace
}  // namespace hydro::limb
