#include "sizing/expression_compiler.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <numbers>
#include <string>
#include <utility>

namespace driftmesh {
namespace {

using Op = ExpressionOp;

/// By recursive descent, with the precedences of muParser: from ?: over ||, &&, comparisons, sums, products and signs
/// to powers, which like ?: group from the right.
class Compiler {
 public:
  Compiler(std::string_view text, const PlaneVariables& variables) : rest_(text), variables_(variables) {}

  std::optional<std::vector<ExpressionStep>> compile() {
    read_choice();
    skip_space();
    if (!known_ || !rest_.empty()) return std::nullopt;
    return std::move(steps_);
  }

 private:
  using Operators = std::initializer_list<std::pair<std::string_view, Op>>;

  void emit(Op op, const Interval& constant = {}) {
    const std::size_t operands = operands_of(op);
    if (depth_ < operands) return give_up();
    depth_ += 1 - operands;
    if (depth_ > kDeepestExpression) give_up();
    steps_.push_back({op, constant});
  }
  void emit_constant(double value) { emit(Op::kConstant, {value, value}); }
  void emit_variable(std::size_t k) { emit(Op::kVariable, {static_cast<double>(k), static_cast<double>(k)}); }
  void emit_power() {
    const ExpressionStep& exponent = steps_.back();
    if (!known_ || exponent.op != Op::kConstant || exponent.constant.low != 2) return emit(Op::kPower);
    steps_.pop_back();
    --depth_;
    emit(Op::kSquare);
  }
  void give_up() {
    known_ = false;
    rest_ = {};
  }

  void skip_space() {
    while (!rest_.empty() && std::isspace(static_cast<unsigned char>(rest_.front())) != 0) rest_.remove_prefix(1);
  }
  bool take(std::string_view token) {
    skip_space();
    if (!rest_.starts_with(token)) return false;
    rest_.remove_prefix(token.size());
    return true;
  }
  void require(std::string_view token) {
    if (!take(token)) give_up();
  }
  std::optional<Op> take_one_of(Operators operators) {
    for (const auto& [token, op] : operators)
      if (take(token)) return op;
    return std::nullopt;
  }

  void read_choice() {
    if (++nesting_ > 200) return give_up();
    read_chain(0);
    if (take("?")) {
      read_choice();
      require(":");
      read_choice();
      emit(Op::kChoose);
    }
    --nesting_;
  }

  /// Operators that group from the left, the loosest first.
  void read_chain(std::size_t level) {
    static constexpr std::size_t kLevels = 5;
    static const std::array<std::vector<std::pair<std::string_view, Op>>, kLevels> kOperators{
        {{{"||", Op::kOr}},
         {{"&&", Op::kAnd}},
         {{"<=", Op::kAtMost},
          {">=", Op::kAtLeast},
          {"==", Op::kEqual},
          {"!=", Op::kDifferent},
          {"<", Op::kLess},
          {">", Op::kGreater}},
         {{"+", Op::kAdd}, {"-", Op::kSubtract}},
         {{"*", Op::kMultiply}, {"/", Op::kDivide}}}};
    if (level == kLevels) return read_signed();
    read_chain(level + 1);
    for (bool more = known_; more;) {
      more = false;
      for (const auto& [token, op] : kOperators[level])
        if (known_ && take(token)) {
          read_chain(level + 1);
          emit(op);
          more = true;
          break;
        }
    }
  }

  void read_signed() {
    if (++nesting_ > 200) return give_up();
    if (take("-")) {
      read_signed();
      emit(Op::kNegative);
    } else if (take("+")) {
      read_signed();
    } else {
      read_primary();
      if (take("^")) {
        read_signed();
        emit_power();
      }
    }
    --nesting_;
  }

  void read_primary() {
    skip_space();
    if (take("(")) {
      read_choice();
      return require(")");
    }
    const unsigned char first = rest_.empty() ? '\0' : static_cast<unsigned char>(rest_.front());
    if (std::isdigit(first) != 0 || first == '.') return read_number();
    if (std::isalpha(first) != 0 || first == '_') return read_name();
    give_up();
  }

