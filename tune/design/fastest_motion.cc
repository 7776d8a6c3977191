#include "tune/design/fastest_motion.h"

#include <spdlog/fmt/fmt.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/input_error.h"
#include "base/maths/matrix_functions.h"
#include "base/number_text.h"
#include "tune/design/operating_cases.h"

namespace hydro::design {
namespace {

// An oscillation takes about ten steps of about a microsecond. With this many oscillations, a tick of 1 ms
// takes about as long as it lasts.
constexpr double kMostInATick = 100;
// Nothing of a machine that moves oil oscillates like that. A simulation of it fails in its first steps or
// never ends.
constexpr double kMost_Hz = 1e7;

}  // namespace

double FastestMotion(const settings::StackConfig& config) {
  double fastest = 0;
  for (const OperatingCase& point : OperatingCases(config)) {
    const Eigen::MatrixXd A =
        Eigen::Map<const Eigen::MatrixXd>(point.model.A.data(), point.model.states, point.model.states);
    if (!A.allFinite()) continue;
    for (const std::complex<double>& value : maths::Eigenvalues(A))
      fastest = std::max(fastest, std::fabs(value.imag()));
  }
  return fastest;
}

std::string FastMotionRemark(const settings::StackConfig& config) {
  double fastest = 0;
  try {
    fastest = FastestMotion(config);
  } catch (const model::ModelError&) {
    return "";  // the simulation itself reports this, with the time
  }
  const double hz = fastest / (2 * std::numbers::pi);
  if (hz > kMost_Hz) {
    throw InputError(
        fmt::format("{}: parameters and effects: found a machine that oscillates at {} Hz, allowed "
                    "up to {} Hz; check J_a, J, V_ms, beta and mgl, what its effects say, and "
                    "the units of all of them",
                    config.model.resolved_file, ShortNumber(hz, 3), ShortNumber(kMost_Hz, 3)));
  }
  const double in_a_tick = hz / config.plant.rate_hz;
  if (!(in_a_tick > kMostInATick)) return "";
  return fmt::format(
      "{}: its fastest motion, {} rad/s, has {} oscillations in a tick of {} s, which may take very long to "
      "simulate: are J_a, J, "
      "V_ms and beta, and what its effects say, meant so, and in the units of the model?",
      config.model.resolved_file, ShortNumber(fastest, 3), ShortNumber(in_a_tick, 3),
      ShortestNumber(1 / config.plant.rate_hz));
}

std::vector<std::string> RemarksOn(const settings::StackConfig& config) {
  std::vector<std::string> remarks;
  for (std::string& remark : std::array{ArmRemark(config), FastMotionRemark(config)}) {
    if (!remark.empty()) remarks.push_back(std::move(remark));
  }
  return remarks;
}

std::vector<std::string> RemarksOn(const settings::LimbConfig& limb) {
  std::vector<std::string> remarks;
  if (limb.arm) return remarks;  // the arm replaces the joints' own loads
  for (const settings::JointConfig& joint : limb.joints) {
    for (const std::string& remark : RemarksOn(joint.config))
      remarks.push_back("joint " + joint.name + ": " + remark);
  }
  return remarks;
}

}  // namespace hydro::design
