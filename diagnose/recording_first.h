// Checks the recordings first. Their faults are reported before any physics, and no effect is named on top of
// a fault.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "diagnose/evidence/clocks.h"
#include "diagnose/evidence/late_command.h"
#include "diagnose/evidence/recording_check.h"
#include "diagnose/recording/diagnosis.h"
#include "model/terms/description.h"
#include "runs/measured/measured_run.h"

namespace hydro::diagnose {

struct CheckedRecordings {
  std::vector<std::string> mistakes;  // signs, exchanged channels, units: one line each, with the remedy
  // Factors that match no known unit, one line each. Oil or a hose may look like such a factor, so the search
  // goes on.
  std::vector<std::string> factors;
  std::vector<std::string> damage;    // values that are lost, dropouts, spikes, cuts: one line each
  std::vector<std::string> repeats;   // slow sensors that repeat their values, commands written at changes
  std::string load;                   // LoadRemark()
  std::vector<std::string> ratios;    // RatioRemarks()
  std::vector<std::string> vacuum;    // pressures below absolute zero that noise does not explain
  std::vector<std::string> nearly;    // and those that noise may explain: one line each
  CommandRemarks commands;            // RemarksOnCommands()
  std::vector<std::string> sensors;   // CompareSensors()
  std::vector<std::string> unjudged;  // runs of which nothing can be said: one line for each kind
  // The mistakes make a search useless, because it would explain them by physics.
  bool mend_first = false;
  // Sensors ("p1") of which only the sign is wrong. The search deals with them.
  std::vector<std::string> inverted = {};
  // The fitted runs, then the held-out runs, each with its signals on one clock.
  std::vector<AlignedRun> aligned = {};
};

// Checks the fitted and the held-out runs and sets damaged samples aside, and second sensors of a quantity
// that contradict the first. A single inverted sensor is left to the search if `sensor.sign` is among the
// effects that may be named (an empty list means all). Mistakes that `time_is_up` cuts off are not found.
CheckedRecordings CheckFirst(
    const model::ModelDescription& model, const std::vector<std::string>& effects, int jobs,
    std::vector<runs::MeasuredRun>* runs, std::vector<runs::MeasuredRun>* held_out,
    const std::function<bool()>& time_is_up = [] { return false; });

// The diagnosis of runs that must be corrected first: `unexplained`, without a search.
Diagnosis MendFirst(const model::ModelDescription& model, const CheckedRecordings& checked,
                    const std::vector<runs::MeasuredRun>& runs,
                    const std::vector<runs::MeasuredRun>& held_out);

// Puts the remarks of the check first. If a mistake was left to the search and the search did not name it, no
// other effect stays named.
void AddChecked(const CheckedRecordings& checked, Diagnosis* diagnosis);

// A report on the recordings alone.
struct RecordingReport {
  std::vector<std::string> wrong;  // one line each
  // How tables were read, and what these runs cannot show although nothing is wrong with them.
  std::vector<std::string> limits;
  // Runs that cannot be judged, and why: one line each.
  std::vector<std::string> unjudged;
  bool doubtful = false;  // a limit names what may be wrong with the recording, or be the machine
};
// Throws InputError for data that cannot be used, unless a mistake explains it.
RecordingReport ReportOnRecordings(const model::ModelDescription& model, std::vector<runs::MeasuredRun> runs,
                                   int jobs);

}  // namespace hydro::diagnose
