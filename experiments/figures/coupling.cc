// Two joints in one arm: how each joint's motion affects the other, and how much of that feed-forward
// removes.
#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/figures/catalogue.h"
#include "experiments/studies/coupling_study.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/torque_runs.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;

constexpr std::array<const char*, kArmJoints> kJoints = {"upper_arm", "forearm"};
constexpr std::array<const char*, kArmJoints> kJointWords = {"upper arm", "forearm"};
constexpr Moving kUpperMoves = kCases[0];
constexpr Moving kBothMove = kCases[2];
constexpr int kForearm = 1;
constexpr size_t kThinned = 5;  // ticks: 1 ms is enough to show

std::string Words(FeedForward feed_forward) {
  switch (feed_forward) {
    case FeedForward::kNone:
      return "eq. (17) alone";
    case FeedForward::kOwn:
      return "own model";
    case FeedForward::kGravity:
      return "and the arm's gravity";
    case FeedForward::kWhole:
      return "and its inverse dynamics";
  }
  return "";
}

std::string Words(const Moving& moving) {
  if (moving == kBothMove) return "both joints move";
  return moving == kUpperMoves ? "the upper arm moves" : "the forearm moves";
}

std::vector<double> Thin(const std::vector<double>& values, double scale = 1) {
  std::vector<double> thinned;
  for (size_t i = 0; i < values.size(); i += kThinned) thinned.push_back(scale * values[i]);
  return thinned;
}

std::vector<double> Sum(const CouplingAlongPath& parts) {
  std::vector<double> sum = parts.inertia;
  for (size_t i = 0; i < sum.size(); ++i) sum[i] += parts.velocity[i] + parts.gravity[i];
  return sum;
}

double StiffnessOf(const CouplingStudy& study) { return study.c1 * study.own[0].k_2; }

json RunJson(const CoupledArmRun& run) {
  json out = {{"highest_motor_torque_in_lbf", run.highest_motor_torque}};
  for (int i = 0; i < kArmJoints; ++i) {
    const JointRun& joint = run.joints[i];
    out[kJoints[i]] = {{"peak_angle_error_rad", joint.peak_angle_error},
                       {"peak_feedback_in_lbf", joint.peak_feedback},
                       {"peak_torque_error_in_lbf", joint.peak_torque_error},
                       {"rms_torque_error_in_lbf", joint.rms_torque_error},
                       {"peak_coupling_in_lbf", joint.peak_coupling}};
  }
  return out;
}

json Numbers(const CouplingStudy& study) {
  json out = {{"friction_band_in_lbf", FrictionBandTorque()},
              {"stiffness_in_lbf_per_rad", StiffnessOf(study)}};
  for (int i = 0; i < kArmJoints; ++i) {
    out["own_model"][kJoints[i]] = {{"J_a_lbf_in_s2", study.own[i].J_a}, {"mgl_in_lbf", study.own[i].mgl}};
  }
  for (const Moving& moving : kCases) {
    json& one = out["cases"][Name(moving)];
    const auto expected = ExpectedCoupling(study, moving);
    for (int i = 0; i < kArmJoints; ++i) {
      one["closed_form"][kJoints[i]] = {{"peak_coupling_in_lbf", expected[i].peak},
                                        {"peak_of_inertia_in_lbf", expected[i].peak_inertia},
                                        {"angle_error_at_peak_rad", expected[i].peak / StiffnessOf(study)}};
    }
    for (const CoupledArmRun& run : study.runs) {
      if (run.moving == moving) {
        one[run.coupled ? "coupled" : "uncoupled"][Name(run.feed_forward)] = RunJson(run);
      }
    }
  }
  return out;
}

