#include "experiments/runs/pressure_sweep.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "settings/model_file.h"

namespace hydro::experiments {

std::string ClampedLoopConfig(const ClampedLoop& loop) {
  return fmt::format(R"([model]
file = "model.toml"
shaft = "clamped"
arm_angle = {}
initial_pressure = {}
[time]
mode = "lockstep"
duration_s = {}
[plant]
rate_hz = {}
command_delay_ticks = {}
[pressure]
k_p = {}
k_v = {}
[position]
sample_interval_s = {}
[limits]
pressure = inf
[reference]
signal = "pressure"
{})",
                     loop.arm_angle, loop.initial_pressure, loop.duration, loop.rate_hz, loop.delay_ticks,
                     loop.gains.k_p, loop.gains.k_v, 1 / loop.rate_hz, loop.reference);
}

namespace {

// The sine starts this factor below the band, so that the valves have let in all they will, and ends above
// the band.
constexpr double kBelow = 4;
constexpr double kAbove = 1.4;

std::string Configuration(const PressureSweep& sweep, const SweptBand& band) {
  const double initial =
      std::isnan(sweep.initial_pressure) ? sweep.model.parameters.p_3 : sweep.initial_pressure;
  return ClampedLoopConfig(
      {.arm_angle = sweep.arm_angle,
       .initial_pressure = initial,
       .duration = sweep.rest_s + band.duration_s,
       .rate_hz = sweep.rate_hz,
       .gains = sweep.gains,
       .reference = fmt::format("kind = \"chirp\"\noffset = {}\namplitude = {}\nfirst_frequency_hz = {}\n"
                                "last_frequency_hz = {}\nstart_s = {}\nduration_s = {}\n",
                                sweep.offset, sweep.amplitude, band.first_hz / kBelow, band.last_hz * kAbove,
                                sweep.rest_s, band.duration_s)});
}

}  // namespace

SweptPressureLoop RunPressureSweep(const PressureSweep& sweep, const StackRunner& run_stack) {
  const model::Parameters& p = sweep.model.parameters;
  const std::string model = settings::FormatModel(sweep.model);
  SweptPressureLoop result;
  double rows = 0;
  for (const SweptBand& band : sweep.bands) {
    const tables::Table table = run_stack(
        {fmt::format("{}-from-{}-hz", sweep.name, band.first_hz), Configuration(sweep, band), model});
    const std::vector<double>& voltage = table.Find("voltage_V")->values;
    const std::vector<double>& speed = table.Find("motor_speed_rad_s")->values;
    const std::vector<double>& p1 = table.Find("p1_psi")->values;
    const std::vector<double>& p2 = table.Find("p2_psi")->values;
    const std::vector<double>& reference = table.Find("pressure_ref_psi")->values;
    const auto first = static_cast<size_t>(std::lround(sweep.rest_s * sweep.rate_hz));
    std::vector<double> input;
    std::vector<double> output;
    for (size_t i = first; i + 1 < table.rows(); ++i) {
      input.push_back(reference[i]);
      output.push_back(p2[i] - p1[i]);
      const double torque = std::abs(p.k_1 * voltage[i]);
      result.saturated_fraction += torque >= p.T_pmax * (1 - 1e-12);
      result.stuck_fraction += speed[i] == 0;
      result.both_compress_fraction += p1[i] > p.p_3 && p2[i] > p.p_3;
      result.largest_torque = std::max(result.largest_torque, torque);
    }
    rows += static_cast<double>(input.size());
    const auto points = design::EstimateFrequencyResponse(input, output,
                                                          {.sample_rate_hz = sweep.rate_hz,
                                                           .segment_s = band.segment_s,
                                                           .first_hz = band.first_hz,
                                                           .last_hz = band.last_hz,
                                                           .points_per_decade = band.points_per_decade});
    for (const design::ResponsePoint& point : points) {
      const bool new_one =
          result.points.empty() || point.frequency_hz > result.points.back().frequency_hz + 0.01;
      if (new_one) result.points.push_back(point);
    }
  }
  result.saturated_fraction /= rows;
  result.stuck_fraction /= rows;
  result.both_compress_fraction /= rows;
  return result;
}

}  // namespace hydro::experiments
