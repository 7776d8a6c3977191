#include "model/formula/effect_formulas.h"

#include <utility>

#include "model/formula/compile.h"

namespace hydro::model {

EffectFormulas::EffectFormulas(EffectInfo info, EffectText text)
    : info_(std::move(info)), text_(std::move(text)) {
  FormulaCompiler compiler(info_, text_);
  CompileEquations(compiler);
  CompileSwitches(compiler);
  if (!text_.fixed_volume.empty()) {
    hooks_[static_cast<size_t>(Hook::kFixedVolume)] =
        compiler.Value("fixed_volume", text_.fixed_volume, Hook::kFixedVolume);
  }
  const auto power = [&](const char* key, const std::string& formula) {
    return formula.empty() ? Program()
                           : compiler.Value(std::string("power.") + key, formula, Hook::kSwitches);
  };
  stored_ = power("stored", text_.stored);
  dissipated_ = power("dissipated", text_.dissipated);
  viscous_ = power("viscous", text_.viscous);
}

void EffectFormulas::CompileEquations(FormulaCompiler& compiler) {
  const auto program = [&](Hook hook) { return &hooks_[static_cast<size_t>(hook)]; };
  // Rates come first, because an equation may replace what they depend on, such as the flow from the pump.
  for (size_t i = 0; i < text_.states.size(); ++i) {
    const StateText& state = text_.states[i];
    const std::string key = "states." + state.name;
    const Hook hook = state.is == "p_3" ? Hook::kBalances : Hook::kStates;
    if (state.is == "p_3") compiler.Append(key + ".rate", "p_3_rate = " + state.rate, hook, program(hook));
    compiler.AppendValue(key + ".rate", state.is == "p_3" ? "p_3_rate" : state.rate, hook, Source::kOwnRate,
                         i, program(hook));
    if (!state.start.empty()) {
      compiler.AppendValue(key + ".start", state.start, Hook::kStart, Source::kOwnState, i,
                           program(Hook::kStart));
    }
  }
  for (const std::string& statement : text_.equation) {
    const Hook hook = compiler.HookOf("equation", statement);
    compiler.Append("equation", statement, hook, program(hook));
  }
  for (const auto& [hook, statements] : text_.equations) {
    for (const auto& [key, known] : EquationKeys()) {
      if (known != hook) continue;
      for (const std::string& statement : statements)
        compiler.Append("equations." + key, statement, hook, program(hook));
    }
  }
}

void EffectFormulas::CompileSwitches(FormulaCompiler& compiler) {
  for (const SwitchText& one : text_.switches) {
    const std::string key = "switches." + one.name;
    SwitchPrograms programs;
    programs.margin = compiler.Value(key + ".margin", one.margin, Hook::kSwitches);
    programs.next = compiler.Value(key + ".next", one.next, Hook::kSwitches);
    if (!one.start.empty()) programs.start = compiler.Value(key + ".start", one.start, Hook::kSwitches);
    for (const std::string& statement : one.sets)
      compiler.Append(key + ".sets", statement, Hook::kSwitches, &programs.sets);
    switches_.push_back(std::move(programs));
  }
  for (size_t i = 0; i < compiler.comparisons().size(); ++i)
    switches_.push_back(compiler.ComparisonPrograms(i));
  if (switches_.size() > kMaxEffectSwitches) {
    throw EffectTextError(text_.equation.empty() ? "equations" : "equation",
                          "found " + std::to_string(switches_.size()) +
                              " switches and comparisons, allowed " + std::to_string(kMaxEffectSwitches));
  }
}

int EffectFormulas::StateThatIs(const std::string& quantity) const {
  for (size_t i = 0; i < text_.states.size(); ++i) {
    if (text_.states[i].is == quantity) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace hydro::model
