#include "line.h"

#include <cmath>

namespace hidden_rig {

namespace {

// For a chain of volumes that rings at w^2 = `square` with unit inertances: the flow that is left after the
// last volume. It is 0 at a resonance.
double Rest(const std::array<double, kLineNodes + 1>& compliance, double square) {
  double pressure = 1;
  double flow = 0;  // into the node from the pump's side, as a factor of sin
  for (int i = 0; i <= kLineNodes; ++i) {
    flow -= compliance[i] * pressure * square;
    if (i < kLineNodes) pressure += flow;
  }
  return flow;
}

}  // namespace

Line TuneLine(double hz, double pump_fraction, double damping, double mid_volume, double beta) {
  Line line;
  const double small = 0.01 * mid_volume;
  for (int i = 1; i < kLineNodes; ++i) line.volume[i] = small;
  line.volume[0] = pump_fraction * mid_volume - 0.5 * (kLineNodes - 1) * small;
  for (const double v : line.volume) line.fixed_volume += v;

  std::array<double, kLineNodes + 1> compliance{};
  for (int i = 0; i < kLineNodes; ++i) compliance[i] = line.volume[i] / beta;
  compliance[kLineNodes] = (mid_volume - line.fixed_volume) / beta;
  const double lumped =
      (1 / (pump_fraction * mid_volume) + 1 / (mid_volume * (1 - pump_fraction))) * beta / kPieces;
  double low = 0.3 * lumped;
  double high = low;
  while (std::signbit(Rest(compliance, high)) == std::signbit(Rest(compliance, low))) high *= 1.02;
  low = high / 1.02;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    const bool same = std::signbit(Rest(compliance, middle)) == std::signbit(Rest(compliance, low));
    (same ? low : high) = middle;
  }
  const double w = 2 * 3.14159265358979323846 * hz;
  line.inertance = low / (w * w);
  // The resistance to a steady flow is that of one lumped inertance, as the catalogue's damping means it.
  line.resistance = 2 * damping * lumped / w;
  return line;
}

}  // namespace hidden_rig
