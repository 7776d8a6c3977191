#include <cmath>
#include <string>

#include "model/actuator.h"
#include "settings/effect_file.h"
#include "settings/model_file.h"
#include "settings/stack_config.h"
#include "tests/fuzz/promise.h"
#include "tests/fuzz/scratch_folder.h"
#include "tests/fuzz/targets.h"
#include "tests/settings/texts.h"

namespace hydro::fuzz {
namespace {

// With the values of its examples, as a plant runs it for some ticks. Formulas may lead anywhere: that is a
// ModelError.
void Runs(const std::shared_ptr<const model::EffectFormulas>& formulas) {
  model::ModelDescription rig = settings::ParseModel(settings::kModelText, "model.toml");
  model::EffectDescription effect;
  effect.id = formulas->info().id;
  effect.formulas = formulas;
  for (const model::ParameterInfo& parameter : formulas->info().parameters) {
    if (parameter.is_name()) {
      effect.names[parameter.name] = parameter.names.front();
    } else {
      effect.parameters[parameter.name] = parameter.example;
    }
  }
  rig.effects = {effect};
  try {
    model::Actuator actuator(rig, {});
    for (int k = 1; k <= 5; ++k) actuator.Advance(k < 3 ? 2 : -2, 1e-3 * k);
    Promise(std::isfinite(actuator.Measure().p1), "a run that goes on is finite");
  } catch (const model::ModelError&) {
  }
}

}  // namespace

void Effect(const uint8_t* data, size_t size) {
  static const ScratchFolder folder;
  const std::string file = folder.Write("effect.toml", Text(data, size));
  Accepts([&] { Runs(settings::LoadEffectFile(file)); });
}

}  // namespace hydro::fuzz