page::Panel TorquePanel(const CouplingStudy& study, const Moving& moving, int joint) {
  const std::vector<double> time = Thin(study.time);
  const CouplingAlongPath expected = ExpectedCoupling(study, moving)[joint];
  const CoupledArmRun& run = study.Find(moving, FeedForward::kWhole, true);
  return {.title = fmt::format("Torque at the {} beyond what its own model knows", kJointWords[joint]),
          .x = {.min = 0, .numbers = false},
          .y = {.label = "torque, in-lbf"},
          .curves = {page::Line("inertia", time, Thin(expected.inertia), 1),
                     page::Line("gravity", time, Thin(expected.gravity), 2),
                     page::Line("speeds", time, Thin(expected.velocity), 4),
                     page::Line("run", time, Thin(run.joints[joint].coupling), 0),
                     page::Line("sum, closed form", time, Thin(Sum(expected)), 3, page::Stroke::kDashed)}};
}

page::Panel ErrorPanel(const CouplingStudy& study, const Moving& moving, int joint) {
  const std::vector<double> time = Thin(study.time);
  page::Panel panel{.title = fmt::format("Angle error of the {}", kJointWords[joint]),
                    .x = {.label = "time, s", .min = 0},
                    .y = {.label = "α - reference, mrad"}};
  const CoupledArmRun& alone = study.Find(moving, FeedForward::kOwn, false);
  panel.curves.push_back(page::Line("own model, not coupled", time,
                                    Thin(alone.joints[joint].angle_error, 1e3), 5, page::Stroke::kDotted));
  int colour = 0;
  for (const FeedForward feed_forward : {FeedForward::kOwn, FeedForward::kGravity, FeedForward::kWhole}) {
    const CoupledArmRun& run = study.Find(moving, feed_forward, true);
    panel.curves.push_back(
        page::Line(Words(feed_forward), time, Thin(run.joints[joint].angle_error, 1e3), colour++));
  }
  return panel;
}

Picture CasePicture(const CouplingStudy& study, const Moving& moving, const std::string& suffix) {
  page::Panel path{.title = "The path of a joint that moves",
                   .x = {.min = 0, .numbers = false},
                   .y = {.label = "reference, rad"},
                   .curves = {page::Line("", Thin(study.time), Thin(study.reference), 0)},
                   .height = 0.5};
  return {suffix,
          {.caption = fmt::format("Two coupled joints; {}. Feed-forward of each joint's own model, of the "
                                  "whole arm's gravity in its place, "
                                  "and of the whole arm's inverse dynamics.",
                                  Words(moving)),
           .panels = {path, TorquePanel(study, moving, kForearm), ErrorPanel(study, moving, kForearm)}}};
}

// What feedback has to supply with each kind of feed-forward.
Picture FeedbackPicture(const CouplingStudy& study) {
  page::Panel panel{
      .title = "Largest torque that eq. (17) has to supply",
      .x = {.label = "feed-forward", .min = -0.3, .max = 3.3},
      .y = {.label = "k_2 dp_ref of eq. (17), in-lbf", .logarithmic = true, .min = 20, .max = 2000},
      .rules = {{"friction band", false, FrictionBandTorque()}}};
  const std::array<const char*, kFeedForwards.size()> names = {"none", "own model", "gravity",
                                                               "inverse dynamics"};
  for (size_t i = 0; i < kFeedForwards.size(); ++i) {
    panel.x.ticks.push_back({static_cast<double>(i), names[i]});
  }
  int colour = 0;
  for (const Moving& moving : kCases) {
    for (int joint = 0; joint < kArmJoints; ++joint) {
      page::Curve curve{.label = fmt::format("{}: {}", Words(moving), kJointWords[joint]),
                        .stroke = page::Stroke::kLinePoints,
                        .colour = colour++};
      for (size_t i = 0; i < kFeedForwards.size(); ++i) {
        curve.x.push_back(static_cast<double>(i));
        curve.y.push_back(study.Find(moving, kFeedForwards[i], true).joints[joint].peak_feedback);
      }
      panel.curves.push_back(std::move(curve));
    }
  }
  return {"-feedback",
          {.caption = "Two coupled joints. A pump that rests stays at rest within the friction band.",
           .panels = {panel}}};
}

