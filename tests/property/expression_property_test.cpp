#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "driftmesh/error.hpp"
#include "property/cases.hpp"
#include "sizing/expression.hpp"
#include "sizing/water_waves.hpp"
#include "support/error_text.hpp"
#include "support/infinity.hpp"
#include "support/random.hpp"

// Random formulas as trees, evaluated by recursion here and, printed as text, by the parser and its machine: values are
// the same bit for bit, and in the intervals of all boxes around their points.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

using Values = std::vector<double>;

/// A leaf has a number, or else no operands. "?" chooses, and "neg" and "pos" are signs.
struct Tree {
  std::string name;
  std::vector<Tree> operands{};
};

double leftmost(const Values& v, bool (*replaces)(double, double)) {
  double found = v[0];
  for (const double other : v)
    if (replaces(other, found)) found = other;
  return found;
}
double total(const Values& v) {
  double sum = v[0];
  for (std::size_t i = 1; i < v.size(); ++i) sum += v[i];
  return sum;
}

const std::map<std::string, double (*)(const Values&)>& meanings() {
  using V = const Values&;
  static const std::map<std::string, double (*)(V)> all{
      {"neg", [](V v) { return -v[0]; }},
      {"pos", [](V v) { return v[0]; }},
      {"?", [](V v) { return v[0] == 0 ? v[2] : v[1]; }},
      {"||", [](V v) { return v[0] == 0 && v[1] == 0 ? 0.0 : 1.0; }},
      {"&&", [](V v) { return v[0] == 0 || v[1] == 0 ? 0.0 : 1.0; }},
      {"<", [](V v) { return v[0] < v[1] ? 1.0 : 0.0; }},
      {">", [](V v) { return v[0] > v[1] ? 1.0 : 0.0; }},
      {"<=", [](V v) { return v[0] <= v[1] ? 1.0 : 0.0; }},
      {">=", [](V v) { return v[0] >= v[1] ? 1.0 : 0.0; }},
      {"==", [](V v) { return v[0] == v[1] ? 1.0 : 0.0; }},
      {"!=", [](V v) { return v[0] == v[1] ? 0.0 : 1.0; }},
      {"+", [](V v) { return v[0] + v[1]; }},
      {"-", [](V v) { return v[0] - v[1]; }},
      {"*", [](V v) { return v[0] * v[1]; }},
      {"/", [](V v) { return v[0] / v[1]; }},
      {"^", [](V v) { return std::pow(v[0], v[1]); }},
      {"abs", [](V v) { return std::abs(v[0]); }},
      {"sign", [](V v) { return v[0] > 0   ? 1.0
                                : v[0] < 0 ? -1.0
                                           : 0.0; }},
      {"rint", [](V v) { return std::floor(v[0] + 0.5); }},
      {"sqrt", [](V v) { return std::sqrt(v[0]); }},
      {"exp", [](V v) { return std::exp(v[0]); }},
      {"ln", [](V v) { return std::log(v[0]); }},
      {"log", [](V v) { return std::log(v[0]); }},
      {"log2", [](V v) { return std::log2(v[0]); }},
      {"log10", [](V v) { return std::log10(v[0]); }},
      {"sin", [](V v) { return std::sin(v[0]); }},
      {"cos", [](V v) { return std::cos(v[0]); }},
      {"tan", [](V v) { return std::tan(v[0]); }},
      {"asin", [](V v) { return std::asin(v[0]); }},
      {"acos", [](V v) { return std::acos(v[0]); }},
      {"atan", [](V v) { return std::atan(v[0]); }},
      {"atan2", [](V v) { return std::atan2(v[0], v[1]); }},
      {"sinh", [](V v) { return std::sinh(v[0]); }},
      {"cosh", [](V v) { return std::cosh(v[0]); }},
      {"tanh", [](V v) { return std::tanh(v[0]); }},
      {"asinh", [](V v) { return std::asinh(v[0]); }},
      {"acosh", [](V v) { return std::acosh(v[0]); }},
      {"atanh", [](V v) { return std::atanh(v[0]); }},
      {"hypot", [](V v) { return std::hypot(v[0], v[1]); }},
      {"min", [](V v) { return leftmost(v, [](double a, double b) { return a < b; }); }},
      {"max", [](V v) { return leftmost(v, [](double a, double b) { return a > b; }); }},
      {"sum", total},
      {"wavelength", [](V v) { return wavelength(v[0], v[1]); }},
      {"courant",
       [](V v) {
         const double speed = std::sqrt(9.81 * (v[0] < 1 ? 1 : v[0])) + (v.size() > 3 ? v[3] : 0);
         return v[1] * speed / (v.size() > 2 ? v[2] : 0.5);
       }},
      {"avg", [](V v) { return total(v) / static_cast<double>(v.size()); }}};
  return all;
}

