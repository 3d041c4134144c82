#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "base/formatted.hpp"

// As fmt does it, which the program uses.

using namespace driftmesh;

TEST_CASE("patterns take values of all kinds") {
  const std::string text = "text";
  CHECK(formatted("plain") == "plain");
  CHECK(formatted("{} {} {} {}", 1, text, "literal", 2.5) == "1 text literal 2.5");
  CHECK(formatted("{{{}}}", -3) == "{-3}");
  CHECK(formatted("[{:>5}] [{:<5}] [{:5}] [{:5}]", 7, 7, 7, text) == "[    7] [7    ] [    7] [text ]");
  CHECK(formatted("{:02} {:04x} {:03}", 5, 0x1Fu, -7) == "05 001f -07");
  CHECK(formatted("{:>4}{:>2}", "long text", 12345) == "long text12345");
  std::string all = "a";
  append_formatted(all, "{}", 'b' - 'a');
  CHECK(all == "a1");
  CHECK(joined(std::vector<std::string>{"a", "b", "c"}, ", ") == "a, b, c");
  CHECK(joined(std::vector<std::string>{}, ", ").empty());
}

TEST_CASE("the largest and smallest whole numbers keep their digits") {
  using Signed = std::numeric_limits<std::int64_t>;
  using Unsigned = std::numeric_limits<std::uint64_t>;
  CHECK(formatted("{} {} {}", Signed::min(), Signed::max(), Unsigned::max()) ==
        fmt::format("{} {} {}", Signed::min(), Signed::max(), Unsigned::max()));
}

TEST_CASE("numbers with fractions are those of fmt") {
  std::mt19937_64 random(20261126);
  std::uniform_real_distribution<double> mantissa(-10, 10);
  std::uniform_int_distribution<int> exponent(-320, 307);
  for (int i = 0; i < 20'000; ++i) {
    double value = mantissa(random) * std::pow(10, exponent(random) / (i % 2 == 0 ? 1 : 16));
    if (i % 5 == 0) value = std::round(value);
    CAPTURE(value);
    REQUIRE(formatted("{}", value) == fmt::format("{}", value));
    REQUIRE(formatted("{:.3g} {:.17g} {:.9g}", value, value, value) ==
            fmt::format("{:.3g} {:.17g} {:.9g}", value, value, value));
    REQUIRE(formatted("{:.4f} {:>13.2f}", value, value) == fmt::format("{:.4f} {:>13.2f}", value, value));
  }
  for (const double value :
       {0.0, -0.0, 1e15, 1e16, 123456789012345678.0, 1e-4, 1e-5, 5e-324, std::numeric_limits<double>::max(),
        std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
    CAPTURE(value);
    CHECK(formatted("{} {:.6g} {:.0f}", value, value, value) == fmt::format("{} {:.6g} {:.0f}", value, value, value));
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(formatted("{} {} {:>5.1f}", nan, -nan, -nan) == "nan nan   nan");
}
