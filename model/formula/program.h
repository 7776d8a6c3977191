// A formula as instructions on numbers in numbered places. The right-hand side runs it, for plain numbers and
// for numbers with derivatives.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/formula/expression.h"
#include "model/terms/measurement.h"
#include "model/terms/state.h"
#include "model/terms/terms.h"

namespace hydro::model {

// Where an instruction reads a number, or stores one.
enum class Source : uint8_t {
  kConstant,
  kTime,
  kField,      // of Terms
  kBase,       // of ParametersOf
  kOwn,        // the effect's parameter
  kBaseState,  // kMotorAngle ... of the state vector
  kOwnState,   // the effect's state
  kOwnRate,    // its rate
  kSwitch,     // the position of the effect's switch
  kFact,
  kAtStart,  // StartNames()
  kReading,  // of the measurement
  kChoice,   // 1 where the effect's parameter number `a` is its name number `b`, else 0
  kResult,   // for stores only: Access::result
};

struct Instruction {
  enum class Kind : uint8_t { kLoad, kStore, kOperate };
  Kind kind = Kind::kOperate;
  Operation operation = Operation::kNumber;
  Source source = Source::kConstant;
  uint16_t a = 0, b = 0, c = 0;  // operands, in `places`; for kLoad, kStore: `a` is the index in the source
  double constant = 0;
};

// Instruction i leaves its number in place i. A program has at most kLargestProgram instructions.
using Program = std::vector<Instruction>;
inline constexpr size_t kLargestProgram = 256;

// One switch: either the effect's own, or one from a comparison in its equation, which is 1 while the
// comparison holds.
struct SwitchPrograms {
  Program margin, next, start, sets;  // empty: none
};

// What a program reads and changes. Pointers that it does not use may be null.
template <class T>
struct Access {
  Terms<T>* x = nullptr;
  const T* own = nullptr;
  const ParametersOf<T>* base = nullptr;
  const T* state = nullptr;  // the whole vector
  T time{};
  T* rate = nullptr;       // the whole vector
  T* new_state = nullptr;  // the whole vector; stores to kOwnState and kBaseState go here
  MeasurementOf<T>* measured = nullptr;
  const Mode* mode = nullptr;
  const std::vector<int>* choices = nullptr;
  T* result = nullptr;
  int first_state = 0, first_switch = 0;
};

void Run(const Program& program, Access<double>& access);
void Run(const Program& program, Access<Jet>& access);

}  // namespace hydro::model
