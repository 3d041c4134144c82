#pragma once

#include <array>

// The predicates once more, compiled for a processor that can fuse a multiplication and an addition: with the flags of
// the project, and with contraction allowed. See predicates_contraction_test.cpp.

namespace uncontracted {
double product_difference(double a, double b, double c, double d);
double incircle_exact(const std::array<double, 8>& xy);
}  // namespace uncontracted

namespace contracted {
double product_difference(double a, double b, double c, double d);
double incircle_exact(const std::array<double, 8>& xy);
}  // namespace contracted