std::vector<Comparison> Comparisons(const CouplingStudy& study) {
  std::vector<Comparison> comparisons;
  for (const Moving& moving : kCases) {
    const auto expected = ExpectedCoupling(study, moving);
    for (int i = 0; i < kArmJoints; ++i) {
      const JointRun& whole = study.Find(moving, FeedForward::kWhole, true).joints[i];
      const JointRun& own = study.Find(moving, FeedForward::kOwn, true).joints[i];
      comparisons.push_back({fmt::format("coupling torque at the {}, {}", kJointWords[i], Words(moving)),
                             "in-lbf", "", expected[i].peak, whole.peak_coupling,
                             "largest; expected: the textbook's two links along the reference"});
      if (moving != kBothMove) continue;
      comparisons.push_back({fmt::format("angle error of the {} that knows only itself", kJointWords[i]),
                             "rad", "", expected[i].peak / StiffnessOf(study), own.peak_angle_error,
                             "expected: that torque over c_1 k_2, without friction"});
    }
  }
  return comparisons;
}

std::string Explanation(const CouplingStudy& study) {
  const auto both = ExpectedCoupling(study, kBothMove);
  const auto upper = ExpectedCoupling(study, kUpperMoves);
  const auto error = [&](FeedForward feed_forward, bool coupled) {
    return 1e3 * study.Find(kBothMove, feed_forward, coupled).joints[kForearm].peak_angle_error;
  };
  const auto feedback = [&](FeedForward feed_forward) {
    return study.Find(kBothMove, feed_forward, true).joints[kForearm].peak_feedback;
  };
  const JointRun& held = study.Find(kUpperMoves, FeedForward::kNone, true).joints[kForearm];
  const JointRun& lone = study.Find(kUpperMoves, FeedForward::kNone, false).joints[kForearm];
  const JointRun& held_own = study.Find(kUpperMoves, FeedForward::kOwn, true).joints[kForearm];
  return fmt::format(
      "While the upper arm moves, the resting forearm feels up to {held_peak:.0f} in-lbf more than its own "
      "model knows: {inertia:.0f} "
      "in-lbf of M_12 α_1'' where the upper arm accelerates, the rest gravity that turns with it. When both "
      "move it is {both_peak:.0f} "
      "in-lbf. Eq. (17) alone hides this: the forearm's weight alone takes the resting forearm "
      "{lone_alone:.1f} mrad from its reference, with "
      "coupling {held_alone:.1f}. Told what its own model knows, a lone joint follows within {lone_own:.2f} "
      "mrad, which is the "
      "friction band of the pump, {band:.0f} in-lbf, over c_1 k_2; in the arm the forearm errs by {own:.2f} "
      "mrad, as {both_peak:.0f} in-lbf "
      "over c_1 k_2 = {stiffness:.0f} in-lbf/rad do ({expected:.2f}). The arm's gravity as feed-forward "
      "leaves {gravity:.2f} mrad, its "
      "inverse dynamics {whole:.2f}, hardly more than a lone joint has. Feedback then supplies "
      "{feedback_whole:.0f} in-lbf instead of {feedback_own:.0f}. "
      "A pump at rest hides what lies within its friction band, so of {held_peak:.0f} in-lbf the resting "
      "forearm moves by only {held_own:.2f} "
      "mrad. With Table 1's ratio the pump's reflected inertia is (c/D)^2 J = {reflected:.0f} lbf-in-s^2, "
      "{times:.0f} times the upper "
      "arm's {inertia_1:.0f}: it limits accelerations to about 2 rad/s^2, and so keeps the coupling by "
      "inertia small.",
      fmt::arg("held_peak", upper[kForearm].peak), fmt::arg("inertia", upper[kForearm].peak_inertia),
      fmt::arg("both_peak", both[kForearm].peak), fmt::arg("held_alone", 1e3 * held.peak_angle_error),
      fmt::arg("lone_alone", 1e3 * lone.peak_angle_error),
      fmt::arg("lone_own", error(FeedForward::kOwn, false)), fmt::arg("band", FrictionBandTorque()),
      fmt::arg("own", error(FeedForward::kOwn, true)), fmt::arg("stiffness", StiffnessOf(study)),
      fmt::arg("expected", 1e3 * both[kForearm].peak / StiffnessOf(study)),
      fmt::arg("gravity", error(FeedForward::kGravity, true)),
      fmt::arg("whole", error(FeedForward::kWhole, true)),
      fmt::arg("feedback_whole", feedback(FeedForward::kWhole)),
      fmt::arg("feedback_own", feedback(FeedForward::kOwn)),
      fmt::arg("held_own", 1e3 * held_own.peak_angle_error),
      fmt::arg("reflected", std::pow(study.own[0].c / study.own[0].D, 2) * study.own[0].J),
      fmt::arg("times", std::pow(study.own[0].c / study.own[0].D, 2) * study.own[0].J / study.own[0].J_a),
      fmt::arg("inertia_1", study.own[0].J_a));
}

