// A formula as instructions on numbers in numbered places: what runs in the right-hand side, for plain numbers and for those
// with derivatives.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/formula/expression.h"
#include "model/terms/measurement.h"
#include "model/terms/mode.h"
#include "model/terms/terms.h"

namespace hydro::model {

// Where an instruction takes a number from, or leaves one.
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
  kResult,   // only to leave a number: Access::result
};

struct Instruction {
  enum class Kind : uint8_t { kLoad, kStore, kOperate };
  Kind kind = Kind::kOperate;
  Operation operation = Operation::kNumber;
  Source source = Source::kConstant;
  uint16_t a = 0, b = 0, c = 0;  // of operands, in `places`; kLoad, kStore: `a` is which of the source
  double constant = 0;
};

// Instruction i leaves its number in place i. At most kLargestProgram.
using Program = std::vector<Instruction>;
inline constexpr size_t kLargestProgram = 256;

// One switch: the effect's own, or one that a comparison in its equation makes, which is 1 while it holds.
struct SwitchPrograms {
  Program margin, next, start, sets;  // empty: none
};

// What a program reads and changes. What it does not use may be null.
template <class T>
struct Access {
  Terms<T>* x = nullptr;
  const T* own = nullptr;
  const ParametersOf<T>* base = nullptr;
  const T* state = nullptr;  // the whole vector
  T time{};
  T* rate = nullptr;       // the whole vector
  T* new_state = nullptr;  // the whole vector, kOwnState and kBaseState are stored to
  MeasurementOf<T>* measured = nullptr;
  const Mode* mode = nullptr;
  const std::vector<int>* choices = nullptr;
  T* result = nullptr;
  int first_state = 0, first_switch = 0;
};

void Run(const Program& program, Access<double>& access);
void Run(const Program& program, Access<Jet>& access);

}  // namespace hydro::model
