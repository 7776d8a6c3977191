#include "experiments/studies/paper_units.h"

#include <utility>

#include "experiments/runs/shipped_models.h"
#include "model/terms/parameter_info.h"
#include "runs/measured/sample_times.h"
#include "runs/measured/signal_columns.h"
#include "settings/model_file.h"

namespace hydro::experiments {

double PaperUnitIn(const UnitSystem& units, const std::string& paper, int arm) {
  const UnitSystem ours{.linear_arm = units.linear_arm};
  return runs::UnitFactor(ours.UnitFor(paper, arm), units.UnitFor(paper, arm)).value();
}

model::Parameters PaperParameters(const model::ModelDescription& model) {
  model::Parameters parameters = model.parameters;
  for (const model::BaseParameter& base : model::BaseParameters()) {
    parameters.*base.member /= PaperUnitIn(model.units, base.info.unit, base.info.arm);
  }
  return parameters;
}

RunAndModel ReadRunAndModel(const std::string& file) {
  runs::MeasuredRun run = runs::ReadMeasuredRun(file);
  // Only the log says whether its arm is linear, so a log in other units is read twice.
  const UnitSystem ours{.linear_arm = run.units.linear_arm};
  if (run.units != ours) run = runs::ReadMeasuredRun(file, ours);
  runs::RequirePossibleSamples(run);
  model::ModelDescription model = run.model_text.empty()
                                      ? ShippedModel("table1")
                                      : settings::ParseModel(run.model_text, run.file + " (model)");
  return {std::move(run), std::move(model)};
}

}  // namespace hydro::experiments
