#include <doctest/doctest.h>

#include <clocale>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "base/read_file.hpp"
#include "driftmesh/error.hpp"
#include "sizing/expression.hpp"
#include "sizing/expression_field.hpp"
#include "sizing/expression_table.hpp"
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

TEST_CASE("operators bind as in the table of docs/size-expressions.md") {
  const auto check = [](const std::string& expression, double expected) {
    CAPTURE(expression);
    CHECK(Expression(expression).at({2, 3}) == expected);
  };
  check("2+3*4-1", 13);
  check("10-4-3", 3);
  check("24/4/2*3", 9);
  check("2^3^2", 512);
  check("-2^2", -4);
  check("2^-2^2", 0.0625);
  check("2^-1*3", 1.5);
  check("-2*3^2", -18);
  check("6--2", 8);
  check("--x + +y", 5);
  check("1+1 < 3 && 3 > 2 || 0/0", 1);
  check("0 && 1 || 1", 1);
  check("1 || 1 && 0", 1);
  check("5 > 3 > 1", 0);
  check("1 == 1 < 2", 1);
  check("1 ? 0 ? 1 : 2 : 3", 2);
  check("0 ? 1 : x < y ? x : y", 2);
  check("x < 1 || y > 2 ? 7 : 8", 7);
  check("2 && 0.5", 1);
  check(" \t1e-3\n* 2.5E+2 + .5 + 5.", 5.75);
  check("_pi - pi + _e - e", 0);
  check("sum(1, 2, 4) + avg(1, 2, 6) + min(4, 3, 5) + max(x) + rint(-2.5) + rint(2.5)", 7 + 3 + 3 + 2 - 2 + 3);
}

TEST_CASE("what is not a number") {
  const auto is_nan = [](const std::string& expression) { return std::isnan(Expression(expression).at({-1, 0})); };
  for (const char* expression :
       {"sqrt(x)", "ln(x)", "acosh(0.5)", "atanh(2)", "y/y", "1/y - 1/y", "x^0.5", "min(y/y, 1)"})
    CHECK_MESSAGE(is_nan(expression), expression);
  CHECK(Expression("max(20, sqrt(x), 30)").at({-1, 0}) == 30);  // ignored where it is not the first
  CHECK(Expression("y/y < 1 ? 2 : 3").at({0, 0}) == 3);
  const double value = std::numeric_limits<double>::quiet_NaN();
  for (const double y : {value, -value}) {
    const std::string text = error_text<InputError>([&] { (void)ExpressionField("y").edge_length({0, y}); });
    CHECK(mentions(text, std::string("is nan at x = 0, y = nan;")));
  }
}

TEST_CASE("numbers are read alike in every locale") {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* locale : {"de_DE.UTF-8", "fr_FR.UTF-8", "C"}) {
    std::setlocale(LC_ALL, locale);  // null where it is not installed
    CHECK(Expression("1.5").at({0, 0}) == 1.5);
  }
  std::setlocale(LC_ALL, before.c_str());
}

TEST_CASE("the documentation shows the functions that there are") {
  const std::string document = read_file(DRIFTMESH_SOURCE_DIR "/docs/size-expressions.md");
  CHECK_MESSAGE(document.find(expression_functions_table()) != std::string::npos,
                "docs/size-expressions.md needs the table that driftmesh config --functions prints");
  for (const Operator& row : expression_operators())
    CHECK_MESSAGE(mentions(document, row.token == "||" ? "`\\|\\|`" : '`' + std::string(row.token) + '`'), row.token);
  for (const NamedConstant& row : expression_constants())
    CHECK_MESSAGE(mentions(document, '`' + std::string(row.name) + '`'), row.name);
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

TEST_CASE("errors in an expression name the column, what is there and what is expected") {
  const auto says = [](const std::string& expression, const std::string& error) {
    CHECK(construction_error(expression).starts_with("size expression \"" + expression + "\": " + error));
  };
  says("0.1 + z", "column 7: \"z\" is not known; it may use x, y, pi, e, ");
  says("2*sqt(x)", "column 3: \"sqt\" is not known (did you mean sqrt?); driftmesh config --functions lists");
  says("sqrt(x", "column 7: the expression ends, expected an operator, \",\" or \")\"; write for example");
  says("x +", "column 4: the expression ends, expected a number, a name or \"(\";");
  says("x = 2", "column 3: found \"=\", expected an operator; give the length alone, and compare with \"==\"");
  says("1, 2", "column 2: found \",\", expected an operator");
  says("2pi", "column 2: found \"pi\", expected an operator; products need a \"*\"");
  says("(x", "column 3: the expression ends, expected an operator or \")\"");
  says("x ? 1", "column 6: the expression ends, expected an operator or \":\"");
  says("1.2.3", "column 4: found \".3\", expected an operator");
  says("min()", "column 5: found \")\", expected a number");
  says("1 + sqrt(1, 2)", "column 5: found 2 arguments, expected sqrt(a);");
  says("atan2(1)", "column 1: found 1 argument, expected atan2(a, b);");
  says("2*sin", "column 6: the expression ends, expected \"(\" after \"sin\"");
  says("1e999", "column 1: \"1e999\" is too large or too small");
  says("\xc3\xa9*2", "column 1: found \"\xc3\xa9\", expected a number");
  says("(\xc3\xa9", "column 2: found");
  for (const char* wrong : {"", "   ", "x y", ")", "1 2", "\"a\"", "x += 1", "0x", "()", "1e", "x & y", "x < = y", "."})
    CHECK_MESSAGE(mentions(construction_error(wrong), "\": column "), wrong);
}

TEST_CASE("depth and length of an expression have limits, and there are errors beyond them") {
  const auto repeated = [](const std::string& part, int count) {
    std::string all;
    for (int i = 0; i < count; ++i) all += part;
    return all;
  };
  CHECK(Expression(repeated("(", 400) + "x" + repeated(")", 400)).at({7, 0}) == 7);
  CHECK(Expression(repeated("-", 800) + "x").at({7, 0}) == 7);
  std::string choices, sum = "x";
  for (int i = 0; i < 450; ++i) choices += "x < " + std::to_string(i) + " ? " + std::to_string(i) + " : ";
  for (int i = 0; i < 20'000; ++i) sum += "+1";
  CHECK(Expression(choices + "1000").at({300.5, 0}) == 301);
  CHECK(Expression(choices + "1000").over({{300.5, 0}, {300.5, 0}}).value == Interval{301, 301});
  CHECK(Expression(sum).at({7, 0}) == 20'007);
  for (const char* part : {"(", "-", "sin(", "2^", "x<1?2:", "1?", "1+(2*", "min(1,"})
    CHECK_MESSAGE(mentions(construction_error(repeated(part, 9000)), "it is nested too deeply"), part);
  const std::string message = construction_error(repeated("x + ", 30'000) + "x");
  CHECK(mentions(message, "it is 120001 characters long"));
  CHECK(message.size() < 500);
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
