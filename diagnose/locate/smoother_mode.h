// The actuator's mode at a sample: the switches of the pump and the valves from the measurements where they
// tell, else from the estimated state. Only for the smoother's own files.
#pragma once

#include <array>
#include <cstdint>

#include "diagnose/locate/smoother_setup.h"

namespace hydro::diagnose::smoother {

class ModeAtSample {
 public:
  explicit ModeAtSample(const Setup& setup) : setup_(setup) {}

  // Sets the mode at sample k (`mode` holds the one before) and which balances the sample informs. Leaves the
  // terms and rates of that mode.
  void Set(const model::Equations& equations, size_t k, double voltage, const double* state,
           model::Mode* mode, model::Terms<double>* terms, double* rate,
           std::array<uint8_t, kBalances>* informative);

  // For side 1 (0) and side 2 (1), at the last sample: whether its pressure is near p_3, where its valve may
  // be open or closed; and the rate of its pressure if the valve were closed.
  bool at_valve(int side) const { return at_valve_[side]; }
  double free_rate(int side) const { return free_rate_[side]; }

 private:
  enum class Rest { kAbove, kNear, kAt, kBelow };

  Rest RestOf(int side, size_t k, double pressure, double p_3) const;
  void SetPump(size_t k, double speed, const model::Terms<double>& terms, model::Mode* mode,
               std::array<uint8_t, kBalances>* informative) const;
  void SetValves(const model::Equations& equations, size_t k, const double* state,
                 const model::Terms<double>& terms, model::Mode* mode,
                 std::array<uint8_t, kBalances>* informative);

  const Setup& setup_;
  std::array<bool, 2> at_valve_{};
  std::array<double, 2> free_rate_{};
};

}  // namespace hydro::diagnose::smoother
