#include "picture/plot_color.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace driftmesh {
namespace {

constexpr Rgb from_hex(unsigned hex) {
  return {(hex >> 16 & 255) / 255.0, (hex >> 8 & 255) / 255.0, (hex & 255) / 255.0};
}

double to_srgb(double linear) {
  const double v = std::clamp(linear, 0.0, 1.0);
  return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

// Bjorn Ottosson, "A perceptual color space for image processing" (2020): Oklab to linear sRGB.
Rgb from_oklab(double lightness, double a, double b) {
  const auto cube = [](double v) { return v * v * v; };
  const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
  return {to_srgb(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          to_srgb(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          to_srgb(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

Rgb from_oklch(double lightness, double chroma, double hue) {
  return from_oklab(lightness, chroma * std::cos(hue), chroma * std::sin(hue));
}

// Steps by the golden ratio keep any number of hues distinct.
double category_hue(std::size_t index) {
  return 4.3 + 2 * std::numbers::pi * 0.6180339887498949 * static_cast<double>(index);
}

Rgb mix(const Rgb& a, const Rgb& b, double share_of_b) {
  return {a.red + share_of_b * (b.red - a.red), a.green + share_of_b * (b.green - a.green),
          a.blue + share_of_b * (b.blue - a.blue)};
}

}  // namespace

Rgb viridis(double t) {
  static constexpr std::array<Rgb, 9> kColors = {from_hex(0x440154), from_hex(0x472d7b), from_hex(0x3b528b),
                                                 from_hex(0x2c728e), from_hex(0x21918c), from_hex(0x28ae80),
                                                 from_hex(0x5ec962), from_hex(0xaddc30), from_hex(0xfde725)};
  const double place = std::clamp(t, 0.0, 1.0) * (kColors.size() - 1);
  const auto index = std::min(static_cast<std::size_t>(place), kColors.size() - 2);
  return mix(kColors[index], kColors[index + 1], place - static_cast<double>(index));
}

Rgb category_color(std::size_t index) {
  return from_oklch(index % 2 == 0 ? 0.78 : 0.85, 0.085, category_hue(index));
}

Rgb category_line_color(std::size_t index) {
  return from_oklch(index % 2 == 0 ? 0.50 : 0.60, 0.13, category_hue(index));
}

}  // namespace driftmesh
