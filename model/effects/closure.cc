// closure.pump_torque, closure.flow_1, closure.flow_2, closure.arm_torque: a smooth curve of one variable, or
// a surface over two, that is added to a balance. It represents what no effect of the catalogue explains. The
// gap finder makes it, but never looks for it as a cause.

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/effects/effect.h"
#include "model/effects/knots.h"
#include "model/terms/model_error.h"

namespace hydro::model {

namespace {

enum class Variable { kMotorSpeed, kMotorAngle, kP1, kP2, kDifference, kSum, kArmAngle, kArmSpeed, kVoltage };

// The names of the gap finder's tables of missing terms.
const std::vector<std::pair<std::string, Variable>>& Variables() {
  static const std::vector<std::pair<std::string, Variable>> variables = {
      {"motor_speed", Variable::kMotorSpeed},
      {"motor_angle", Variable::kMotorAngle},
      {"p1", Variable::kP1},
      {"p2", Variable::kP2},
      {"p2 - p1", Variable::kDifference},
      {"p1 + p2", Variable::kSum},
      {"arm_angle", Variable::kArmAngle},
      {"arm_speed", Variable::kArmSpeed},
      {"voltage", Variable::kVoltage},
  };
  return variables;
}

std::vector<std::string> VariableNames() {
  std::vector<std::string> names;
  for (const auto& [name, variable] : Variables()) names.push_back(name);
  return names;
}

Variable VariableOf(const std::string& name) {
  for (const auto& [known, variable] : Variables()) {
    if (known == name) return variable;
  }
  throw ModelError("closure: \"" + name + "\" is no variable");
}

template <class T>
T ValueIn(const Terms<T>& x, Variable variable) {
  switch (variable) {
    case Variable::kMotorSpeed:
      return x.motor_speed;
    case Variable::kMotorAngle:
      return x.motor_angle;
    case Variable::kP1:
      return x.p1;
    case Variable::kP2:
      return x.p2;
    case Variable::kDifference:
      return x.p2 - x.p1;
    case Variable::kSum:
      return x.p1 + x.p2;
    case Variable::kArmAngle:
      return x.arm_angle;
    case Variable::kArmSpeed:
      return x.arm_speed;
    case Variable::kVoltage:
      return x.voltage;
  }
  return T(0.0);
}

enum class Balance { kPumpTorque, kFlow1, kFlow2, kArmTorque };

template <Balance kBalance>
class Closure : public EffectOf<Closure<kBalance>> {
 public:
  explicit Closure(const EffectDescription& description) {
    for (const std::string& name : description.name_lists.at("against")) {
      variables_.push_back(VariableOf(name));
      knots_.emplace_back(description.lists.at(knots_.empty() ? "knots" : "knots_2"));
    }
  }

  template <class T>
  void OwnTorquesAndFlows(Terms<T>& x) const {
    const T value = Value(x);
    if constexpr (kBalance == Balance::kPumpTorque) x.load -= value;
    if constexpr (kBalance == Balance::kFlow1) x.valve_flow_1 -= value;
    if constexpr (kBalance == Balance::kFlow2) x.valve_flow_2 -= value;
    if constexpr (kBalance == Balance::kArmTorque) x.arm_torque += value;
  }

  void AddPower(const Terms<double>& x, const double* /*rate*/, Power* power) const override {
    const double value = Value(x);
    // A torque on the pump counts among the loads.
    if constexpr (kBalance == Balance::kFlow1) power->effects_dissipated -= value * (x.p1 - x.p_3);
    if constexpr (kBalance == Balance::kFlow2) power->effects_dissipated -= value * (x.p2 - x.p_3);
    if constexpr (kBalance == Balance::kArmTorque) {
      if (x.arm_free) power->effects_dissipated -= value * x.arm_speed;
    }
  }