  void read_number() {
    const std::size_t length = std::min(rest_.find_first_not_of("0123456789."), rest_.size());
    std::string text(rest_.substr(0, length));
    if (length < rest_.size() && (rest_[length] == 'e' || rest_[length] == 'E')) {
      std::size_t end = length + 1;
      if (end < rest_.size() && (rest_[end] == '+' || rest_[end] == '-')) ++end;
      const std::size_t digits = end;
      while (end < rest_.size() && std::isdigit(static_cast<unsigned char>(rest_[end])) != 0) ++end;
      if (end > digits) text = rest_.substr(0, end);
    }
    rest_.remove_prefix(text.size());
    const Interval value = {std::strtod(text.c_str(), nullptr), std::strtod(text.c_str(), nullptr)};
    emit(Op::kConstant, value);
  }

  void read_name() {
    std::size_t length = 0;
    while (length < rest_.size() &&
           (std::isalnum(static_cast<unsigned char>(rest_[length])) != 0 || rest_[length] == '_'))
      ++length;
    const std::string_view name = rest_.substr(0, length);
    rest_.remove_prefix(length);
    if (name == "x") return emit(Op::kX);
    if (name == "y") return emit(Op::kY);
    if (name == "pi" || name == "_pi") return emit_constant(std::numbers::pi);
    if (name == "e" || name == "_e") return emit_constant(std::numbers::e);
    for (std::size_t k = 0; k < variables_.size(); ++k)
      if (name == variables_[k].name) return emit_variable(k);
    read_call(name);
  }

  /// The number of arguments.
  std::size_t read_arguments() {
    require("(");
    std::size_t count = 0;
    do {
      read_choice();
      ++count;
    } while (known_ && take(","));
    require(")");
    return count;
  }

  void read_call(std::string_view name) {
    struct Function {
      std::string_view name;
      Op op;
    };
    static constexpr std::array kFunctions{
        Function{"sin", Op::kSin},     Function{"cos", Op::kCos},     Function{"tan", Op::kTan},
        Function{"asin", Op::kAsin},   Function{"acos", Op::kAcos},   Function{"atan", Op::kAtan},
        Function{"sinh", Op::kSinh},   Function{"cosh", Op::kCosh},   Function{"tanh", Op::kTanh},
        Function{"log2", Op::kLog2},   Function{"log10", Op::kLog10}, Function{"log", Op::kLog},
        Function{"ln", Op::kLog},      Function{"exp", Op::kExp},     Function{"sqrt", Op::kSqrt},
        Function{"sign", Op::kSign},   Function{"rint", Op::kRint},   Function{"abs", Op::kAbs},
        Function{"atan2", Op::kAtan2}, Function{"hypot", Op::kHypot}};
    const std::size_t count = read_arguments();
    if (name == "min" || name == "max" || name == "sum" || name == "avg") return emit_fold(name, count);
    for (const Function& function : kFunctions)
      if (function.name == name && operands_of(function.op) == count) return emit(function.op);
    give_up();
  }

  void emit_fold(std::string_view name, std::size_t count) {
    for (std::size_t i = 1; i < count; ++i) emit(name == "min" ? Op::kMin : name == "max" ? Op::kMax : Op::kAdd);
    if (name != "avg") return;
    emit_constant(static_cast<double>(count));
    emit(Op::kDivide);
  }

  std::string_view rest_;
  const PlaneVariables& variables_;
  std::vector<ExpressionStep> steps_;
  std::size_t depth_ = 0;  // of the stack
  int nesting_ = 0;
  bool known_ = true;
};

}  // namespace

std::optional<std::vector<ExpressionStep>> compile_expression(std::string_view text, const PlaneVariables& variables) {
  return Compiler(text, variables).compile();
}

}  // namespace driftmesh
