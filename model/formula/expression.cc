#include "model/formula/expression.h"

#include <cctype>
#include <optional>
#include <string_view>
#include <utility>

#include "base/number_text.h"
#include "base/utf8.h"
#include "base/word_list.h"

namespace hydro::model {
namespace {

constexpr size_t kLongest = 8192;  // characters; a longer text has too many operations anyway
// No formula written by a person nests deeper, and a text that does must not exhaust the stack.
constexpr int kDeepest = 64;
constexpr size_t kLongestQuote = 60;  // bytes of a formula in a message; line and column say the rest

struct Function {
  std::string_view name;
  Operation operation;
  size_t operands;
};
constexpr Function kFunctions[] = {
    {"abs", Operation::kAbs, 1},   {"sqrt", Operation::kSqrt, 1}, {"exp", Operation::kExp, 1},
    {"log", Operation::kLog, 1},   {"sin", Operation::kSin, 1},   {"cos", Operation::kCos, 1},
    {"tanh", Operation::kTanh, 1}, {"atan", Operation::kAtan, 1}, {"min", Operation::kMin, 2},
    {"max", Operation::kMax, 2},   {"sgn", Operation::kSign, 1},  {"if", Operation::kIf, 3},
};
constexpr std::string_view kClamp = "clamp";

bool BeginsName(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

class Parser {
 public:
  explicit Parser(const std::string& text) : text_(text) {
    if (text.size() > kLongest) {
      throw FormulaError(kLongest + 1, std::to_string(text.size()) + " characters",
                         std::to_string(kLongest) + " at most; [where] gives parts of a formula names");
    }
    Advance();
  }

  Expression Whole() {
    Expression expression = Or();
    if (!token_.empty()) throw Unexpected("an operator (+ - * / ^ < > == and or), or the formula's end");
    return expression;
  }

  Statement WholeStatement() {
    Statement statement;
    if (token_.empty() || !BeginsName(token_[0])) throw Unexpected("the name of what the formula changes");
    statement.target = Take();
    static constexpr std::pair<std::string_view, Assignment> kAssignments[] = {{"=", Assignment::kSet},
                                                                               {"+=", Assignment::kAdd},
                                                                               {"-=", Assignment::kSubtract},
                                                                               {"*=", Assignment::kMultiply},
                                                                               {"/=", Assignment::kDivide}};
    for (const auto& [sign, assignment] : kAssignments) {
      if (token_ != sign) continue;
      // "x =- y" sets x, but its author means "x -= y".
      if (sign == "=" && next_ < text_.size() && (text_[next_] == '-' || text_[next_] == '+')) {
        token_ += text_[next_];
        throw Unexpected("-= or +=, or a blank between = and the sign");
      }
      statement.assignment = assignment;
      Advance();
      statement.value = Whole();
      return statement;
    }
    throw Unexpected("=, +=, -=, *= or /=");
  }

 private:
  // The next token: a number, a name with its primes, a text in quotes, an operator; empty at the end.
  void Advance() {
    while (next_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[next_])) != 0) ++next_;
    begin_ = next_;
    if (next_ < text_.size()) next_ = EndOfToken();
    token_ = text_.substr(begin_, next_ - begin_);
  }

  size_t EndOfToken() const {
    size_t end = next_ + 1;
    const char first = text_[next_];
    const auto at = [&](size_t i) { return i < text_.size() ? text_[i] : '\0'; };
    if (BeginsName(first)) {
      while (BeginsName(at(end)) || IsDigit(at(end))) ++end;
      while (at(end) == '\'') ++end;
    } else if (IsDigit(first) || (first == '.' && IsDigit(at(end)))) {
      while (IsDigit(at(end)) || at(end) == '.') ++end;
      const bool sign = at(end + 1) == '+' || at(end + 1) == '-';
      if ((at(end) == 'e' || at(end) == 'E') && IsDigit(at(end + (sign ? 2 : 1)))) {
        end += sign ? 2 : 1;
        while (IsDigit(at(end))) ++end;
      }
    } else if (first == '"') {
      while (end < text_.size() && text_[end] != '"') ++end;
      if (end < text_.size()) ++end;
    } else if (std::string_view("=<>!+-*/").find(first) != std::string_view::npos && at(end) == '=') {
      ++end;
    }
    return end;
  }

  std::string Take() {
    std::string token = std::move(token_);
    Advance();
    return token;
  }
  bool TakeIf(std::string_view token) {
    if (token_ != token) return false;
    Advance();
    return true;
  }

  FormulaError Unexpected(const std::string& allowed) const {
    return {begin_ + 1, token_.empty() ? "the end" : ShortQuote(token_), allowed};
  }

  Expression Joined(Operation operation, size_t column, std::vector<Expression> operands) const {
    return {
        .operation = operation, .number = 0, .name = {}, .operands = std::move(operands), .column = column};
  }

