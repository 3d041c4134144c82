#include "sizing/expression_range.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <span>
#include <string_view>
#include <utility>

namespace driftmesh {

enum class ExpressionRange::Op : std::uint8_t {
  kX,  // no operands
  kY,
  kConstant,
  kVariable,  // its number is the step's constant
  kNegative,  // one
  kSquare,
  kSin,
  kCos,
  kTan,
  kAsin,
  kAcos,
  kAtan,
  kSinh,
  kCosh,
  kTanh,
  kLog2,
  kLog10,
  kLog,
  kExp,
  kSqrt,
  kSign,
  kRint,
  kAbs,
  kAdd,  // two
  kSubtract,
  kMultiply,
  kDivide,
  kPower,
  kLess,
  kAtMost,
  kGreater,
  kAtLeast,
  kEqual,
  kDifferent,
  kAnd,
  kOr,
  kMin,
  kMax,
  kAtan2,
  kHypot,
  kChoose,  // three
};

std::size_t ExpressionRange::operands_of(Op op) {
  if (op < Op::kNegative) return 0;
  if (op < Op::kAdd) return 1;
  return op < Op::kChoose ? 2 : 3;
}

/// The result of an operation on values that are numbers.
Interval ExpressionRange::apply_to_numbers(Op op, const Interval* v) {
  using namespace intervals;
  constexpr auto kReal = [](double (*f)(double)) { return f; };  // of the overloads, the one of doubles
  switch (op) {
    case Op::kNegative:
      return negative(v[0]);
    case Op::kSquare:
      return square(v[0]);
    case Op::kSin:
      return sine(v[0]);
    case Op::kCos:
      return cosine(v[0]);
    case Op::kTan:
      return tangent(v[0]);
    case Op::kAsin:
      return rising(kReal(std::asin), v[0], -1, 1);
    case Op::kAcos:
      return negative(rising([](double x) { return -std::acos(x); }, v[0], -1, 1));
    case Op::kAtan:
      return rising(kReal(std::atan), v[0]);
    case Op::kSinh:
      return rising(kReal(std::sinh), v[0]);
    case Op::kCosh:
      return rising(kReal(std::cosh), absolute(v[0]));
    case Op::kTanh:
      return rising(kReal(std::tanh), v[0]);
    case Op::kLog2:
      return rising(kReal(std::log2), v[0], 0);
    case Op::kLog10:
      return rising(kReal(std::log10), v[0], 0);
    case Op::kLog:
      return rising(kReal(std::log), v[0], 0);
    case Op::kExp:
      return rising(kReal(std::exp), v[0]);
    case Op::kSqrt:
      return rising(kReal(std::sqrt), v[0], 0);
    case Op::kSign:
      return rising([](double x) { return static_cast<double>((x > 0) - (x < 0)); }, v[0]);
    case Op::kRint:
      return rising([](double x) { return std::floor(x + 0.5); }, v[0]);
    case Op::kAbs:
      return absolute(v[0]);
    case Op::kAdd:
      return add(v[0], v[1]);
    case Op::kSubtract:
      return subtract(v[0], v[1]);
    case Op::kMultiply:
      return multiply(v[0], v[1]);
    case Op::kDivide:
      return divide(v[0], v[1]);
    case Op::kPower:
      return power(v[0], v[1]);
    case Op::kLess:
      return less(v[0], v[1]);
    case Op::kAtMost:
      return at_most(v[0], v[1]);
    case Op::kGreater:
      return less(v[1], v[0]);
    case Op::kAtLeast:
      return at_most(v[1], v[0]);
    case Op::kEqual:
      return equal(v[0], v[1]);
    case Op::kDifferent:
      return opposite(equal(v[0], v[1]));
    case Op::kAnd:
      return both(v[0], v[1]);
    case Op::kOr:
      return either(v[0], v[1]);
    case Op::kMin:
      return smaller(v[0], v[1]);
    case Op::kMax:
      return larger(v[0], v[1]);
    case Op::kAtan2:
      return angle(v[0], v[1]);
    case Op::kHypot:
      return length(v[0], v[1]);
    case Op::kChoose:
      return choose(v[0], v[1], v[2]);
    default:
      return kAll;
  }
}

Interval ExpressionRange::apply(Op op, const Interval* v) {
  Interval result = apply_to_numbers(op, v);
  if (op == Op::kChoose) return result;
  const std::span operands(v, operands_of(op));
  const auto may_be_infinite = [](const Interval& a) { return std::isinf(a.low) || std::isinf(a.high); };
  const bool of_undefined =
      std::any_of(operands.begin(), operands.end(), [](const Interval& a) { return a.undefined; });
  if (op >= Op::kLess && op <= Op::kOr) return of_undefined ? intervals::kMaybe : result;
  // An operation that may be undefined results in kAll, and infinities can become NaN in any.
  result.undefined =
      of_undefined || result == intervals::kAll || std::any_of(operands.begin(), operands.end(), may_be_infinite);
  return result;
}

const PlaneFunction& ExpressionRange::function_of(const Step& step) const {
  return *variables_[static_cast<std::size_t>(step.constant.low)].function;
}

Interval ExpressionRange::over(const Box& box) const {
  std::array<Interval, kDeepest> stack;
  std::size_t size = 0;
  for (const Step& step : steps_) {
    size -= operands_of(step.op);
    switch (step.op) {
      case Op::kX:
        stack[size] = {box.low.x, box.high.x};
        break;
      case Op::kY:
        stack[size] = {box.low.y, box.high.y};
        break;
      case Op::kConstant:
        stack[size] = step.constant;
        break;
      case Op::kVariable:
        stack[size] = function_of(step).over(box);
        break;
      default:
        stack[size] = apply(step.op, &stack[size]);
    }
    ++size;
  }
  return stack[0];
}

/// As muParser defines them: whatever is not 0 is true.
double ExpressionRange::apply(Op op, const double* v) {
  switch (op) {
    case Op::kNegative:
      return -v[0];
    case Op::kSquare:
      return v[0] * v[0];
    case Op::kSin:
      return std::sin(v[0]);
    case Op::kCos:
      return std::cos(v[0]);
    case Op::kTan:
      return std::tan(v[0]);
    case Op::kAsin:
      return std::asin(v[0]);
    case Op::kAcos:
      return std::acos(v[0]);
    case Op::kAtan:
      return std::atan(v[0]);
    case Op::kSinh:
      return std::sinh(v[0]);
    case Op::kCosh:
      return std::cosh(v[0]);
    case Op::kTanh:
      return std::tanh(v[0]);
    case Op::kLog2:
      return std::log2(v[0]);
    case Op::kLog10:
      return std::log10(v[0]);
    case Op::kLog:
      return std::log(v[0]);
    case Op::kExp:
      return std::exp(v[0]);
    case Op::kSqrt:
      return std::sqrt(v[0]);
    case Op::kSign:
      return (v[0] > 0) - (v[0] < 0);
    case Op::kRint:
      return std::floor(v[0] + 0.5);
    case Op::kAbs:
      return std::fabs(v[0]);
    case Op::kAdd:
      return v[0] + v[1];
    case Op::kSubtract:
      return v[0] - v[1];
    case Op::kMultiply:
      return v[0] * v[1];
    case Op::kDivide:
      return v[0] / v[1];
    case Op::kPower:
      return std::pow(v[0], v[1]);
    case Op::kLess:
      return v[0] < v[1];
    case Op::kAtMost:
      return v[0] <= v[1];
    case Op::kGreater:
      return v[0] > v[1];
    case Op::kAtLeast:
      return v[0] >= v[1];
    case Op::kEqual:
      return v[0] == v[1];
    case Op::kDifferent:
      return v[0] != v[1];
    case Op::kAnd:
      return v[0] != 0 && v[1] != 0;
    case Op::kOr:
      return v[0] != 0 || v[1] != 0;
    case Op::kMin:
      return std::min(v[0], v[1]);
    case Op::kMax:
      return std::max(v[0], v[1]);
    case Op::kAtan2:
      return std::atan2(v[0], v[1]);
    case Op::kHypot:
      return std::hypot(v[0], v[1]);
    case Op::kChoose:
      return v[0] != 0 ? v[1] : v[2];
    default:
      return std::numeric_limits<double>::quiet_NaN();
  }
}

double ExpressionRange::at(const Point& p) const {
  std::array<double, kDeepest> stack;
  std::size_t size = 0;
  for (const Step& step : steps_) {
    size -= operands_of(step.op);
    switch (step.op) {
      case Op::kX:
        stack[size] = p.x;
        break;
      case Op::kY:
        stack[size] = p.y;
        break;
      case Op::kConstant:
        stack[size] = step.constant.low;
        break;
      case Op::kVariable:
        stack[size] = function_of(step).at(p);
        break;
      default:
        stack[size] = apply(step.op, &stack[size]);
    }
    ++size;
  }
  return stack[0];
}

/// By recursive descent, with the precedences of muParser: from ?: over ||, &&, comparisons, sums, products and signs
/// to powers, which like ?: group from the right.
class ExpressionCompiler {
 public:
  ExpressionCompiler(std::string_view text, PlaneVariables variables) : rest_(text) {
    range_.variables_ = std::move(variables);
  }

