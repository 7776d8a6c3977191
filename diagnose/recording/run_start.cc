// Finds where a measured run begins.
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "diagnose/recording/run_data.h"
#include "model/terms/state.h"

namespace hydro::diagnose {
namespace {

// The value and slope at the first time of a straight line through the first valid samples, with standard
// errors. The value is NaN for a signal that is not measured.
struct StartLine {
  double value = runs::kMissing, slope = 0;
  double value_error = 0, slope_error = 0;
  double noise = 0;  // of the signal
};
using StartLines = std::array<StartLine, model::kChannels>;

// Takes a speed for 0 when the samples cannot distinguish it from 0. A motion that should begin at rest but
// gets a small speed slips where friction or cogging would hold it, and the fit then stays one tooth off.
double Rest(double speed, double error) { return std::abs(speed) < kHides * error ? 0 : speed; }

StartLine FirstLine(const std::vector<double>& time, const SignalData& signal) {
  std::vector<size_t> rows;
  for (size_t i = 0; i < time.size() && rows.size() < 10; ++i) {
    if (!std::isnan(signal.values[i])) rows.push_back(i);
  }
  // A signal that begins late says nothing about the slope at the start.
  if (rows[0] > 20) return {signal.values[rows[0]], 0};
  // Use fewer samples where no line passes through ten: a fast event near the start.
  for (const size_t count : {rows.size(), size_t{5}, size_t{3}}) {
    double t = 0, y = 0, tt = 0, ty = 0, off = 0;
    const double n = static_cast<double>(count);
    for (size_t k = 0; k < count; ++k) {
      t += (time[rows[k]] - time[0]) / n;
      y += signal.values[rows[k]] / n;
    }
    for (size_t k = 0; k < count; ++k) {
      const double since = time[rows[k]] - time[0] - t;
      tt += since * since;
      ty += since * (signal.values[rows[k]] - y);
    }
    const StartLine line{y - ty / tt * t, ty / tt, signal.noise * std::sqrt(1 / n + t * t / tt),
                         signal.noise / std::sqrt(tt)};
    for (size_t k = 0; k < count; ++k) {
      const double expected = line.value + line.slope * (time[rows[k]] - time[0]);
      off += std::pow(signal.values[rows[k]] - expected, 2);
    }
    if (off <= 9 * signal.noise * signal.noise * n) return line;
  }
  const double slope = (signal.values[rows[1]] - signal.values[rows[0]]) / (time[rows[1]] - time[rows[0]]);
  return {signal.values[rows[0]], slope};
}

StartLines FirstLines(const RunData& data) {
  StartLines lines;
  for (const SignalData& signal : data.signals) {
    StartLine& line = lines[static_cast<size_t>(signal.channel)];
    line = FirstLine(data.stimulus.time, signal);
    line.noise = signal.noise;
  }
  return lines;
}

// How far the true state may be from its line's value, as a standard deviation: noise, a scale that is wrong
// by `scale`, and a sensor that is late. NaN without a line.
double ErrorOf(const StartLine& line, double scale) {
  constexpr double kLate = 0.005;  // s
  return kHides * line.noise + scale * std::abs(line.value) + kLate * std::abs(line.slope);
}

// The same for a speed that is known from the angle alone.
double SlopeErrorOf(const StartLine& angle) {
  constexpr double kScale = 0.1;
  constexpr double kErrors = 5;
  return kErrors * angle.slope_error + kScale * std::abs(angle.slope);
}

void SetStartErrors(const StartLines& lines, RunData* data) {
  constexpr double kScale = 0.03;  // of a pressure or speed; an angle has no fixed zero
  const auto line = [&lines](model::Channel channel) { return lines[static_cast<size_t>(channel)]; };
  const auto set = [data](size_t state, double error, double otherwise) {
    const double known = std::isnan(error) ? otherwise : error;
    data->start_error[state] = known > 0 ? known : std::numeric_limits<double>::infinity();
  };
  using enum model::Channel;
  const double p1 = ErrorOf(line(kP1), kScale), p2 = ErrorOf(line(kP2), kScale);
  set(model::kMotorAngle, ErrorOf(line(kMotorAngle), 0), runs::kMissing);
  set(model::kMotorSpeed, ErrorOf(line(kMotorSpeed), kScale), SlopeErrorOf(line(kMotorAngle)));
  set(model::kP1, p1, data->stimulus.bypass ? p2 : runs::kMissing);
  set(model::kP2, p2, runs::kMissing);
  if (data->stimulus.shaft != model::Shaft::kFree) return;
  set(model::kArmAngle, ErrorOf(line(kArmAngle), 0), runs::kMissing);
  set(model::kArmSpeed, ErrorOf(line(kArmSpeed), kScale), SlopeErrorOf(line(kArmAngle)));
}

}  // namespace

void SetStart(const model::Parameters& model, RunData* data) {
  const std::vector<double>& time = data->stimulus.time;
  const StartLines lines = FirstLines(*data);
  const auto line = [&lines](model::Channel channel) { return lines[static_cast<size_t>(channel)]; };
  const auto first_known = [](double a, double b) { return std::isnan(a) ? b : a; };
  const StartLine motor_angle = line(model::Channel::kMotorAngle),
                  motor_speed = line(model::Channel::kMotorSpeed);
  data->start[model::kMotorAngle] = first_known(motor_angle.value, 0);
  data->start[model::kMotorSpeed] = first_known(Rest(motor_speed.value, motor_speed.value_error),
                                                Rest(motor_angle.slope, motor_angle.slope_error));
  data->start_free[model::kMotorAngle] = !std::isnan(motor_angle.value);
  data->start_free[model::kMotorSpeed] = true;

  double p1 = line(model::Channel::kP1).value, p2 = line(model::Channel::kP2).value;
  if (data->stimulus.bypass) {
    // With the bypass open there is a single pressure, from the sum of eqs. (13) and (14): p1 represents both
    // in start_free, and code that moves it moves p2 too.
    p1 = p2 = std::isnan(p1) ? p2 : std::isnan(p2) ? p1 : (p1 + p2) / 2;
  }
  data->start[model::kP1] = first_known(p1, model.p_3);
  data->start[model::kP2] = first_known(p2, model.p_3);
  data->start_free[model::kP1] = true;
  data->start_free[model::kP2] = !data->stimulus.bypass;

  if (data->stimulus.shaft == model::Shaft::kFree) {
    const StartLine arm_angle = line(model::Channel::kArmAngle), arm_speed = line(model::Channel::kArmSpeed);
    data->start[model::kArmAngle] = first_known(arm_angle.value, 0);
    data->start[model::kArmSpeed] = first_known(Rest(arm_speed.value, arm_speed.value_error),
                                                Rest(arm_angle.slope, arm_angle.slope_error));
    data->start_free[model::kArmAngle] = data->start_free[model::kArmSpeed] = true;
  } else if (data->stimulus.shaft == model::Shaft::kDriven) {
    data->start[model::kArmAngle] = data->stimulus.motion->Value(time.front());
    data->start[model::kArmSpeed] = data->stimulus.motion->Rate(time.front());
  } else {
    data->start[model::kArmAngle] = data->stimulus.arm_angle;
  }
  SetStartErrors(lines, data);
  // The volume that the oil of a side releases from the greatest pressure that the pump holds.
  data->start_error[model::kReturned] = model.V_ms / model.beta * model.T_pmax / model.D;
}

}  // namespace hydro::diagnose
