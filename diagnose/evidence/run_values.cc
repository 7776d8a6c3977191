#include "diagnose/evidence/run_values.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "diagnose/balances/make_rows.h"
#include "diagnose/evidence/change_set.h"
#include "diagnose/evidence/set_evidence.h"

namespace hydro::diagnose {
namespace {

// The amounts in the value's own columns, converted to its unit: for all runs and one run together; with
// `run` below 0, for all runs alone.
Eigen::VectorXd PartsOf(const ScanRuns& runs, const SetFit& fit, double given, int run) {
  Eigen::VectorXd parts = Eigen::VectorXd::Zero(fit.amounts.size());
  for (Eigen::Index i = 0; i < parts.size(); ++i) {
    const ColumnMeaning& meaning = runs.meaning()[static_cast<size_t>(fit.columns[static_cast<size_t>(i)])];
    if (meaning.kind == ColumnMeaning::Kind::kBase && (meaning.run < 0 || meaning.run == run))
      parts[i] = meaning.unit * (given != 0 ? given : 1);
  }
  return parts;
}

}  // namespace

std::optional<RunValues> ValuesOfRuns(const model::ModelDescription& model,
                                      const std::vector<const RunData*>& runs, size_t base, int jobs) {
  const model::BaseParameter& parameter = model::BaseParameters()[base];
  ScanOptions options;
  options.jobs = jobs;
  options.allowed = {base};
  options.per_run = {parameter.info.name};
  options.hold_effects = true;
  options.curves = false;
  ScanRuns scan(model, runs, options);
  const Rows rows = scan.MakeRows({});
  if (rows.blocks.empty()) return std::nullopt;
  const SetEvidence evidence(rows);
  const std::string name = "run." + parameter.info.name;
  if (!evidence.Shows({name})) return std::nullopt;
  const SetFit one = evidence.Fit({}), own = evidence.Fit({name});
  RunValues values;
  values.base = base;
  values.gain = own.log_evidence - one.log_evidence + ChangeOdds({name}).LogOdds({name});
  const double given = model.parameters.*parameter.member;
  const auto bounded = [&](double value) {
    return std::clamp(value, parameter.info.min, parameter.info.max);
  };
  values.common = bounded(given + PartsOf(scan, one, given, -1).dot(one.amounts));
  for (size_t run = 0; run < runs.size(); ++run) {
    const Eigen::VectorXd parts = PartsOf(scan, own, given, static_cast<int>(run));
    const double value = given + parts.dot(own.amounts);
    const double reach = 1.96 * std::sqrt(std::max(0.0, parts.dot(own.covariance * parts)));
    values.value.push_back(bounded(value));
    values.low.push_back(bounded(value - reach));
    values.high.push_back(bounded(value + reach));
  }
  return values;
}

std::vector<size_t> ValuesOfADay(const std::vector<size_t>& allowed) {
  using model::Parameters;
  std::vector<size_t> places;
  for (const size_t place : allowed) {
    for (double Parameters::*member :
         {&Parameters::T_s, &Parameters::b, &Parameters::mgl, &Parameters::J_a, &Parameters::p_3}) {
      if (model::BaseParameters()[place].member == member) places.push_back(place);
    }
  }
  return places;
}

}  // namespace hydro::diagnose
