#include "diagnose/balances/effect_variants.h"

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "model/effects/catalogue.h"
#include "model/effects/effect.h"

namespace hydro::diagnose {
namespace {

using model::ParameterInfo;
using model::Role;

// s: from times shorter than a sample shows to times that are no longer called a lag, in half octaves.
// Neighbours differ by less than such balances can distinguish.
constexpr double kShortestTime = 5e-4, kTimeRatio = 1.4142135623730951;
constexpr int kTimes = 13;
// As a fraction of a sample: a shorter time does not show.
constexpr double kLeastTime = 0.2;

bool IsWave(const ParameterInfo& parameter) {
  return parameter.role == Role::kTorqueWave || parameter.role == Role::kDisplacementWave;
}

bool IsSize(const ParameterInfo& parameter) {
  const bool allows_0 = parameter.min < 0 || (parameter.min == 0 && parameter.min_allowed);
  return parameter.is_number() && parameter.role == Role::kSize && allows_0 &&
         std::ranges::find(parameter.starts, 0.0) != parameter.starts.end();
}

std::vector<double> Denser(std::vector<double> grid) {
  std::ranges::sort(grid);
  std::vector<double> dense;
  for (const double value : grid) {
    if (!dense.empty() && dense.back() > 0) {
      const int parts =
          static_cast<int>(std::ceil(std::log(value / dense.back()) / std::log(kGridRatio) - 1e-9));
      const double ratio = std::pow(value / dense.back(), 1.0 / std::max(1, parts));
      for (int part = 1; part < parts; ++part) dense.push_back(dense.back() * ratio);
    }
    dense.push_back(value);
  }
  return dense;
}

std::vector<double> GridOf(const ParameterInfo& parameter, const Sizes& sizes, bool dense) {
  std::vector<double> grid;
  if (parameter.role == Role::kTime) {
    for (int k = 0; k < kTimes; ++k) {
      const double time = kShortestTime * std::pow(kTimeRatio, k);
      if (time >= kLeastTime * sizes.sample) grid.push_back(time);
    }
    return grid;
  }
  for (const double start : parameter.starts) {
    const double value = start * sizes.Of(parameter.scale);
    if (std::isfinite(value) && value > 0 && value >= parameter.min && value <= parameter.max)
      grid.push_back(value);
  }
  if (grid.empty() && parameter.min <= 0) grid.push_back(0);
  return dense ? Denser(std::move(grid)) : grid;
}

// All combinations of the parameters' grid points, as descriptions.
std::vector<EffectVariant> OnGrid(const EffectVariant& from, const model::EffectInfo& info,
                                  const Sizes& sizes) {
  size_t shapes = 0;
  for (const ParameterInfo& parameter : info.parameters) {
    const bool amount = std::ranges::find(from.amounts, parameter.name) != from.amounts.end();
    shapes += parameter.is_number() && IsFitted(info, parameter) && !amount ? 1 : 0;
  }
  std::vector<EffectVariant> variants = {from};
  for (const ParameterInfo& parameter : info.parameters) {
    if (!parameter.is_number() || !IsFitted(info, parameter)) continue;
    if (from.at.parameters.contains(parameter.name)) continue;
    const std::vector<double> grid = GridOf(parameter, sizes, shapes == 1);
    std::vector<EffectVariant> next;
    for (const EffectVariant& variant : variants) {
      for (const double value : grid) {
        next.push_back(variant);
        EffectVariant& one = next.back();
        one.at.parameters[parameter.name] = value;
        if (grid.size() > 1) {
          one.set += (one.shapes.empty() ? "|" : ",") + ShortNumber(value, 3);
          one.shapes.push_back(parameter.name);
        } else if (one.kind == EffectVariant::Kind::kWhole) {
          one.moved.push_back(parameter.name);
        }
      }
    }
    variants = std::move(next);
  }
  return variants;
}

// Opens the effect: sets its amounts to 0 and determines its kind of variant.
EffectVariant Open(const Change& change, const model::EffectInfo& info) {
  EffectVariant variant;
  variant.change = change;
  variant.at.id = change.effect;
  variant.at.names = change.names;
  variant.set = change.effect;
  for (const auto& [parameter, name] : change.names) variant.set += "(" + name + ")";
  const bool channel = std::ranges::any_of(
      info.parameters, [](const ParameterInfo& one) { return one.role == Role::kChannel; });
  for (const ParameterInfo& parameter : info.parameters) {
    if (IsWave(parameter)) variant.kind = EffectVariant::Kind::kWave;
    if (parameter.role == Role::kPhase) variant.phase = parameter.name;
    // The error of a late channel, or of what its sensor does over time, grows with the time.
    const bool time = parameter.role == Role::kTime && (channel || change.effect.starts_with("sensor."));
    if ((!IsSize(parameter) && !time) || !IsFitted(info, parameter)) continue;
    variant.amounts.push_back(parameter.name);
    variant.at.parameters[parameter.name] = 0;
    variant.is_time = time;
  }
  if (variant.kind != EffectVariant::Kind::kWave && variant.amounts.empty())
    variant.kind = EffectVariant::Kind::kWhole;
  if (variant.kind == EffectVariant::Kind::kAmounts && variant.amounts.size() == 1 &&
      !variant.phase.empty()) {
    variant.amounts.push_back(variant.phase);
    variant.at.parameters[variant.phase] = 0;
  } else {
    variant.phase.clear();
  }
  return variant;
}

}  // namespace

bool IsAmount(const ParameterInfo& parameter) { return IsSize(parameter) || IsWave(parameter); }

std::vector<EffectVariant> VariantsOf(const std::vector<Change>& changes, const Sizes& sizes) {
  std::vector<EffectVariant> variants;
  for (const Change& change : changes) {
    const model::EffectInfo* info = model::FindEffect(change.effect);
    if (info == nullptr) continue;
    const bool lists = std::ranges::any_of(
        info->parameters, [](const ParameterInfo& one) { return one.list != model::List::kNone; });
    const bool numbers =
        std::ranges::any_of(info->parameters, [](const ParameterInfo& one) { return one.is_number(); });
    if (lists || !numbers) continue;
    const EffectVariant open = Open(change, *info);
    if (open.kind == EffectVariant::Kind::kWave) {
      variants.push_back(open);
      continue;
    }
    const std::vector<EffectVariant> grid = OnGrid(open, *info, sizes);
    variants.insert(variants.end(), grid.begin(), grid.end());
  }
  return variants;
}

}  // namespace hydro::diagnose
