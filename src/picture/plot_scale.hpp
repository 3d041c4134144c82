#pragma once

#include <string>
#include <vector>

namespace driftmesh {

struct Tick {
  double value = 0;
  std::string label;
};

/// At most about `wanted` round values (1, 2 or 5 times a power of ten) from low to high.
[[nodiscard]] std::vector<Tick> linear_ticks(double low, double high, int wanted);

/// Powers of ten from low to high (every second, third, ... if there are many), with 2 and 5 times them if there are
/// few; within one decade, round values in equal steps.
[[nodiscard]] std::vector<Tick> logarithmic_ticks(double low, double high, int wanted);

/// 12345678 -> "12,345,678".
[[nodiscard]] std::string grouped_digits(std::size_t number);

/// A value in the usual notation, with up to `digits` significant digits: 0.025, 1250.5, 4,350,000; 2.5 x 10 with a
/// superscript exponent below 0.001 and from 10^9.
[[nodiscard]] std::string friendly_number(double value, int digits = 3);

}  // namespace driftmesh
