#include "base/words.hpp"

#include <array>
#include <cmath>

#include "base/formatted.hpp"

namespace driftmesh {

std::string grouped(std::int64_t n) {
  std::string text = std::to_string(n);
  const std::size_t first_digit = n < 0 ? 1 : 0;
  for (std::size_t i = text.size(); i > first_digit + 3; i -= 3) text.insert(i - 3, 1, ',');
  return text;
}

std::string bytes_words(std::uint64_t bytes) {
  if (bytes < 1000) return formatted("{} B", bytes);
  constexpr std::array kUnits{"kB", "MB", "GB", "TB", "PB", "EB"};
  double value = static_cast<double>(bytes) / 1000;
  std::size_t unit = 0;
  for (; value >= 999.5; value /= 1000) ++unit;
  return formatted("{:.3g} {}", value, kUnits[unit]);
}

std::string duration_words(double seconds) {
  if (seconds < 0.0995) return formatted("{:.3f} s", seconds);
  if (seconds < 9.95) return formatted("{:.2f} s", seconds);
  if (seconds < 99.5) return formatted("{:.1f} s", seconds);
  return whole_seconds_words(std::round(seconds));
}

std::string whole_seconds_words(double seconds) {
  if (!(seconds < 1e9)) return "ages";
  const auto whole = static_cast<std::int64_t>(std::ceil(seconds));
  if (whole < 100) return formatted("{} s", whole);
  if (whole < 3600) return formatted("{} min {:02} s", whole / 60, whole % 60);
  return formatted("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

std::string estimate_words(double count) {
  if (!(count < 1e15)) return formatted("{:.2g}", count);
  const double unit = count < 1000 ? 1 : std::pow(10, std::floor(std::log10(count)) - 2);
  return grouped(std::llround(std::round(count / unit) * unit));
}

std::string rate_words(double per_second) {
  if (per_second < 999.5) return formatted("{:.0f}", per_second);
  if (per_second < 999'500) return formatted("{:.3g} thousand", per_second / 1e3);
  return formatted("{:.3g} million", per_second / 1e6);
}

}  // namespace driftmesh
