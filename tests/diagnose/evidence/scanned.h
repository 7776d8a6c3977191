// Short noisy runs of a machine as the scan sees them, with the rows and the evidence of them.
#pragma once

#include <string>
#include <vector>

#include "diagnose/balances/make_rows.h"
#include "diagnose/evidence/set_evidence.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::testing {

// All of it belongs together, and stays where it is.
struct Scanned {
  // All base values of the model as given that are not 0 may differ, and these effects may be missing.
  Scanned(std::vector<diagnose::RunData> measured, const std::vector<std::string>& effects,
          const model::ModelDescription& given = Table1With())
      : data(std::move(measured)),
        runs(given, diagnose::PointersTo(data), OptionsWith(given.parameters, effects)),
        rows(runs.MakeRows({})) {}

  static diagnose::ScanOptions OptionsWith(const model::Parameters& given,
                                           const std::vector<std::string>& effects) {
    diagnose::ScanOptions options;
    for (size_t i = 0; i < model::BaseParameters().size(); ++i) {
      if (given.*model::BaseParameters()[i].member != 0) options.allowed.push_back(i);
    }
    for (const std::string& effect : effects) options.changes.push_back({effect, {}, ""});
    return options;
  }

  // The variant of the change that has the most evidence.
  diagnose::ChangeSet Best(const std::string& change) const {
    const diagnose::SetEvidence evidence(rows);
    diagnose::ChangeSet best;
    double most = -1e300;
    for (const std::string& name : evidence.names()) {
      if (diagnose::ChangeOf(name) != change || !(evidence.Log({name}) > most)) continue;
      most = evidence.Log({name});
      best = {name};
    }
    return best;
  }

  std::vector<diagnose::RunData> data;
  diagnose::ScanRuns runs;
  diagnose::Rows rows;
};

}  // namespace hydro::testing
