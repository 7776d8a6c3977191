// The recordings come first: what is wrong with them is said before any physics, and nothing is named on top of it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "diagnose/evidence/clocks.h"
#include "diagnose/evidence/recording_check.h"
#include "diagnose/recording/diagnosis.h"
#include "model/terms/description.h"
#include "runs/measured_run.h"

namespace hydro::diagnose {

struct CheckedRecordings {
  std::vector<std::string> mistakes;  // signs, exchanged channels, units: a line each, with the remedy
  // Factors that are no known unit's, a line each: oil or a hose may look like one, so the search goes on.
  std::vector<std::string> factors;
  std::vector<std::string> damage;   // dropouts, spikes, cuts: a line each
  std::vector<std::string> repeats;  // slow sensors that repeat their values: a line each
  std::string load;                  // LoadRemark()
  std::vector<std::string> ratios;   // RatioRemarks()
  std::string unjudged;              // runs that the model as given does not predict at all; empty: none
  // The mistakes make a search useless: it would name physics for them.
  bool mend_first = false;
  // Sensors of which only the sign is wrong, which is left to the search ("p1").
  std::vector<std::string> inverted = {};
  // The fitted, then the held-out runs, on one clock.
  std::vector<AlignedRun> aligned = {};
};

// Checks the fitted and the held-out runs and sets damaged samples aside. Where `sensor.sign` is among the
// effects that may be named (none listed: all), a single inverted sensor is left to the search. What `time_is_up` cuts off
// is not found.
CheckedRecordings CheckFirst(
    const model::ModelDescription& model, const std::vector<std::string>& effects, int jobs,
    std::vector<runs::MeasuredRun>* runs, std::vector<runs::MeasuredRun>* held_out,
    const std::function<bool()>& time_is_up = [] { return false; });

// The diagnosis of runs that must be mended first: `unexplained`, nothing searched.
Diagnosis MendFirst(const model::ModelDescription& model, const CheckedRecordings& checked,
                    const std::vector<runs::MeasuredRun>& runs,
                    const std::vector<runs::MeasuredRun>& held_out);

// Puts the remarks of the check first; where a mistake was left to the search and the search did not name it,
// nothing else stays named.
void AddChecked(const CheckedRecordings& checked, Diagnosis* diagnosis);

// What there is to say of recordings alone.
struct RecordingReport {
  std::vector<std::string> wrong;  // a line each
  // How tables were read, and what these runs cannot show, though nothing is wrong with them.
  std::vector<std::string> limits;
  bool judged = true;  // false: a limit names runs that the model as given does not predict at all
};
// Throws InputError for data that cannot be used, unless a mistake explains it.
RecordingReport ReportOnRecordings(const model::ModelDescription& model, std::vector<runs::MeasuredRun> runs,
                                   int jobs);

}  // namespace hydro::diagnose