  std::optional<ExpressionRange> compile() {
    read_choice();
    skip_space();
    if (!known_ || !rest_.empty()) return std::nullopt;
    return std::move(range_);
  }

 private:
  using Op = ExpressionRange::Op;
  using Operators = std::initializer_list<std::pair<std::string_view, Op>>;

  void emit(Op op, const Interval& constant = {}) {
    const std::size_t operands = ExpressionRange::operands_of(op);
    if (depth_ < operands) return give_up();
    depth_ += 1 - operands;
    if (depth_ > ExpressionRange::kDeepest) give_up();
    range_.steps_.push_back({op, constant});
  }
  void emit_constant(double value) { emit(Op::kConstant, {value, value}); }
  void emit_variable(std::size_t k) { emit(Op::kVariable, {static_cast<double>(k), static_cast<double>(k)}); }
  void emit_power() {
    const ExpressionRange::Step& exponent = range_.steps_.back();
    if (!known_ || exponent.op != Op::kConstant || exponent.constant.low != 2) return emit(Op::kPower);
    range_.steps_.pop_back();
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
    for (std::size_t k = 0; k < range_.variables_.size(); ++k)
      if (name == range_.variables_[k].name) return emit_variable(k);
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
      if (function.name == name && ExpressionRange::operands_of(function.op) == count) return emit(function.op);
    give_up();
  }

  void emit_fold(std::string_view name, std::size_t count) {
    for (std::size_t i = 1; i < count; ++i) emit(name == "min" ? Op::kMin : name == "max" ? Op::kMax : Op::kAdd);
    if (name != "avg") return;
    emit_constant(static_cast<double>(count));
    emit(Op::kDivide);
  }

  std::string_view rest_;
  ExpressionRange range_;
  std::size_t depth_ = 0;  // of the stack
  int nesting_ = 0;
  bool known_ = true;
};

std::optional<ExpressionRange> ExpressionRange::of(const std::string& expression, PlaneVariables variables) {
  return ExpressionCompiler(expression, std::move(variables)).compile();
}

}  // namespace driftmesh
