// Columns of effects that repeat with the shaft: a carrier from the effect's own equation, times sine and
// cosine of the shaft's angle.
#include <cmath>
#include <numbers>

#include "diagnose/balances/column_maker.h"
#include "model/effects/catalogue.h"

namespace hydro::diagnose {
namespace {

// The effect with its wave fixed at its crest.
model::EffectDescription AtCrest(const EffectVariant& variant) {
  model::EffectDescription effect = variant.at;
  const model::CatalogueEntry* entry = model::FindCatalogueEntry(effect.id);
  for (const model::ParameterInfo& parameter : entry->info.parameters) {
    if (!parameter.is_number()) continue;
    const bool sine = parameter.role == model::Role::kPhase;
    // So few periods that the angle over a whole run makes no difference.
    effect.parameters[parameter.name] = sine                                      ? std::numbers::pi / 2
                                        : parameter.role == model::Role::kPeriods ? 1e-12
                                                                                  : 0;
  }
  return effect;
}

BalanceSeries CarrierOf(const ColumnMaker& maker, size_t v, size_t run) {
  const EffectVariant& variant = maker.setup->variants[v];
  model::ModelDescription model = maker.setup->given;
  model.effects.push_back(AtCrest(variant));
  const std::vector<model::EffectParameter> all = model::EffectParameters(model);
  for (size_t i = 0; i < all.size(); ++i) {
    if (all[i].effect + 1 != model.effects.size()) continue;
    const model::Role role = ParameterOf(variant.at, all[i].name).role;
    if (role != model::Role::kTorqueWave && role != model::Role::kDisplacementWave) continue;
    const auto found = DerivativesOf(model, maker.Motion(run), {{model::Unknown::Kind::kEffect, i}});
    return found.empty() ? BalanceSeries{} : found.front();
  }
  return {};
}

}  // namespace

void AddWaveColumns(ColumnMaker* maker) {
  for (size_t v = 0; v < maker->setup->variants.size(); ++v) {
    const EffectVariant& variant = maker->setup->variants[v];
    if (variant.kind != EffectVariant::Kind::kWave) continue;
    struct Part {
      int periods, column;
      bool sine;
      size_t run;
    };
    std::vector<Part> parts;
    for (const int periods : maker->setup->periods) {
      const std::string set = variant.set + "|" + std::to_string(periods);
      for (size_t run = 0; run < maker->runs->size(); ++run) {
        for (const bool sine : {true, false}) {
          const std::string name = set + ":" + (sine ? "sin" : "cos") + "[" + std::to_string(run) + "]";
          ColumnMeaning meaning{.kind = ColumnMeaning::Kind::kWave,
                                .variant = v,
                                .parameter = sine ? "sin" : "cos",
                                .unit = 0,
                                .run = static_cast<int>(run)};
          parts.push_back({periods, maker->Add({name, set, 1, false}, meaning), sine, run});
        }
      }
    }
    maker->works.back().push_back([maker, v, parts](size_t run) {
      const BalanceSeries carrier = CarrierOf(*maker, v, run);
      const RunMotion& motion = maker->Motion(run);
      const double smoothing = SmoothingOf(motion.step);
      for (const Part& part : parts) {
        if (part.run != run) continue;
        BalanceSeries wave = carrier;
        for (Eigen::VectorXd& series : wave) {
          for (Eigen::Index i = 0; i < series.size(); ++i) {
            const model::KnownMotion& at = motion.at[static_cast<size_t>(i) * motion.stride];
            const double angle = part.periods * at.motor_angle;
            // The part of this frequency that the Gaussian smoothing of the signals leaves.
            const double left = std::exp(-0.5 * std::pow(part.periods * at.motor_speed * smoothing, 2));
            series[i] *= left * (part.sine ? std::sin(angle) : std::cos(angle));
          }
        }
        maker->Put(part.column, run, wave);
      }
    });
  }
}

}  // namespace hydro::diagnose
