#include "app/validators.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <cstdint>
#include <string_view>

namespace driftmesh::app {
namespace {

/// The power of a thousand that a unit stands for, or -1.
int power_of(std::string_view unit) {
  if (unit.ends_with('B') || unit.ends_with('b')) unit.remove_suffix(1);
  if (unit.size() == 2 && unit[1] == 'i') unit.remove_suffix(1);
  if (unit.empty()) return 0;
  const std::size_t power =
      std::string_view("kmgt").find(static_cast<char>(std::tolower(static_cast<unsigned char>(unit[0]))));
  return unit.size() == 1 && power != std::string_view::npos ? static_cast<int>(power) + 1 : -1;
}

}  // namespace

CLI::Validator positive() {
  return {[](const std::string& text) -> std::string {
            double value = 0;
            if (CLI::detail::lexical_cast(text, value) && value > 0 && std::isfinite(value)) return {};
            return "'" + text + "' is not a positive number";
          },
          ""};
}

CLI::Validator size_value(double thousand, double largest) {
  return {[thousand, largest](std::string& text) -> std::string {
            const std::size_t unit = std::min(text.size(), text.find_first_not_of("0123456789.+-eE"));
            const int power = power_of(std::string_view(text).substr(unit));
            double value = 0;
            if (power < 0 || !CLI::detail::lexical_cast(text.substr(0, unit), value))
              return "'" + text + "' is not a number with a unit k, M, G or T, or none";
            value = std::round(value * std::pow(thousand, power));
            if (!(value >= 1 && value <= largest))
              return fmt::format("'{}' is not between 1 and {:.0f}", text, largest);
            text = fmt::format("{}", static_cast<std::int64_t>(value));
            return {};
          },
          ""};
}

}  // namespace driftmesh::app
