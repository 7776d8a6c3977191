// Rows of an effect at shapes off its grid: the evidence decides on a speed, a set pressure or a lag, not the
// position of a grid point.
#include "diagnose/balances/make_rows.h"

namespace hydro::diagnose {

ScanRuns::OtherShapes ScanRuns::MakeShapeRows(size_t variant,
                                              const std::vector<model::EffectDescription>& at) const {
  ColumnSetup setup = setup_;
  setup.variants.clear();
  setup.units.clear();
  for (const model::EffectDescription& one : at) {
    setup.variants.push_back(setup_.variants[variant]);
    setup.variants.back().at = one;
  }
  const ColumnTable clean = MakeEffectColumns(&setup, motions_, base_, jobs_);
  const ColumnTable noisy = MakeEffectColumns(&setup, noisy_, noisy_base_, jobs_, &clean);
  OtherShapes shapes;
  shapes.rows.columns = clean.columns;
  Project(clean, noisy, &shapes.rows);
  shapes.units = setup.units;
  return shapes;
}

std::vector<int> ScanRuns::ColumnsOf(size_t variant) const {
  using Kind = ColumnMeaning::Kind;
  std::vector<int> columns;
  for (size_t i = 0; i < meaning_.size(); ++i) {
    const Kind kind = meaning_[i].kind;
    const bool own = kind == Kind::kEffect || kind == Kind::kWhole || kind == Kind::kMoved;
    if (own && meaning_[i].variant == variant) columns.push_back(static_cast<int>(i));
  }
  return columns;
}

void ScanRuns::SetShape(size_t variant, const model::EffectDescription& at,
                        const std::vector<double>& units) {
  setup_.variants[variant].at = at;
  const std::vector<int> columns = ColumnsOf(variant);
  for (size_t i = 0; i < columns.size(); ++i) meaning_[static_cast<size_t>(columns[i])].unit = units[i];
}

}  // namespace hydro::diagnose
