// Formulas as text: "arm_torque -= stiffness * (alpha - rest)" is read into a tree. Names keep their text;
// the compiler of the tree decides what they mean (compile.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace hydro::model {

// A formula cannot be read or compiled. The message says what was found at which column (from 1), and what is
// allowed.
class FormulaError : public std::runtime_error {
 public:
  FormulaError(size_t column, const std::string& found, const std::string& allowed)
      : std::runtime_error("found " + found + " at column " + std::to_string(column) + ", allowed " +
                           allowed) {}
};

enum class Operation : uint8_t {
  kNumber,
  kName,
  kText,  // "p1", a channel's name
  kNegate,
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kPower,
  kLess,  // a > b is read as b < a
  kAtMost,
  kEqual,
  kUnequal,
  kAnd,
  kOr,
  kNot,
  kIf,  // if(condition, then, otherwise)
  kAbs,
  kSqrt,
  kExp,
  kLog,
  kSin,
  kCos,
  kTanh,
  kAtan,
  kMin,
  kMax,
  kSign,
};

struct Expression {
  Operation operation = Operation::kNumber;
  double number = 0;
  std::string name;  // kName, kText
  std::vector<Expression> operands;
  size_t column = 1;
};

// The operations that combine a value with the target's current value: =, +=, -=, *=, /=.
enum class Assignment : uint8_t { kSet, kAdd, kSubtract, kMultiply, kDivide };

// "target operation expression".
struct Statement {
  std::string target;
  Assignment assignment = Assignment::kSet;
  Expression value;
};

// Reads sums, products, powers (^), comparisons, and, or, not, if(condition, a, b), clamp(x, low, high),
// functions and pi. Throws FormulaError.
Expression ParseExpression(const std::string& text);
Statement ParseStatement(const std::string& text);

// `text` in quotes for the one line of a message: what is long is cut, and line breaks become blanks.
std::string ShortQuote(std::string_view text);

// The names of the functions, for messages and documentation.
const std::vector<std::string>& FunctionNames();

// The expression with every operation in parentheses: equal texts have equal meaning.
std::string Written(const Expression& expression);

}  // namespace hydro::model