double number_of(const std::string& leaf) {
  if (leaf == "pi" || leaf == "_pi") return std::numbers::pi;
  if (leaf == "e" || leaf == "_e") return std::numbers::e;
  return std::stod(leaf);
}

double evaluate(const Tree& tree, const Point& p) {
  if (tree.name == "x") return p.x;
  if (tree.name == "y") return p.y;
  if (tree.operands.empty()) return number_of(tree.name);
  Values values;
  for (const Tree& operand : tree.operands) values.push_back(evaluate(operand, p));
  const Tree& last = tree.operands.back();
  if (tree.name == "^" && last.operands.empty() && values[1] == 2) return values[0] * values[0];
  return meanings().at(tree.name)(values);
}

// ---- Printing ----

constexpr int kChoice = 0, kSign = 6, kPower = 7, kPrimary = 8;

int precedence_of(const Tree& tree) {
  static const std::map<std::string, int> all{
      {"?", kChoice}, {"||", 1}, {"&&", 2}, {"<", 3}, {">", 3}, {"<=", 3},      {">=", 3},      {"==", 3},
      {"!=", 3},      {"+", 4},  {"-", 4},  {"*", 5}, {"/", 5}, {"neg", kSign}, {"pos", kSign}, {"^", kPower}};
  const auto found = all.find(tree.name);
  return found == all.end() || tree.operands.empty() ? kPrimary : found->second;
}

class Printer {
 public:
  explicit Printer(Random& random) : random_(random) {}

  /// In parentheses where it binds less than `least`, and sometimes elsewhere.
  std::string print(const Tree& tree, int least = kChoice) {
    const bool bare = precedence_of(tree) >= least && random_() % 8 != 0;
    return bare ? bare_text(tree) : blank() + "(" + bare_text(tree) + ")" + blank();
  }

 private:
  std::string blank() { return random_() % 12 == 0 ? " \t" : ""; }

  /// What stands to the right of an operator may begin with a sign.
  std::string print_right(const Tree& tree, int least) {
    return precedence_of(tree) == kSign ? print(tree) : print(tree, least);
  }
  std::string bare_text(const Tree& tree) {
    const auto& operands = tree.operands;
    const int own = precedence_of(tree);
    if (operands.empty()) return blank() + tree.name + blank();
    if (own == kSign) return (tree.name == "neg" ? "-" : "+") + print(operands[0], kSign);
    if (own == kPrimary) return call(tree);
    if (own == kChoice) return print(operands[0], 1) + "?" + print(operands[1]) + ":" + print(operands[2]);
    const bool from_right = own == kPower;
    return print(operands[0], own + (from_right ? 1 : 0)) + tree.name + blank() +
           print_right(operands[1], own + (from_right ? 0 : 1));
  }
  std::string call(const Tree& tree) {
    std::string text = tree.name + blank() + "(";
    for (const Tree& operand : tree.operands) text += (&operand == tree.operands.data() ? "" : ",") + print(operand);
    return text + ")";
  }

  Random& random_;
};

// ---- Random trees ----

std::string random_leaf(Random& random) {
  static const std::array kLeaves{"x", "y",  "x",   "y",    "x", "y", "pi", "e",     "_pi",    "_e",
                                  "2", "2.", "0.5", "1e-3", "3", "0", "1",  "1e300", "7E-200", ".25"};
  if (random() % 4 != 0) return kLeaves[random() % kLeaves.size()];
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", std::exp(uniform(random, -9, 9)));
  return text;
}

std::size_t random_count(Random& random, const std::string& name) {
  if (name == "?") return 3;
  for (const Operator& row : expression_operators())
    if (row.token == name) return 2;
  for (const Function& row : expression_functions())
    if (row.name == name)
      return row.takes == Function::Arguments::kFixed ? row.operation.operands - random() % (row.defaults.size() + 1)
                                                      : 1 + random() % 4;
  return 1;
}

Tree random_tree(Random& random, int depth) {
  if (depth == 0 || random() % 7 == 0) return {random_leaf(random)};
  auto it = meanings().begin();
  std::advance(it, random() % meanings().size());
  Tree tree{it->first};
  for (std::size_t k = random_count(random, tree.name); k > 0; --k)
    tree.operands.push_back(random_tree(random, depth - 1));
  return tree;
}

Box random_box(Random& random) {
  const Point low{uniform(random, -3, 3), uniform(random, -3, 3)};
  const double size = random() % 8 == 0 ? 0 : std::exp(uniform(random, -20, 8));
  return {low, {low.x + size, low.y + size * uniform(random, 0, 1)}};
}

