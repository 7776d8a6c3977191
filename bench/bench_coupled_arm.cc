// One joint's 1 kHz tick in an arm of N equal links, each with Table 1's actuator and its pressure loop, eq.
// (16), which follows a +/-300 psi square wave of its own frequency. Beside it: N actuators with free shafts
// that nothing couples, at the same tolerance. The largest difference from exchanges 20 times as often says
// how accurate the coupling is.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "model/arm/arm_coupling.h"
#include "model/coupled_arm.h"
#include "tests/table1.h"

namespace hydro {
namespace {

constexpr int kTicks = 1000;
constexpr double kTick = 1e-3;
constexpr double kGravity = 386.09;

model::ArmDescription Links(int n) {
  model::ArmDescription arm;
  arm.gravity = kGravity;
  // 12 lbf and 20 in of a slender rod, straight out.
  arm.links.assign(static_cast<size_t>(n),
                   {.mass = 12 / kGravity, .length = 20, .centre = 10, .inertia = 12 / kGravity * 400 / 12});
  return arm;
}

std::vector<model::ArmJoint> Joints(int n) {
  model::ArmJoint joint;
  joint.model.parameters = testing::Table1();
  return std::vector<model::ArmJoint>(static_cast<size_t>(n), joint);
}

double Loop(const model::Measurement& m, int joint, int tick) {
  const int period = 200 + 30 * joint;
  const double reference = tick % period < period / 2 ? 300 : -300;
  return 0.134 * (reference - (m.p2 - m.p1) - 8.4 * m.motor_speed);
}

struct Row {
  double us = 0;
  double angle_error = NAN;
  double pressure_error = NAN;
};
std::map<std::string, Row> rows;
std::vector<std::string> order;

// Angles, then pressures, of all joints at all ticks.
std::vector<double> RunArm(int n, const model::CoupledArmOptions& options) {
  model::CoupledArm arm(Links(n), Joints(n), options);
  std::vector<double> voltages(static_cast<size_t>(n)), seen;
  for (int tick = 0; tick < kTicks; ++tick) {
    for (int i = 0; i < n; ++i) {
      const model::Measurement m = arm.Measure(i);
      voltages[static_cast<size_t>(i)] = Loop(m, i, tick);
      seen.insert(seen.end(), {m.arm_angle, m.p2 - m.p1});
    }
    arm.Advance(voltages, (tick + 1) * kTick);
  }
  return seen;
}

void RunAlone(int n) {
  std::vector<model::ArmJoint> joints = Joints(n);
  std::vector<model::Parameters> loads(joints.size(), testing::Table1());
  model::SetOwnLoads(model::PlanarArm(Links(n)), std::vector<double>(joints.size()), loads);
  std::vector<model::Actuator> actuators;
  for (int i = 0; i < n; ++i) {
    joints[static_cast<size_t>(i)].model.parameters = loads[static_cast<size_t>(i)];
    actuators.emplace_back(joints[static_cast<size_t>(i)].model, joints[static_cast<size_t>(i)].options);
  }
  for (int tick = 0; tick < kTicks; ++tick) {
    for (int i = 0; i < n; ++i) {
      model::Actuator& one = actuators[static_cast<size_t>(i)];
      one.Advance(Loop(one.Measure(), i, tick), (tick + 1) * kTick);
    }
  }
}

void Register(int n, bool coupled) {
  const std::string name = std::to_string(n) + (coupled ? " in one arm" : " alone");
  order.push_back(name);
  if (coupled) {
    const std::vector<double> here = RunArm(n, {});
    const std::vector<double> fine =
        RunArm(n, {.steps_per_radian = 20 * model::CoupledArmOptions().steps_per_radian});
    Row& row = rows[name];
    row.angle_error = row.pressure_error = 0;
    for (size_t i = 0; i < here.size(); i += 2) {
      row.angle_error = std::max(row.angle_error, std::abs(here[i] - fine[i]));
      row.pressure_error = std::max(row.pressure_error, std::abs(here[i + 1] - fine[i + 1]));
    }
  }
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    for (auto _ : state) {
      if (coupled) {
        benchmark::DoNotOptimize(RunArm(n, {}));
      } else {
        RunAlone(n);
      }
    }
  })->Unit(benchmark::kMillisecond);
}

class Reporter : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      const std::string name = run.benchmark_name();
      if (run.run_type == Run::RT_Iteration)
        rows[name].us = run.GetAdjustedCPUTime() * 1e3 / kTicks / std::stoi(name);
    }
    ConsoleReporter::ReportRuns(runs);
  }
};

}  // namespace
}  // namespace hydro

int main(int argc, char** argv) {
  using namespace hydro;
  for (const int n : {1, 2, 3, 6}) {
    Register(n, false);
    Register(n, true);
  }
  benchmark::Initialize(&argc, argv);
  Reporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  std::printf("\n%-16s %20s %8s %16s %18s\n", "joints", "us a joint and tick", "ratio", "error, rad",
              "error of dp, psi");
  for (size_t i = 0; i < order.size(); ++i) {
    const Row& row = rows[order[i]];
    std::printf("%-16s %20.3f", order[i].c_str(), row.us);
    if (i % 2 == 1)
      std::printf(" %8.2f %16.1e %18.2g", row.us / rows[order[i - 1]].us, row.angle_error,
                  row.pressure_error);
    std::printf("\n");
  }
  return 0;
}
