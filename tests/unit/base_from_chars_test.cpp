#include <doctest/doctest.h>

#include <bit>
#include <charconv>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>

#include "base/from_chars.hpp"

using namespace driftmesh;

namespace {

void check_as_the_standard_library(std::string_view text) {
  CAPTURE(text);
  double expected = 7, found = 7;
  const auto by_standard = std::from_chars(text.data(), text.data() + text.size(), expected);
  const auto by_strtod = from_chars_by_strtod(text.data(), text.data() + text.size(), found);
  REQUIRE(by_strtod.ec == by_standard.ec);
  REQUIRE(by_strtod.ptr - text.data() == by_standard.ptr - text.data());
  REQUIRE(std::bit_cast<std::uint64_t>(found) == std::bit_cast<std::uint64_t>(expected));
}

}  // namespace

TEST_CASE("numbers with fractions are read by strtod as by the standard library") {
  for (const std::string_view text : {"",         "-",
                                      "+1",       " 1",
                                      "1",        "-0",
                                      "0x10",     ".",
                                      ".5",       "5.",
                                      "-.5e1",    "1e",
                                      "1e+",      "1e+x",
                                      "1E-3",     "1e5 6",
                                      "1.5.5",    "1,5",
                                      "inf",      "-INF",
                                      "infinity", "infinit",
                                      "in",       "nan",
                                      "na",       "e5",
                                      ".e5",      "0e999",
                                      "1e308",    "1e309",
                                      "-1e999",   "4.9e-324",
                                      "1e-400",   "0.00000000000000000000000000e5",
                                      "00012",    "123456789012345678901234567890",
                                      "1-2",      "--1"})
    check_as_the_standard_library(text);
}

TEST_CASE("and so are random texts") {
  std::mt19937_64 random(20);
  constexpr std::string_view kLetters = "0123456789012345678905....eE+--infantyINF x,";
  for (int i = 0; i < 20000; ++i) {
    std::string text(random() % 12, ' ');
    for (char& c : text) c = kLetters[random() % kLetters.size()];
    check_as_the_standard_library(text);
    const double number = std::bit_cast<double>(random());
    char digits[32];
    check_as_the_standard_library({digits, std::to_chars(digits, digits + sizeof digits, number).ptr});
  }
}