  Expression Or() {
    if (++depth_ > kDeepest) throw FormulaError(begin_ + 1, "brackets in brackets", "64 of them at most");
    Expression left = And();
    while (token_ == "or") left = Infix(Operation::kOr, std::move(left), &Parser::And);
    --depth_;
    return left;
  }
  Expression And() {
    Expression left = Not();
    while (token_ == "and") left = Infix(Operation::kAnd, std::move(left), &Parser::Not);
    return left;
  }
  Expression Not() {
    if (token_ != "not") return Comparison();
    const size_t column = begin_ + 1;
    if (++depth_ > kDeepest) throw FormulaError(column, "not in not", "64 of them at most");
    Advance();
    Expression negated = Joined(Operation::kNot, column, {Not()});
    --depth_;
    return negated;
  }
  Expression Comparison() {
    Expression left = Sum();
    if (token_ == "<") return Infix(Operation::kLess, std::move(left), &Parser::Sum);
    if (token_ == "<=") return Infix(Operation::kAtMost, std::move(left), &Parser::Sum);
    if (token_ == "==") return Infix(Operation::kEqual, std::move(left), &Parser::Sum);
    if (token_ == "!=") return Infix(Operation::kUnequal, std::move(left), &Parser::Sum);
    if (token_ != ">" && token_ != ">=") return left;
    Expression turned =
        Infix(token_ == ">" ? Operation::kLess : Operation::kAtMost, std::move(left), &Parser::Sum);
    std::swap(turned.operands[0], turned.operands[1]);
    return turned;
  }
  Expression Sum() {
    Expression left = Product();
    while (token_ == "+" || token_ == "-") {
      left = Infix(token_ == "+" ? Operation::kAdd : Operation::kSubtract, std::move(left), &Parser::Product);
    }
    return left;
  }
  Expression Product() {
    Expression left = Unary();
    while (token_ == "*" || token_ == "/") {
      left =
          Infix(token_ == "*" ? Operation::kMultiply : Operation::kDivide, std::move(left), &Parser::Unary);
    }
    return left;
  }
  Expression Unary() {
    const size_t column = begin_ + 1;
    if (++depth_ > kDeepest) throw FormulaError(column, "signs or powers in a row", "64 of them at most");
    Expression value;
    if (TakeIf("+")) {
      value = Unary();
    } else if (TakeIf("-")) {
      value = Joined(Operation::kNegate, column, {Unary()});
    } else {
      value = Primary();
      if (token_ == "^") value = Infix(Operation::kPower, std::move(value), &Parser::Unary);
    }
    --depth_;
    return value;
  }

  Expression Infix(Operation operation, Expression left, Expression (Parser::*right)()) {
    const size_t column = begin_ + 1;
    Advance();
    std::vector<Expression> operands;
    operands.push_back(std::move(left));
    operands.push_back((this->*right)());
    return Joined(operation, column, std::move(operands));
  }

  Expression Primary() {
    const size_t column = begin_ + 1;
    if (TakeIf("(")) {
      Expression inner = Or();
      if (!TakeIf(")")) throw Unexpected("an operator or \")\"");
      return inner;
    }
    if (token_.empty()) throw Unexpected("a number, a name or \"(\"");
    Expression leaf;
    leaf.column = column;
    if (token_[0] == '"') {
      if (token_.size() < 2 || token_.back() != '"') throw Unexpected("a text that ends with a quote");
      leaf.operation = Operation::kText;
      leaf.name = token_.substr(1, token_.size() - 2);
      Advance();
      return leaf;
    }
    if (IsDigit(token_[0]) || token_[0] == '.') {
      const std::optional<double> number = ParseNumber(token_);
      if (!number.has_value()) throw Unexpected("a number");
      leaf.number = *number;
      Advance();
      return leaf;
    }
    if (!BeginsName(token_[0])) throw Unexpected("a number, a name or \"(\"");
    leaf.operation = Operation::kName;
    leaf.name = Take();
    return token_ == "(" ? Call(leaf) : leaf;
  }

  Expression Call(const Expression& function) {
    std::vector<Expression> operands;
    Advance();
    do operands.push_back(Or());
    while (TakeIf(","));
    if (!TakeIf(")")) throw Unexpected("an operator, \",\" or \")\"");
    const auto require = [&](size_t count) {
      if (operands.size() == count) return;
      throw FormulaError(function.column, function.name + " of " + std::to_string(operands.size()),
                         function.name + " of " + std::to_string(count));
    };
    if (function.name == kClamp) {
      require(3);
      Expression raised = Joined(Operation::kMax, function.column, {operands[0], operands[1]});
      return Joined(Operation::kMin, function.column, {std::move(raised), operands[2]});
    }
    for (const Function& known : kFunctions) {
      if (function.name != known.name) continue;
      require(known.operands);
      return Joined(known.operation, function.column, std::move(operands));
    }
    std::string all;
    for (const std::string& name : FunctionNames()) all += (all.empty() ? "" : ", ") + name;
    throw FormulaError(function.column, "the unknown function " + ShortQuote(function.name),
                       all + DidYouMean(function.name, FunctionNames()));
  }

  const std::string& text_;
  size_t begin_ = 0, next_ = 0;  // of the token
  std::string token_;
  int depth_ = 0;
};

}  // namespace

Expression ParseExpression(const std::string& text) { return Parser(text).Whole(); }

Statement ParseStatement(const std::string& text) { return Parser(text).WholeStatement(); }

std::string ShortQuote(std::string_view text) {
  std::string quote = "\"" + std::string(FirstBytes(text, kLongestQuote));
  if (text.size() > kLongestQuote) quote += "...";
  for (char& c : quote) {
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0) c = ' ';
  }
  return quote + '"';
}

const std::vector<std::string>& FunctionNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Function& function : kFunctions) all.emplace_back(function.name);
    all.emplace_back(kClamp);
    return all;
  }();
  return names;
}

std::string Written(const Expression& expression) {
  if (expression.operation == Operation::kNumber) return NumberText(expression.number);
  if (expression.operation == Operation::kName) return expression.name;
  if (expression.operation == Operation::kText) return '"' + expression.name + '"';
  std::string text = std::to_string(static_cast<int>(expression.operation)) + "(";
  for (const Expression& operand : expression.operands) text += Written(operand) + ",";
  return text + ")";
}

}  // namespace hydro::model
