#include "model/effects/formulas.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "model/effects/catalogue.h"
#include "model/terms/model_error.h"

namespace hydro::model {
namespace {

double Plain(double x) { return x; }
double Plain(const Jet& x) { return x.a; }

class FormulaEffect : public EffectOf<FormulaEffect> {
 public:
  FormulaEffect(std::shared_ptr<const EffectFormulas> formulas, const EffectDescription& description)
      : formulas_(std::move(formulas)) {
    for (const ParameterInfo& parameter : formulas_->info().parameters) {
      if (!parameter.is_name()) continue;
      const auto& names = parameter.names;
      const auto chosen = std::find(names.begin(), names.end(), description.names.at(parameter.name));
      choices_.push_back(static_cast<int>(chosen - names.begin()));
    }
  }

  int states() const override { return static_cast<int>(formulas_->text().states.size()); }
  int switches() const override { return static_cast<int>(formulas_->switches().size()); }
  bool replaces_valves() const override { return formulas_->text().replaces_valves; }
  int p_3_state() const override { return PlaceOfState("p_3"); }
  int actuator_angle_state() const override { return PlaceOfState("actuator_angle"); }
  std::vector<std::string> StateNames() const override {
    std::vector<std::string> names;
    for (const StateText& state : formulas_->text().states) names.push_back(state.name);
    return names;
  }
  void Scales(const StateSizes& of, double* scale) const override {
    for (const StateText& state : formulas_->text().states) {
      if (state.scale == "pressure")
        *scale++ = of.pressure;
      else if (state.scale == "flow")
        *scale++ = of.flow;
      else if (state.scale == "torque")
        *scale++ = of.torque;
      else if (state.scale == "arm")
        *scale++ = of.arm;
      else if (state.scale == "angle")
        *scale++ = of.angle;
      else if (state.scale == "speed")
        *scale++ = of.speed;
      else if (state.scale == "voltage")
        *scale++ = of.voltage;
      else
        *scale++ = ParseNumber(state.scale).value_or(1e-3);
    }
  }

  template <class T>
  T OwnFixedVolume(const ParametersOf<T>& base, const T* own) const {
    T volume(0.0);
    Access<T> access{.own = own, .base = &base, .choices = &choices_, .result = &volume};
    Run(formulas_->At(Hook::kFixedVolume), access);
    return volume;
  }
  template <class T>
  void OwnStart(const Terms<T>& x, T* state) const {
    RunIn(Hook::kStart, const_cast<Terms<T>&>(x), static_cast<T*>(nullptr),
          state);  // NOLINT: it is only read
  }
  template <class T>
  void OwnStartMode(const Terms<T>& x, Mode* mode) const {
    for (size_t i = 0; i < formulas_->switches().size(); ++i) {
      const Program& start = formulas_->switches()[i].start;
      if (!start.empty()) mode->effects[first_switch() + i] = Position(Evaluated(start, x, x.mode));
    }
  }
  template <class T>
  void OwnProperties(Terms<T>& x) const {
    RunIn(Hook::kProperties, x);
  }
  template <class T>
  void OwnTorquesAndFlows(Terms<T>& x) const {
    RunIn(Hook::kTorquesAndFlows, x);
  }
  template <class T>
  void OwnStates(Terms<T>& x, T* rate) const {
    RunIn(Hook::kStates, x, rate);
  }
  template <class T>
  void OwnBalances(Terms<T>& x, T* rate) const {
    RunIn(Hook::kBalances, x, rate);
  }
  template <class T>
  void OwnMargins(const Terms<T>& x, T* margin) const {
    for (size_t i = 0; i < formulas_->switches().size(); ++i) {
      margin[kFirstEffectSwitch + first_switch() + i] = Evaluated(formulas_->switches()[i].margin, x, x.mode);
    }
  }
  template <class T>
  void OwnCross(int which, const Terms<T>& x, T* state, Mode* mode) const {
    const SwitchPrograms& programs = formulas_->switches()[which];
    const Mode before = *mode;
    mode->effects[first_switch() + which] = Position(Evaluated(programs.next, x, &before));
    if (programs.sets.empty()) return;
    Access<T> access = In(const_cast<Terms<T>&>(x));  // NOLINT: it is only read
    access.mode = &before;
    access.new_state = state;
    Run(programs.sets, access);
  }
  template <class T>
  void OwnTransduce(const SenseTerms<T>& at, MeasurementOf<T>* measured) const {
    Sensed(Hook::kTransducers, at, measured);
  }
  template <class T>
  void OwnSense(const SenseTerms<T>& at, MeasurementOf<T>* measured) const {
    Sensed(Hook::kReadings, at, measured);
  }

