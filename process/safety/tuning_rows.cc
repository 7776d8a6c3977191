// Changes of values and plans while a stack runs.
#include <array>

#include "process/safety/safety_table.h"

namespace hydro::process {
namespace {

constexpr std::array kTuningRows{
    SafetyRow{
        .id = "tuning_refused",
        .fault = "values that would make a loop unstable, or of which that cannot be judged, that loosen a "
                 "limit while the motor may move, or are none",
        .detected = "plant or driver, before they act",
        .within = {"at once"},
        .output = SafeOutput::kNotObeyed,
        .output_text = "the values in force stay, all of them; the answer says why",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "nothing has changed",
        .tests =
            "tuning.TuningTest.test_refused tune/live/LiveTuningTest.WhatIsRefusedChangesNothing "
            "tune/live/PrepareChange.RefusesWithTheReason tune/live/PrepareChange.RefusesWhatCannotBeJudged "
            "tune/live/PrepareChange.LimitsAreLoosenedOnlyWhileHeld",
        .injected = "set strange_request",
    },
    SafetyRow{
        .id = "tuning_torn",
        .fault = "a controller cannot act by new values, does not answer, or starts after they were decided",
        .detected = "plant or driver, before it decides; the controller, by what the plant says is in force",
        .within = {"0.5 s"},
        .output = SafeOutput::kNotObeyed,
        .output_text = "nothing changes anywhere; who starts later acts by the values in force from its "
                       "first command on",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "nothing has changed",
        .tests = "tuning.TuningTest.test_controller_restarted "
                 "tune/live/LiveTuningTest.AControllerThatCannotEndsTheRequest "
                 "tune/live/LiveTuningTest.AControllerThatIsSilentEndsTheRequest "
                 "position_ctrl/PositionAppTest.ActsByTheValuesInForceWhenItJoins",
        .injected = "torn_set",
    },
    SafetyRow{
        .id = "plan_refused",
        .fault =
            "a plan (`reference.kind = \"planner\"`) beyond the limits, not finite, or of a second planner",
        .detected = "position loop",
        .codes = "refused_arm_plan",
        .within = {"at once"},
        .output = SafeOutput::kNotObeyed,
        .output_text = "the plan before it is followed to its end, then held",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "a second after the last",
        .tests = "position_ctrl/PlannerTest.APlanThatIsWrongIsNotFollowed "
                 "position_ctrl/PlanFollower.RefusesWithTheReason",
        .injected = "wrong_plan",
    },
    SafetyRow{
        .id = "planner_silent",
        .fault = "the planner sends no plan any more",
        .detected = "position loop, `reference.timeout_s` of plant time after the newest",
        .codes = "silent_planner",
        .within = {"at the next sample"},
        .output = SafeOutput::kControlGoesOn,
        .output_text = "the reference holds where it is",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "with the next plan",
        .tests = "position_ctrl/PlannerTest.ASilentPlannersReferenceIsHeld "
                 "position_ctrl/PlanFollower.HoldsWhenThePlannerIsSilent",
        .injected = "planner_silent",
    },
};

}  // namespace

std::span<const SafetyRow> TuningRows() { return kTuningRows; }

}  // namespace hydro::process
