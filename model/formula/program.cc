#include "model/formula/program.h"

#include <cmath>

#include "model/formula/names.h"
#include "model/terms/parameter_info.h"

namespace hydro::model {
namespace {

double Value(double x) { return x; }
double Value(const Jet& x) { return x.a; }

double Logarithm(double x) { return std::log(x); }
Jet Logarithm(const Jet& x) { return {std::log(x.a), x.v * (1 / x.a)}; }
double HyperbolicTangent(double x) { return std::tanh(x); }
Jet HyperbolicTangent(const Jet& x) {
  const double value = std::tanh(x.a);
  return {value, (1 - value * value) * x.v};
}
double ArcTangent(double x) { return std::atan(x); }
Jet ArcTangent(const Jet& x) { return {std::atan(x.a), x.v * (1 / (1 + x.a * x.a))}; }

double RaisedTo(double x, double y) { return std::pow(x, y); }
// A base of 0 has no logarithm. The derivative by the exponent is 0 there, as far as the power is.
Jet RaisedTo(const Jet& x, const Jet& y) {
  const double value = std::pow(x.a, y.a);
  const double by_exponent = x.a > 0 ? value * std::log(x.a) : 0;
  return {value, (y.a * std::pow(x.a, y.a - 1)) * x.v + by_exponent * y.v};
}

// Room for numbers without first setting them to 0: a Jet has nine of them.
template <class T>
union Place {
  Place() {}  // NOLINT(modernize-use-equals-default): a union with a member that has a constructor needs one
  T value;
};

template <class T>
T FactOf(const Terms<T>& x, Fact fact) {
  switch (fact) {
    case Fact::kDirection:
      return T(static_cast<double>(x.mode->pump));
    case Fact::kArmFree:
      return T(x.arm_free ? 1.0 : 0.0);
    case Fact::kBypass:
      return T(x.bypass ? 1.0 : 0.0);
    case Fact::kValve1Open:
      return T(x.mode->valve_1 != 0 ? 1.0 : 0.0);
    case Fact::kValve2Open:
      return T((x.bypass ? x.mode->valve_1 : x.mode->valve_2) != 0 ? 1.0 : 0.0);
    case Fact::kTemperature:
      return T(x.around.temperature);
  }
  return T(0.0);
}

template <class T>
T AtStart(const Terms<T>& x, size_t place) {
  if (place < 4) return x.waves == nullptr ? T(0.0) : x.waves[place];
  return x.returned == nullptr ? T(0.0) : *x.returned;
}

template <class T>
T Loaded(const Instruction& instruction, Access<T>& access) {
  switch (instruction.source) {
    case Source::kConstant:
      return T(instruction.constant);
    case Source::kTime:
      return access.time;
    case Source::kField:
      return FieldOf(*access.x, instruction.a);
    case Source::kBase:
      return BaseValue(const_cast<ParametersOf<T>&>(*access.base), instruction.a);  // NOLINT: it is only read
    case Source::kOwn:
      return access.own[instruction.a];
    case Source::kBaseState:
      return access.state[instruction.a];
    case Source::kOwnState:
      return access.state[access.first_state + instruction.a];
    case Source::kOwnRate:
      return access.rate[access.first_state + instruction.a];
    case Source::kSwitch:
      return T(static_cast<double>(access.mode->effects[access.first_switch + instruction.a]));
    case Source::kFact:
      return FactOf(*access.x, static_cast<Fact>(instruction.a));
    case Source::kAtStart:
      return AtStart(*access.x, instruction.a);
    case Source::kReading:
      return ReadingOf(*access.measured, instruction.a);
    case Source::kChoice:
      return T((*access.choices)[instruction.a] == instruction.b ? 1.0 : 0.0);
    case Source::kResult:
      break;
  }
  return T(0.0);
}

template <class T>
void Store(const Instruction& instruction, const T& value, Access<T>& access) {
  switch (instruction.source) {
    case Source::kField:
      FieldOf(*access.x, instruction.b) = value;
      return;
    case Source::kBaseState:
      access.new_state[instruction.b] = value;
      return;
    case Source::kOwnState:
      access.new_state[access.first_state + instruction.b] = value;
      return;
    case Source::kOwnRate:
      access.rate[access.first_state + instruction.b] = value;
      return;
    case Source::kReading:
      ReadingOf(*access.measured, instruction.b) = value;
      return;
    default:
      *access.result = value;
  }
}

template <class T>
T Operated(const Instruction& instruction, const Place<T>* places) {
  using std::abs;
  using std::cos;
  using std::exp;
  using std::sin;
  using std::sqrt;
  const T& a = places[instruction.a].value;
  const T& b = places[instruction.b].value;
  const auto truth = [](bool is) { return T(is ? 1.0 : 0.0); };
  switch (instruction.operation) {
    case Operation::kNegate:
      return -a;
    case Operation::kAdd:
      return a + b;
    case Operation::kSubtract:
      return a - b;
    case Operation::kMultiply:
      return a * b;
    case Operation::kDivide:
      return a / b;
    case Operation::kPower:
      return RaisedTo(a, b);
    case Operation::kLess:
      return truth(Value(a) < Value(b));
    case Operation::kAtMost:
      return truth(Value(a) <= Value(b));
    case Operation::kEqual:
      return truth(Value(a) == Value(b));
    case Operation::kUnequal:
      return truth(Value(a) != Value(b));
    case Operation::kAnd:
      return truth(Value(a) != 0 && Value(b) != 0);
    case Operation::kOr:
      return truth(Value(a) != 0 || Value(b) != 0);
    case Operation::kNot:
      return truth(Value(a) == 0);
    case Operation::kIf:
      return Value(a) != 0 ? b : places[instruction.c].value;
    case Operation::kAbs:
      return abs(a);
    case Operation::kSqrt:
      return sqrt(a);
    case Operation::kExp:
      return exp(a);
    case Operation::kLog:
      return Logarithm(a);
    case Operation::kSin:
      return sin(a);
    case Operation::kCos:
      return cos(a);
    case Operation::kTanh:
      return HyperbolicTangent(a);
    case Operation::kAtan:
      return ArcTangent(a);
    case Operation::kMin:
      return Value(b) < Value(a) ? b : a;
    case Operation::kMax:
      return Value(a) < Value(b) ? b : a;
    case Operation::kSign:
      return T(Value(a) > 0 ? 1.0 : (Value(a) < 0 ? -1.0 : 0.0));
    case Operation::kNumber:
    case Operation::kName:
    case Operation::kText:
      break;
  }
  return T(0.0);
}

template <class T>
void RunOn(const Program& program, Access<T>& access) {
  Place<T> places[kLargestProgram];
  size_t i = 0;
  for (const Instruction& instruction : program) {
    if (instruction.kind == Instruction::Kind::kLoad) {
      places[i].value = Loaded(instruction, access);
    } else if (instruction.kind == Instruction::Kind::kStore) {
      Store(instruction, places[instruction.a].value, access);
    } else {
      places[i].value = Operated(instruction, places);
    }
    ++i;
  }
}

}  // namespace

void Run(const Program& program, Access<double>& access) { RunOn(program, access); }
void Run(const Program& program, Access<Jet>& access) { RunOn(program, access); }

}  // namespace hydro::model
