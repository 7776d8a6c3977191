// The compiled formulas of an effect, which model/effects/formulas.cc runs.
#pragma once

#include <string>
#include <vector>

#include "model/formula/effect_text.h"
#include "model/formula/program.h"
#include "model/terms/parameter_info.h"

namespace hydro::model {

class EffectFormulas {
 public:
  // Throws EffectTextError.
  EffectFormulas(EffectInfo info, EffectText text);

  const EffectInfo& info() const { return info_; }
  const EffectText& text() const { return text_; }

  const Program& At(Hook hook) const { return hooks_[static_cast<size_t>(hook)]; }
  const std::vector<SwitchPrograms>& switches() const { return switches_; }
  const Program& stored() const { return stored_; }
  const Program& dissipated() const { return dissipated_; }
  const Program& viscous() const { return viscous_; }
  // The place, among the effect's states, of the state that replaces this quantity; -1: none.
  int StateThatIs(const std::string& quantity) const;

 private:
  void CompileEquations(class FormulaCompiler& compiler);
  void CompileSwitches(class FormulaCompiler& compiler);

  EffectInfo info_;
  EffectText text_;
  Program hooks_[static_cast<size_t>(Hook::kReadings) + 1];
  std::vector<SwitchPrograms> switches_;
  Program stored_, dissipated_, viscous_;
};

}  // namespace hydro::model
