#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "driftmesh/error.hpp"
#include "sizing/combined_field.hpp"
#include "sizing/expression_field.hpp"
#include "support/error_text.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

std::string construction_error(const std::string& expression) {
  return error_text<InputError>([&] { ExpressionField field(expression); });
}

}  // namespace

TEST_CASE("an expression in x and y gives the edge length") {
  CHECK(ExpressionField("0.5").edge_length({3, 4}) == 0.5);
  CHECK(ExpressionField("1e-3*x").edge_length({3, 4}) == 3e-3);
  CHECK(ExpressionField("0.1 + 0.2*sqrt(x^2 + y^2)").edge_length({3, 4}) == doctest::Approx(1.1));
  CHECK(ExpressionField("hypot(x, y)").edge_length({3, 4}) == 5);
  CHECK(ExpressionField("pi*e").edge_length({0, 0}) == doctest::Approx(std::numbers::pi * std::numbers::e));
  CHECK(ExpressionField("x < 2 ? 1 : 3").edge_length({1, 0}) == 1);
  CHECK(ExpressionField("x < 2 ? 1 : 3").edge_length({2, 0}) == 3);
  CHECK(ExpressionField("x == 2 || x >= 7 ? 1 : 3").edge_length({2, 0}) == 1);
  CHECK(ExpressionField("max(min(x, y), 0.01)").edge_length({-4, 0}) == 0.01);
}

TEST_CASE("values are those of muParser") {
  const std::string terms[] = {"x^2 + (y - 0.3)^2 - x^y^2 + 2^2^x",
                               "x^-2 + x^2.5 + (x - y)^3",
                               "-x^2 + (-x)^2",
                               "sin(x) + cos(y) + tan(x)",
                               "asin(x/9) + acos(y/9) + atan(x)",
                               "sinh(x) - cosh(y) * tanh(x)",
                               "log2(y) + log10(y) + log(y) + ln(y) + exp(-x)",
                               "sqrt(x) + sign(x) + rint(y) + abs(x)",
                               "(x < y) + 2*(x <= y) + 4*(x > y) + 8*(x >= 1) + 16*(x == y) + 32*(x != y)",
                               "x > 1 && y < 2 || y > 3 ? x/y : 1/0",
                               "min(x, y, 1) + max(x, 2*y) + sum(x, y, 1) + avg(x, y, 4)",
                               "atan2(y, x) + hypot(x, y)"};
  for (const std::string& term : terms) {
    const ExpressionField own(term);
    const ExpressionField parsed("(" + term + ") + 0*asinh(1)");  // a function that is not known
    REQUIRE(own.has_bounds());
    REQUIRE_FALSE(parsed.has_bounds());
    for (int i = 0; i < 100; ++i) {
      const Point p{0.07 * i - 1, 4 - 0.05 * (i % 37)};
      const double expected = parsed.value(p), found = own.value(p);
      CAPTURE(term);
      CAPTURE(p.x);
      CAPTURE(p.y);
      CHECK((found == expected || std::isnan(found) == std::isnan(expected)));
      if (std::isfinite(expected)) CHECK(found == doctest::Approx(expected).epsilon(1e-12));
    }
  }
}

TEST_CASE("squares are products, which are the same on every machine") {
  const ExpressionField field("(x + y)^2");
  for (int i = 1; i < 1000; ++i) {
    const double x = 0.37 * i, y = 1.0 / i;
    CHECK(field.edge_length({x, y}) == (x + y) * (x + y));
  }
}

TEST_CASE("values do not depend on earlier queries") {
  const ExpressionField field("1 + x*x + y");
  const double first = field.edge_length({0.1, 0.2});
  (void)field.edge_length({7, 8});
  CHECK(field.edge_length({0.1, 0.2}) == first);
}

TEST_CASE("errors in an expression name the column and the token") {
  CHECK(mentions(construction_error("0.1 + z"), "size expression \"0.1 + z\": column 7: Unexpected token \"z\";"));
  CHECK(mentions(construction_error("2*foo(x)"), "\"foo"));
  CHECK(mentions(construction_error("sqrt(x"), "parenthesis"));
  CHECK(mentions(construction_error("x +"), "column 4: Unexpected end of expression;"));
  CHECK(mentions(construction_error("x = 2"), "column 3: a single \"=\""));
  CHECK(mentions(construction_error("1, 2"), "2 values"));
  for (const char* wrong : {"", "   ", "x y", ")", "1 2", "min()", "sqrt(1, 2)", "\"a\"", "x += 1", "0x", "\xc3\xa9"})
    CHECK_MESSAGE(construction_error(wrong) != "no error", wrong);
}

TEST_CASE("an invalid length is reported with its point") {
  const ExpressionField field("1 - x");
  const std::string message = error_text<InputError>([&] { (void)field.edge_length({1.5, 0.25}); });
  CHECK(mentions(message, "-0.5 at x = 1.5, y = 0.25"));
  CHECK(error_text<InputError>([&] { (void)field.edge_length({1, 0}); }) != "no error");
  CHECK(error_text<InputError>([] { (void)ExpressionField("sqrt(x)").edge_length({-1, 0}); }) != "no error");
  CHECK(error_text<InputError>([] { (void)ExpressionField("0/x").edge_length({0, 0}); }) != "no error");
  CHECK(ExpressionField("1/x^2").edge_length({0, 0}) == std::numeric_limits<double>::infinity());
}

TEST_CASE("a shortest length replaces values that are too small, but not NaN") {
  const ExpressionField field("x", 0.125);
  CHECK(field.edge_length({-3, 0}) == 0.125);
  CHECK(field.edge_length({0.5, 0}) == 0.5);
  CHECK_THROWS_AS((void)ExpressionField("sqrt(x)", 0.125).edge_length({-1, 0}), InputError);
}

TEST_CASE("the smallest of several fields wins, above the shortest length") {
  std::vector<std::unique_ptr<SizeField>> fields;
  fields.push_back(std::make_unique<ExpressionField>("x"));
  fields.push_back(std::make_unique<UniformField>(2.0));
  const SmallestField field(std::move(fields), 0.5);
  CHECK(field.edge_length({1, 0}) == 1);
  CHECK(field.edge_length({3, 0}) == 2);
  CHECK(field.edge_length({0.1, 0}) == 0.5);
  CHECK(SmallestField({}).edge_length({0, 0}) == std::numeric_limits<double>::infinity());
}
