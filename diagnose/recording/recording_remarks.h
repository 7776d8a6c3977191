// What is wrong with a recording, or what it lacks, one sentence each.
#pragma once

#include <string>
#include <vector>

#include "diagnose/recording/diagnosis.h"
#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {

// Remarks on clocks that differ; noise unlike the stated noise; sensors at the end of their range; gaps;
// resolution coarser than the noise; a motor that hardly turns, or turns only one way; pressures that never
// leave the accumulator's. Empty when there is nothing to remark on.
std::vector<std::string> RecordingRemarks(const std::vector<ClockDelay>& clocks,
                                          const std::vector<const RunData*>& runs,
                                          const std::vector<const RunData*>& held_out);

// What the motion of these runs, taken together, cannot show because a motor hardly turns or turns only one
// way, or because pressures hardly change.
std::vector<std::string> MotionRemarks(const std::vector<const RunData*>& runs);

// Throws InputError where nothing is commanded and nothing moves in any of the runs: whatever the model, it
// predicts rest, so that they cannot show that it is right. `role`: "fitted" or "held-out".
void RequireMotion(const std::vector<const RunData*>& runs, const std::string& role);

// "run sine: motor_speed is late by 0.334 +- 0.013 s relative to p1 and p2"
std::string DelayRemark(const ClockDelay& delay);

// How tables that were not plain CSV were read: one remark for all runs that share the layout. The layout is
// not a fault.
std::vector<std::string> LayoutRemarks(const std::vector<const RunData*>& runs);

// Names the joints of a limb's [arm] among the runs, because no model of one joint has their loads; empty:
// there are none.
std::string LoadRemark(const std::vector<runs::MeasuredRun>& runs);

// What these runs cannot show although nothing is wrong with them, because no run has a signal, or because
// samples are too far apart for the model's fastest motion, or because a command is far beyond what acts.
std::vector<std::string> LimitRemarks(const model::Parameters& model,
                                      const std::vector<const RunData*>& runs);

}  // namespace hydro::diagnose
