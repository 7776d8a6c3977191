#include "model/linearise.h"

#include <algorithm>

namespace hydro::model {

namespace {

constexpr int kOutputs = 6;

template <class T>
const T& Output(const MeasurementOf<T>& measured, int i) {
  const T* const outputs[kOutputs] = {&measured.motor_angle, &measured.motor_speed, &measured.arm_angle,
                                      &measured.arm_speed,   &measured.p1,          &measured.p2};
  return *outputs[i];
}

}  // namespace

LinearModel Linearise(const Equations& equations, double time, double voltage, const Mode& mode,
                      const double* state) {
  const int n = equations.states();
  LinearModel model;
  model.states = n;
  model.inputs = 1;
  model.outputs = kOutputs;
  model.state_names = equations.StateNames();
  model.input_names = {"voltage"};
  model.output_names = {"motor_angle", "motor_speed", "arm_angle", "arm_speed", "p1", "p2"};
  model.A.resize(n * n);
  model.B.resize(n);
  model.C.resize(kOutputs * n);
  model.D.resize(kOutputs);
  model.rate.resize(n);
  model.output.resize(kOutputs);

  // The voltage is the direction after those of the states.
  Jet inputs[kMaxStates + 1];
  Jet rate[kMaxStates];
  MeasurementOf<Jet> measured;
  for (int j = 0; j < n; ++j) inputs[j] = Jet(state[j]);
  inputs[n] = Jet(voltage);
  for (int first = 0; first <= n; first += kJetWidth) {
    const int last = std::min(n + 1, first + kJetWidth);
    for (int j = first; j < last; ++j) inputs[j].SetDerivative(j - first, 1);
    equations.Differentiate(time, inputs[n], mode, inputs, rate, &measured);
    for (int j = first; j < last; ++j) {
      double* const rates = j < n ? &model.A[j * n] : model.B.data();
      double* const outputs = j < n ? &model.C[j * kOutputs] : model.D.data();
      for (int i = 0; i < n; ++i) rates[i] = rate[i].v[j - first];
      for (int i = 0; i < kOutputs; ++i) outputs[i] = Output(measured, i).v[j - first];
      inputs[j].SetDerivative(j - first, 0);
    }
  }
  for (int i = 0; i < n; ++i) model.rate[i] = rate[i].a;
  for (int i = 0; i < kOutputs; ++i) model.output[i] = Output(measured, i).a;
  return model;
}

}  // namespace hydro::model