 private:
  template <class T>
  T Value(const Terms<T>& x) const {
    const KnotWeights<T> rows = knots_[0].Around(ValueIn(x, variables_[0]));
    T value(0.0);
    if (knots_.size() == 1) {
      for (size_t i = rows.begin; i < rows.end; ++i) value += rows.weight[i] * At(x, rows, i, 1)[0];
      return value;
    }
    const KnotWeights<T> columns = knots_[1].Around(ValueIn(x, variables_[1]));
    for (size_t i = rows.begin; i < rows.end; ++i) {
      const T* row = At(x, rows, i, knots_[1].size());
      T in_row(0.0);
      for (size_t j = columns.begin; j < columns.end; ++j) {
        in_row += columns.weight[j] * row[columns.first + static_cast<std::ptrdiff_t>(j)];
      }
      value += rows.weight[i] * in_row;
    }
    return value;
  }

  template <class T>
  static const T* At(const Terms<T>& x, const KnotWeights<T>& rows, size_t i, size_t columns) {
    return x.own + (rows.first + static_cast<std::ptrdiff_t>(i)) * static_cast<std::ptrdiff_t>(columns);
  }

  std::vector<Variable> variables_;
  std::vector<Knots> knots_;
};

std::optional<ListFault> FaultOf(const EffectDescription& effect) {
  const std::vector<std::string>& against = effect.name_lists.at("against");
  if (against.empty() || against.size() > 2 || (against.size() == 2 && against[0] == against[1])) {
    return ListFault{"against", std::to_string(against.size()) + " names",
                     "one variable, or two that differ"};
  }
  const auto second = effect.lists.find("knots_2");
  if ((second != effect.lists.end()) != (against.size() == 2)) {
    return against.size() == 2
               ? ListFault{"knots_2", "nothing", "the knots of the second variable"}
               : ListFault{"knots_2", "it beside one variable", "it only where \"against\" has two"};
  }
  size_t count = effect.lists.at("knots").size();
  if (against.size() == 2) count *= second->second.size();
  const size_t values = effect.lists.at("values").size();
  if (values != count) {
    return ListFault{"values", std::to_string(values) + " values",
                     std::to_string(count) + ": one a knot" + (against.size() == 2 ? " and knot_2" : "")};
  }
  return std::nullopt;
}

template <Balance kBalance>
CatalogueEntry Entry(const std::string& balance, const std::string& summary, const std::string& equation,
                     const std::string& unit, int arm = 0) {
  return {
      .info = {.id = "closure." + balance,
               .summary = summary,
               .equation = equation,
               .confused_with = "what it stands for",
               .parameters = {{.name = "against",
                               .unit = "name",
                               .meaning = "the variables that it depends on, one or two",
                               .names = VariableNames(),
                               .list = List::kNames},
                              {.name = "knots",
                               .unit = "1",
                               .min = -kUnbounded,
                               .meaning = "values of the first variable",
                               .list = List::kPlaces},
                              {.name = "knots_2",
                               .unit = "1",
                               .min = -kUnbounded,
                               .meaning = "values of the second variable",
                               .list = List::kPlaces,
                               .optional = true},
                              {.name = "values",
                               .unit = unit,
                               .min = -kUnbounded,
                               .meaning = "at each knot; row by row for two, a row for each of the first's",
                               .arm = arm,
                               .list = List::kValues}},
               .fault = FaultOf,
               .listed = false},
      .make = [](const EffectDescription& description) -> std::unique_ptr<Effect> {
        return std::make_unique<Closure<kBalance>>(description);
      }};
}

[[maybe_unused]] const bool kClosureAdded =
    AddToCatalogue(Entry<Balance::kPumpTorque>("pump_torque",
                                               "a torque on the pump that no known effect explains",
                                               "torque on the pump + curve", "in-lbf")) &&
    AddToCatalogue(Entry<Balance::kFlow1>("flow_1", "a flow into side 1 that no known effect explains",
                                          "flow into side 1 + curve", "in^3/s")) &&
    AddToCatalogue(Entry<Balance::kFlow2>("flow_2", "a flow into side 2 that no known effect explains",
                                          "flow into side 2 + curve", "in^3/s")) &&
    AddToCatalogue(Entry<Balance::kArmTorque>("arm_torque",
                                              "a torque on the arm that no known effect explains",
                                              "arm torque + curve", "in-lbf", -1));

}  // namespace

}  // namespace hydro::model
