#include "diagnose/evidence/run_values.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>

#include "diagnose/balances/make_rows.h"
#include "diagnose/evidence/change_set.h"
#include "diagnose/evidence/set_evidence.h"

namespace hydro::diagnose {

namespace {

// The amounts in the value's own columns, converted to its unit: for all runs and one run together; with
// `run` below 0, for all runs alone.
Eigen::VectorXd PartsOf(const ScanRuns& runs, const SetFit& fit, size_t base, double given, int run) {
  Eigen::VectorXd parts = Eigen::VectorXd::Zero(fit.amounts.size());
  for (Eigen::Index i = 0; i < parts.size(); ++i) {
    const ColumnMeaning& meaning = runs.meaning()[static_cast<size_t>(fit.columns[static_cast<size_t>(i)])];
    const bool own = meaning.kind == ColumnMeaning::Kind::kBase && meaning.base == base;
    if (own && (meaning.run < 0 || meaning.run == run)) parts[i] = meaning.unit * (given != 0 ? given : 1);
  }
  return parts;
}

// The value of each run, and one for all, where only this value is free.
std::optional<RunValues> ValuesIn(const ScanRuns& scan, const Rows& rows,
                                  const model::ModelDescription& model, size_t base, size_t runs) {
  const model::BaseParameter& parameter = model::BaseParameters()[base];
  const SetEvidence evidence(rows);
  const std::string name = "run." + parameter.info.name;
  if (!evidence.Shows({name})) return std::nullopt;
  const SetFit one = evidence.Fit({}), own = evidence.Fit({name});
  RunValues values;
  values.base = base;
  values.log_evidence = own.log_evidence;
  values.gain = own.log_evidence - one.log_evidence + ChangeOdds({name}).LogOdds({name});
  const double given = model.parameters.*parameter.member;
  const auto bounded = [&](double value) {
    return std::clamp(value, parameter.info.min, parameter.info.max);
  };
  values.common = bounded(given + PartsOf(scan, one, base, given, -1).dot(one.amounts));
  for (size_t run = 0; run < runs; ++run) {
    const Eigen::VectorXd parts = PartsOf(scan, own, base, given, static_cast<int>(run));
    const double value = given + parts.dot(own.amounts);
    const double reach = 1.96 * std::sqrt(std::max(0.0, parts.dot(own.covariance * parts)));
    values.value.push_back(bounded(value));
    values.low.push_back(bounded(value - reach));
    values.high.push_back(bounded(value + reach));
  }
  return values;
}

}  // namespace

std::vector<RunValues> ValuesOfRuns(const model::ModelDescription& model,
                                    const std::vector<const RunData*>& runs, const std::vector<size_t>& bases,
                                    int jobs) {
  ScanOptions options;
  options.jobs = jobs;
  options.allowed = bases;
  for (const size_t base : bases) options.per_run.push_back(model::BaseParameters()[base].info.name);
  options.hold_effects = true;
  ScanRuns scan(model, runs, options);
  Rows rows = scan.MakeRows({});
  std::vector<RunValues> all;
  if (rows.blocks.empty()) return all;
  const std::vector<int> columns = rows.base;
  for (const size_t base : bases) {
    // The other values stay as they are.
    rows.base.clear();
    std::ranges::copy_if(columns, std::back_inserter(rows.base), [&](int column) {
      return scan.meaning()[static_cast<size_t>(column)].base == base;
    });
    if (const std::optional<RunValues> values = ValuesIn(scan, rows, model, base, runs.size()))
      all.push_back(*values);
  }
  return all;
}

std::vector<size_t> ValuesOfADay(const std::vector<size_t>& allowed) {
  using model::Parameters;
  std::vector<size_t> places;
  for (const size_t place : allowed) {
    for (double Parameters::*member :
         {&Parameters::T_s, &Parameters::b, &Parameters::mgl, &Parameters::p_3}) {
      if (model::BaseParameters()[place].member == member) places.push_back(place);
    }
  }
  return places;
}

}  // namespace hydro::diagnose
