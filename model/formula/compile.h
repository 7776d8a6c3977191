// Compiles an effect's text into programs: decides what names mean, what is known at each hook, and which
// comparisons are switches.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "model/formula/effect_text.h"
#include "model/formula/expression.h"
#include "model/formula/program.h"
#include "model/terms/parameter_info.h"

namespace hydro::model {

// The meaning of a name in a formula.
struct NameMeaning {
  Source source = Source::kConstant;
  size_t place = 0;
  double number = 0;                    // kConstant
  const Expression* formula = nullptr;  // of `where`: the name stands for this formula
  bool fixed = false;                   // it changes at events only, or never
};

// A comparison in an equation between quantities that change. The simulation locates the event at which it
// begins or ceases to hold.
struct FoundComparison {
  Expression low, high;  // it holds while low < high
};

class FormulaCompiler {
 public:
  // Checks the names that the effect adds. `info` and `text` must outlive the compiler. Throws
  // EffectTextError.
  FormulaCompiler(const EffectInfo& info, const EffectText& text);

  // Compiles a formula that acts at `hook`: a value, which it leaves in Access::result. `key` is its key in
  // the file.
  Program Value(const std::string& key, const std::string& text, Hook hook);
  // Compiles a statement and appends it to a program.
  void Append(const std::string& key, const std::string& statement, Hook hook, Program* program);
  // Compiles a value that is stored in the effect's state or its rate, and appends it.
  void AppendValue(const std::string& key, const std::string& text, Hook hook, Source to, size_t place,
                   Program* program);

  // The hook for a statement that names none: the place where the quantity that it changes becomes known.
  Hook HookOf(const std::string& key, const std::string& statement) const;

  // The comparisons found in what was compiled, in order. Their switches follow the effect's own.
  const std::vector<FoundComparison>& comparisons() const { return comparisons_; }
  // Programs for the margin and the next position of the switch of a comparison.
  SwitchPrograms ComparisonPrograms(size_t comparison);

 private:
  struct Context {
    Hook hook = Hook::kProperties;
    Program* program = nullptr;
    std::map<std::string, uint16_t> known;   // computed values, by their text; forgotten at each store
    std::set<std::string> within;            // names of `where` that are being expanded
    std::map<std::string, bool> fixed = {};  // of `where`, as far as determined
  };

  void AddWhere();
  void CheckNewName(const std::string& key, const std::string& name) const;
  NameMeaning MeaningOf(const std::string& name, size_t column, Hook hook) const;
  NameMeaning FieldMeaning(const std::string& name, size_t place, size_t column, Hook hook) const;
  std::vector<std::string> NamesAt(Hook hook) const;
  bool IsFixed(const Expression& expression, Context& context) const;

  uint16_t Emit(const Expression& expression, Context& context);
  uint16_t EmitName(const Expression& name, Context& context);
  uint16_t EmitOperation(const Expression& expression, Context& context);
  uint16_t EmitComparison(const Expression& low, const Expression& high, Context& context);
  uint16_t EmitChoice(const Expression& expression, Context& context);
  uint16_t Push(const Instruction& instruction, size_t column, Context& context);
  void PushStore(uint16_t value, Source to, size_t place, Context& context);
  void AppendStatement(const Statement& statement, Context& context);

  const EffectInfo& info_;
  const EffectText& text_;
  std::map<std::string, Expression> where_;
  std::set<std::string> scratch_;  // quantities that only effects set, and that this one sets
  std::vector<FoundComparison> comparisons_;
};

}  // namespace hydro::model
