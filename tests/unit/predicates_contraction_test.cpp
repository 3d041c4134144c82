// Contraction of a * b - c into one rounding must be off: exact arithmetic reasons about every rounding. A compiler
// for the baseline of x86-64 has no instruction to fuse with and would hide a missing flag, so the predicates are
// compiled here for a processor that has one (predicates_variant.cpp).
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "predicates_variant.hpp"

namespace {

/// Whether the variants can run here; prints a message if not.
bool processor_fuses() {
#if defined(__x86_64__)
  const bool fuses = __builtin_cpu_supports("fma");
#else
  const bool fuses = true;
#endif
  if (!fuses) MESSAGE("skipped: this processor has no fused multiply-add");
  return fuses;
}

/// Corners a, b, c and the point d of an incircle test, and its true sign in rational arithmetic.
struct Case {
  std::array<double, 8> xy;
  int sign;
};

// Found by running the property tests on predicates compiled with contraction: their signs came out wrong.
constexpr Case kCases[] = {
    {{-0x1.19c2281049d9ep+0, 0x1.483b75dd72bddp-1, -0x1.26489ab41cf91p+0, 0x1.4051349144469p-1, -0x1.f6e08342397fdp+0,
      -0x1.0cf03b2c46e77p-1, -0x1.ae7b0062a972ep+0, 0x1.0cdbc2027cd1dp-2},
     1},
    {{0x1.51ae485a7bde3p-1, 0x1.2daaee9366cb8p-2, 0x1.083a3b2c5f9cdp-1, 0x1.cc3ee53769d7dp-4, 0x1.4e0469341c994p-1,
      0x1.3672b88d68fa9p-2, 0x1.466163aaaa44ep-1, 0x1.44824eefae50dp-2},
     1},
    {{0x1.becdfe62f38edp-6, -0x1.77567767292b5p+1, 0x1.61663ae08f757p-3, 0x1.652ab9e5f530ap-3, 0x1.61663ae08f757p-3,
      0x1.652ab9e5f530ap-3, 0x1.fad4101b390ep-3, 0x1.c6bf7fa1b596p+0},
     0},
    {{0x1.f0ccccccccccdp+5, 0x1.f19999999999ap+5, 0x1.f333333333334p+5, 0x1.f0ccccccccccdp+5, 0x1.f333333333334p+5,
      0x1.f19999999999ap+5, 0x1.f266666666667p+5, 0x1.fp+5},
     0},
    {{0x1.201fbe5887b51p+2, 0x1.4c8af3e156ab5p+3, 0x1.53bb8ff855d4fp+3, 0x1.22923d7c2d2d8p+1, -0x1.6b892e22ecd8fp+2,
      -0x1.41910031be0c6p+3, -0x1.1bbf24719344bp+3, -0x1.ed1061ed2da7ep+2},
     1},
};

int sign(double value) {
  return (value > 0) - (value < 0);
}

}  // namespace

TEST_CASE("a product and a subtraction are rounded one after the other") {
  if (!processor_fuses()) return;
  // a * b == c * d after rounding, so the difference is 0; fused, the rounding error of c * d is left over.
  const double a = 1 + 0x1p-30, b = 1 - 0x1p-30;
  CHECK(uncontracted::product_difference(a, b, b, a) == 0);
  CHECK(std::fma(a, b, -(b * a)) != 0);
}

TEST_CASE("exact predicates are exact where contraction would have been possible") {
  if (!processor_fuses()) return;
  for (const Case& c : kCases) CHECK(sign(uncontracted::incircle_exact(c.xy)) == c.sign);
}

#ifdef DRIFTMESH_CONTRACTED_VARIANT
TEST_CASE("these tests detect contraction") {
  if (!processor_fuses()) return;
  const double a = 1 + 0x1p-30, b = 1 - 0x1p-30;
  CHECK(contracted::product_difference(a, b, b, a) != 0);
  int wrong = 0;
  for (const Case& c : kCases) wrong += sign(contracted::incircle_exact(c.xy)) != c.sign;
  CHECK(wrong > 0);
}
#endif