Point random_point(Random& random, const Box& box) {
  const auto between = [&](double low, double high) {
    const double s = random() % 4 == 0 ? static_cast<double>(random() % 2) : uniform(random, 0, 1);
    return std::clamp(low + s * (high - low), low, high);
  };
  return {between(box.low.x, box.high.x), between(box.low.y, box.high.y)};
}

bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}
bool holds(const Interval& interval, double value) {
  return std::isnan(value) ? interval.undefined : interval.holds(value);
}

constexpr Box kEverywhere{{-kInfinity, -kInfinity}, {kInfinity, kInfinity}};

}  // namespace

TEST_CASE("every operator and function has a meaning here") {
  for (const Operator& row : expression_operators()) CHECK(meanings().contains(std::string(row.token)));
  for (const Function& row : expression_functions()) CHECK(meanings().contains(std::string(row.name)));
  CHECK(meanings().size() == expression_operators().size() + expression_functions().size() + 3);
}

TEST_CASE("values of formulas are those of their trees, and in the intervals of boxes around them") {
  Random random = seeded_generator("formulas");
  Printer printer(random);
  int numbers = 0, tight = 0, boxes = 0;
  for (std::int64_t i = 0; i < case_count(10'000); ++i) {
    const Tree tree = random_tree(random, 1 + static_cast<int>(random() % 5));
    const std::string text = printer.print(tree);
    CAPTURE(text);
    const Expression expression(text);
    const Interval everywhere = expression.over(kEverywhere).value;
    for (int k = 0; k < 3; ++k, ++boxes) {
      const Box box = random_box(random);
      const Interval range = expression.over(box).value;
      tight += range.high - range.low < 1e6;
      for (int j = 0; j < 8; ++j) {
        const Point p = random_point(random, box);
        const double expected = evaluate(tree, p);
        CAPTURE(p.x);
        CAPTURE(p.y);
        REQUIRE(same(expression.at(p), expected));
        REQUIRE(holds(range, expected));
        REQUIRE(holds(everywhere, expected));
        numbers += std::isfinite(expected);
      }
    }
  }
  CHECK(numbers > 4 * boxes);
  CHECK(2 * tight > boxes);
}

TEST_CASE("intervals of single operations on a coordinate are exact but for rounding where it is one interval") {
  Random random = seeded_generator("exact intervals");
  for (const Function& function : expression_functions()) {
    if (function.operation.operands != 1 || function.name == "tan") continue;
    const std::string text = std::string(function.name) + "(x)";
    CAPTURE(text);
    const Expression expression(text);
    for (int i = 0; i < 300; ++i) {
      const double low = uniform(random, -2, 4), high = low + uniform(random, 0, 3);
      const Interval range = expression.over({{low, 0}, {high, 0}}).value;
      if (range.undefined) {
        CHECK(
            (std::isnan(expression.at({low, 0})) || std::isnan(expression.at({high, 0})) || !std::isfinite(range.low)));
        continue;
      }
      double least = kInfinity, most = -kInfinity;
      for (int k = 0; k <= 400; ++k) {
        const double value = expression.at({std::min(low + (high - low) * k / 400, high), 0});
        least = std::min(least, value);
        most = std::max(most, value);
      }
      const double slack = 0.01 * (1 + std::fabs(least) + std::fabs(most));
      CHECK(range.low >= least - slack);
      CHECK(range.high <= most + slack);
    }
  }
}

TEST_CASE("what is no formula is refused in one line with its column") {
  Random random = seeded_generator("damaged formulas");
  Printer printer(random);
  const std::string kSymbols = "xye()+-*/^<>=!&|?:,. \t09_$\"\xc3\xa9";
  int refused = 0, taken = 0;
  for (std::int64_t i = 0; i < case_count(10'000); ++i) {
    std::string text = printer.print(random_tree(random, 3));
    for (std::uint64_t k = 1 + random() % 3; k > 0; --k) {
      const std::size_t at = random() % (text.size() + 1);
      if (random() % 2 == 0)
        text.insert(at, 1, kSymbols[random() % kSymbols.size()]);
      else
        text.erase(at, random() % 4);
    }
    CAPTURE(text);
    const std::string error = error_text([&] { (void)Expression(text).at({0.3, 0.7}); });
    ++(error == "no error" ? taken : refused);
    if (error == "no error") continue;
    const std::size_t place = error.find("\": column ");
    REQUIRE(place != std::string::npos);
    const std::size_t column = std::stoul(error.substr(place + 10));
    CHECK((1 <= column && column <= text.size() + 1));
    CHECK(error.find('\n') == std::string::npos);
  }
  CHECK(refused > taken);
  CHECK(taken > 0);
}
