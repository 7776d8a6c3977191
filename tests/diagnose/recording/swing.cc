#include "tests/diagnose/recording/swing.h"

#include <cmath>

#include "model/actuator.h"
#include "tests/table1.h"

namespace hydro::testing {

model::ModelDescription Table1Model() {
  model::ModelDescription model;
  model.parameters = Table1();
  return model;
}

runs::MeasuredRun Swing(model::Shaft shaft, bool bypass) {
  model::ActuatorOptions options;
  options.shaft = shaft;
  options.bypass = bypass;
  model::Actuator rig(Table1Model(), options);
  runs::MeasuredRun run;
  run.name = "swing";
  run.shaft = shaft;
  run.bypass = bypass;
  for (int k = 0; k < 1000; ++k) {
    if (k > 0) rig.Advance(run.voltage.values.back(), 1e-3 * k);
    const model::Measurement m = rig.Measure();
    run.time.push_back(1e-3 * k);
    run.voltage.values.push_back(4 * std::sin(0.02 * k));
    run.motor_speed.values.push_back(m.motor_speed);
    run.motor_angle.values.push_back(m.motor_angle);
    run.p1.values.push_back(m.p1);
    run.p2.values.push_back(m.p2);
    if (shaft != model::Shaft::kFree) continue;
    run.arm_angle.values.push_back(m.arm_angle);
    run.arm_speed.values.push_back(m.arm_speed);
  }
  return run;
}

}  // namespace hydro::testing
