// What is wrong with a recording, or what it lacks: one sentence each.
#pragma once

#include <string>
#include <vector>

#include "diagnose/recording/diagnosis.h"
#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {

// Remarks on: clocks that differ; noise unlike the stated noise; sensors at the end of their range; gaps;
// resolution coarser than the noise; a motor that hardly turns, or turns one way only; pressures that never
// leave the accumulator's. Empty when there is nothing to remark on.
std::vector<std::string> RecordingRemarks(const std::vector<ClockDelay>& clocks,
                                          const std::vector<const RunData*>& runs,
                                          const std::vector<const RunData*>& held_out);

// What the motion of these runs, taken together, cannot show: of a motor that hardly turns, or turns one way only; of pressures that hardly
// change.
std::vector<std::string> MotionRemarks(const std::vector<const RunData*>& runs);

// "run sine: motor_speed is late by 0.334 +- 0.013 s relative to p1 and p2"
std::string DelayRemark(const ClockDelay& delay);

// How tables were read that were not plain CSV: one remark for all runs that share it. It is no fault.
std::vector<std::string> LayoutRemarks(const std::vector<const RunData*>& runs);

// The joints of a limb's [arm] among the runs, whose loads no model of one joint has; empty: there is none.
std::string LoadRemark(const std::vector<runs::MeasuredRun>& runs);

// What these runs cannot show though nothing is wrong with them: signals that no run has, and samples too far
// apart for the model's fastest motion.
std::vector<std::string> LimitRemarks(const model::Parameters& model,
                                      const std::vector<const RunData*>& runs);

}  // namespace hydro::diagnose
