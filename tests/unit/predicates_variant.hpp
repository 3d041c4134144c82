#pragma once

#include <array>

// Copies of the predicates, compiled for a processor with fused multiply-add: with the flags of the project, and with
// contraction allowed. See predicates_contraction_test.cpp.

namespace uncontracted {
double product_difference(double a, double b, double c, double d);
double incircle_exact(const std::array<double, 8>& xy);
}  // namespace uncontracted

namespace contracted {
double product_difference(double a, double b, double c, double d);
double incircle_exact(const std::array<double, 8>& xy);
}  // namespace contracted