std::vector<tables::Column> Columns(const CouplingStudy& study) {
  std::vector<tables::Column> columns = {{"time_s", Thin(study.time)},
                                         {"reference_rad", Thin(study.reference)}};
  const auto expected = ExpectedCoupling(study, kBothMove);
  for (int i = 0; i < kArmJoints; ++i) {
    const std::string joint = kJoints[i];
    columns.push_back({joint + "_coupling_in_lbf", Thin(Sum(expected[i]))});
    for (const FeedForward feed_forward : kFeedForwards) {
      const JointRun& run = study.Find(kBothMove, feed_forward, true).joints[i];
      columns.push_back({joint + "_" + Name(feed_forward) + "_angle_error_rad", Thin(run.angle_error)});
      columns.push_back({joint + "_" + Name(feed_forward) + "_torque_in_lbf", Thin(run.torque)});
    }
  }
  return columns;
}

}  // namespace

ExperimentResult RunCoupling(const ExperimentOptions& options) {
  const CouplingStudy study = RunCouplingStudy();
  const model::ArmDescription arm = StudiedArm();
  ExperimentResult result;
  result.conditions = fmt::format(
      "Table 1's actuator in both joints of an arm (ASSUMED: upper arm {} in, {:.0f} lbf; forearm {} in, "
      "{:.0f} lbf; {:.0f} lbf in the hand; "
      "{} rad between them at mid-stroke), with the loops of config/retuned.toml, the derivative on the "
      "error, 5 kHz, a tick of delay. A joint "
      "that moves goes from -{} to {} rad and back (quintic, up to {} rad/s); the other holds mid-stroke. A "
      "joint's own model: eqs. (4) and "
      "(15) with J_a = {:.1f} and {:.1f} lbf-in-s^2, m g l = {:.0f} and {:.0f} in-lbf, as measured at "
      "mid-stroke with the other at rest. "
      "Uncoupled: two rigs with just these loads.",
      arm.links[0].length, arm.links[0].mass * arm.gravity, arm.links[1].length,
      arm.links[1].mass * arm.gravity, arm.payload * arm.gravity, kElbow, kArmReach, kArmReach, kArmPeakSpeed,
      study.own[0].J_a, study.own[1].J_a, study.own[0].mgl, study.own[1].mgl);
  result.paper_says =
      "The actuator is meant for robots; the paper's model and measurements are of one joint, whose load is "
      "J_a and m g l.";
  result.explanation = Explanation(study);
  result.comparisons = Comparisons(study);
  result.numbers = JsonText(Numbers(study));
  result.table.columns = Columns(study);
  result.pictures = {CasePicture(study, kBothMove, ""), CasePicture(study, kUpperMoves, "-holding"),
                     FeedbackPicture(study)};
  options.progress(1);
  return result;
}

}  // namespace hydro::experiments