  void AddPower(const Terms<double>& x, const double* rate, Power* power) const override {
    const auto add = [&](const Program& program, double* to) {
      if (program.empty()) return;
      double value = 0;
      Access<double> access = In(const_cast<Terms<double>&>(x));  // NOLINT: it is only read
      access.rate = const_cast<double*>(rate);                    // NOLINT: it is only read
      access.result = &value;
      Run(program, access);
      *to += value;
    };
    add(formulas_->viscous(), &power->viscous);
    add(formulas_->stored(), &power->effects_stored);
    add(formulas_->dissipated(), &power->effects_dissipated);
  }

 private:
  int PlaceOfState(const std::string& quantity) const {
    const int place = formulas_->StateThatIs(quantity);
    return place < 0 ? -1 : first_state() + place;
  }

  template <class T>
  Access<T> In(Terms<T>& x) const {
    return {.x = &x,
            .own = x.own,
            .base = x.parameters,
            .state = x.state,
            .time = T(x.time),
            .mode = x.mode,
            .choices = &choices_,
            .first_state = first_state(),
            .first_switch = first_switch()};
  }

  template <class T>
  void RunIn(Hook hook, Terms<T>& x, T* rate = nullptr, T* new_state = nullptr) const {
    const Program& program = formulas_->At(hook);
    if (program.empty()) return;
    Access<T> access = In(x);
    access.rate = rate;
    access.new_state = new_state;
    Run(program, access);
  }

  template <class T>
  T Evaluated(const Program& program, const Terms<T>& x, const Mode* mode) const {
    T value(0.0);
    Access<T> access = In(const_cast<Terms<T>&>(x));  // NOLINT: it is only read
    access.mode = mode;
    access.result = &value;
    Run(program, access);
    return value;
  }

  template <class T>
  static int8_t Position(const T& value) {
    return static_cast<int8_t>(std::lround(std::clamp(Plain(value), -100.0, 100.0)));
  }

  template <class T>
  void Sensed(Hook hook, const SenseTerms<T>& at, MeasurementOf<T>* measured) const {
    const Program& program = formulas_->At(hook);
    if (program.empty()) return;
    Access<T> access{.own = at.own,
                     .state = at.state,
                     .time = at.time,
                     .measured = measured,
                     .choices = &choices_,
                     .first_state = first_state(),
                     .first_switch = first_switch()};
    Run(program, access);
  }

  std::shared_ptr<const EffectFormulas> formulas_;
  std::vector<int> choices_;  // of the parameters that are names, which
};

}  // namespace

std::unique_ptr<Effect> MakeFormulaEffect(const EffectDescription& description) {
  const std::shared_ptr<const EffectFormulas> formulas = FormulasOf(description);
  if (formulas == nullptr) throw ModelError("effect \"" + description.id + "\" has no formulas");
  return std::make_unique<FormulaEffect>(formulas, description);
}

CatalogueEntry EntryOf(std::shared_ptr<const EffectFormulas> formulas) {
  CatalogueEntry entry{.info = formulas->info(), .make = MakeFormulaEffect};
  entry.formulas = std::move(formulas);
  return entry;
}

}  // namespace hydro::model
