#include "picture/plot_scale.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace driftmesh {
namespace {

std::string superscript(int exponent) {
  static const char* const kDigits[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                        "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string text;
  if (exponent < 0) text.append("\u207b");
  for (char digit : std::to_string(std::abs(exponent))) text += kDigits[digit - '0'];
  return text;
}

std::string plain_number(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

std::string power_number(double value, int digits) {
  const int exponent = static_cast<int>(std::floor(std::log10(std::fabs(value)) + 1e-12));
  const std::string mantissa = plain_number(value / std::pow(10, exponent), digits);
  std::string text;
  if (mantissa != "1") text.append(mantissa).append("\u00b7");
  return text.append("10").append(superscript(exponent));
}

// The smallest step of 1, 2 or 5 times a power of ten that is not below `raw`.
double round_step(double raw) {
  const double power = std::pow(10, std::floor(std::log10(raw)));
  for (double multiple : {1.0, 2.0, 5.0})
    if (multiple * power >= raw * (1 - 1e-9)) return multiple * power;
  return 10 * power;
}

// Labels need as many digits as distinguish neighboring ticks.
int digits_needed(double largest, double step) {
  return std::clamp(static_cast<int>(std::floor(std::log10(largest)) - std::floor(std::log10(step))) + 1, 1, 15);
}

}  // namespace

std::vector<Tick> linear_ticks(double low, double high, int wanted) {
  if (!(high > low)) return {};
  const double step = round_step((high - low) / std::max(wanted, 1));
  const double first = std::ceil(low / step - 1e-9);
  const double last = std::floor(high / step + 1e-9);
  const int digits = digits_needed(std::max(std::fabs(low), std::fabs(high)), step);
  std::vector<Tick> ticks;
  for (double i = first; i <= last && ticks.size() < 100; ++i)
    ticks.push_back({i * step, friendly_number(i * step, digits)});
  return ticks;
}

std::vector<Tick> logarithmic_ticks(double low, double high, int wanted) {
  if (!(low > 0) || !(high > low)) return {};
  const int first = static_cast<int>(std::floor(std::log10(low)));
  const int last = static_cast<int>(std::ceil(std::log10(high)));
  const double decades = std::log10(high / low);
  if (decades < 1) return linear_ticks(low, high, wanted);
  const int stride = std::max(1, static_cast<int>(std::ceil(decades / std::max(wanted, 1))));
  std::vector<Tick> ticks;
  for (int exponent = first; exponent <= last; ++exponent)
    for (double multiple : {1.0, 2.0, 5.0}) {
      if (multiple != 1 && decades > 2.5) continue;
      if (multiple == 1 && exponent % stride != 0) continue;
      const double value = multiple * std::pow(10, exponent);
      if (value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9))
        ticks.push_back({value, exponent >= -2 && exponent <= 3 ? plain_number(value, 4) : power_number(value, 3)});
    }
  return ticks;
}

std::string grouped_digits(std::size_t number) {
  const std::string digits = std::to_string(number);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

std::string friendly_number(double value, int digits) {
  const double size = std::fabs(value);
  if (value == 0) return "0";
  if (!std::isfinite(value)) return plain_number(value, digits);
  if (size < 1e-3 || size >= 1e9) return power_number(value, digits);
  const int whole_digits = static_cast<int>(std::log10(std::max(size, 1.0))) + 1;
  if (size < 1e4 || digits > whole_digits) return plain_number(value, std::max(digits, whole_digits));
  const std::string grouped = grouped_digits(std::llround(size));
  return value < 0 ? std::string("-").append(grouped) : grouped;
}

}  // namespace driftmesh
