// A pipe by the method of characteristics: what enters at one end leaves at the other a delay later, lower
// and rounded by friction (Krus et al. 1994; the rounding stands for friction that grows with frequency).
#pragma once

#include <cstddef>
#include <vector>

namespace foreign_rig {

class Pipe {
 public:
  Pipe() = default;
  // `impedance`: psi s/in^3; `loss`: part of a steady flow's wave lost in a pass; `step`: s.
  Pipe(double delay, double impedance, double loss, double step);

  bool present() const { return !towards_a_.empty(); }
  double impedance() const { return impedance_; }
  // Starts at rest.
  void Fill(double pressure);

  // Flow into the pipe at end a or b, while the end's pressure is p.
  double FlowA(double p) const { return (p - at_a_) / impedance_; }
  double FlowB(double p) const { return (p - at_b_) / impedance_; }

  // One step on, with the mean end pressures during the step.
  void Step(double pressure_a, double pressure_b);

 private:
  double Round(double wave, double* state) const;

  double impedance_ = 1, keep_ = 1, rounding_ = 0;
  double at_a_ = 0, at_b_ = 0;  // waves that arrive: p - Z q on the far side, a delay ago
  double round_a_ = 0, round_b_ = 0;
  std::vector<double> towards_a_, towards_b_;  // rings
  size_t next_ = 0;
};

}  // namespace foreign_rig
