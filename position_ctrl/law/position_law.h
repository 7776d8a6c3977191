// The control law of the position loop, eq. (17), as a small pure class whose only state is the previous
// sample.
#pragma once

#include <cstdint>
#include <limits>

namespace hydro::position_ctrl {

struct PositionLawSettings {
  double c1 = 0;                   // psi/rad
  double c2 = 0;                   // psi s/rad
  double sample_interval = 0.005;  // s, T
  // true: eq. (17) as printed; false: the derivative acts on the measured angle, so a step gives no kick.
  bool derivative_on_error = false;
  double pressure_limit = std::numeric_limits<double>::infinity();  // psi, largest |dp_ref|
};

class PositionLaw {
 public:
  explicit PositionLaw(const PositionLawSettings& settings) : settings_(settings) {}

  // Eq. (17), limited: dp_ref = -c1 e - c2/T (e - e_previous), e = alpha - alpha_ref. `intervals` is the
  // number of sample intervals since the previous call (more than 1 when samples were missed). The first
  // sample after Reset() has no derivative term.
  double Update(double arm_angle, double arm_ref, int64_t intervals) {
    return Limited(UpdateUnlimited(arm_angle, arm_ref, intervals));
  }

  // UpdateUnlimited() does the same without the limit; Limited() applies the limit.
  double UpdateUnlimited(double arm_angle, double arm_ref, int64_t intervals);
  double Limited(double pressure_ref) const;

  // The result that UpdateUnlimited() would give with other settings; the law itself stays unchanged.
  double Preview(const PositionLawSettings& other, double arm_angle, double arm_ref, int64_t intervals) const;

  // Acts by other settings from the next Update() on. The previous sample is kept.
  void Retune(const PositionLawSettings& settings);

  void Reset() { has_previous_ = false; }

 private:
  PositionLawSettings settings_;
  double previous_error_ = 0;  // rad, of the previous sample
  double previous_angle_ = 0;  // rad
  bool has_previous_ = false;
};

// The output of a D/A converter of `bits` bits and a range of +/- full_scale for `value`: the nearest of its
// 2^bits levels k full_scale / 2^(bits-1), k = -2^(bits-1) ... 2^(bits-1) - 1. With `bits` = 0, `value`
// itself.
double QuantiseDac(double value, int bits, double full_scale);

}  // namespace hydro::position_ctrl
