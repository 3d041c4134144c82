#include "config/costs_file.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/nearest_name.hpp"
#include "base/read_file.hpp"
#include "config/yaml_origin.hpp"

namespace driftmesh::config {
namespace {

struct Cost {
  const char* name;
  double CostModel::*member;
  const char* meaning;
};

constexpr Cost kCosts[] = {{"start", &CostModel::start, "the initial triangulation of a subdomain"},
                           {"prepared", &CostModel::prepared, "more for each of its triangles"},
                           {"point", &CostModel::point, "a point inserted by refinement"},
                           {"listed", &CostModel::listed, "a subdomain that balancing looks at"},
                           {"packed-byte", &CostModel::packed_byte, "of a subdomain that is packed or unpacked"},
                           {"asleep", &CostModel::asleep, "a triangle of a subdomain that falls asleep"},
                           {"woken", &CostModel::woken, "and of one that wakes"}};

/// Sets costs from the entries of a file.
class CostReader {
 public:
  explicit CostReader(const std::string& path) : origin_(Origin::file(path)) {}

  [[nodiscard]] CostModel read(const std::string& text) {
    const YAML::Node root = origin_.parse(text);
    if (!root.IsMap()) fail(root, "is not a list of 'name: seconds' lines");
    for (const auto& entry : root) take(entry.first, entry.second);
    return costs_;
  }

 private:
  [[noreturn]] void fail(const YAML::Node& node, const std::string& what) const {
    origin_.fail(node.Mark(), what, "driftmesh calibrate writes such files");
  }

  void take(const YAML::Node& name, const YAML::Node& value) {
    const std::string word = name.IsScalar() ? name.Scalar() : "";
    const auto* const cost = std::ranges::find(kCosts, word, [](const Cost& c) { return std::string(c.name); });
    if (cost != std::end(kCosts))
      costs_.*(cost->member) = seconds(value);
    else if (word == "planning")
      take_planning(value);
    else
      refuse(name, word, known_names());
  }

  void take_planning(const YAML::Node& table) {
    if (!table.IsMap()) fail(table, "'planning' is not a table");
    std::vector<std::string> known;
    for (const auto& [kind, unit] : costs_.planning.unit) known.push_back(kind);
    for (const auto& entry : table) {
      const std::string kind = entry.first.IsScalar() ? entry.first.Scalar() : "";
      const auto unit = costs_.planning.unit.find(kind);
      if (unit == costs_.planning.unit.end()) refuse(entry.first, "planning: " + kind, known);
      unit->second = seconds(entry.second);
    }
  }

  [[nodiscard]] double seconds(const YAML::Node& node) const {
    double value = -1;
    if (!node.IsScalar() || !YAML::convert<double>::decode(node, value) || !(value >= 0) || !std::isfinite(value))
      fail(node, "is not a number of seconds");
    return value;
  }

  [[noreturn]] void refuse(const YAML::Node& node, const std::string& word, const std::vector<std::string>& known) {
    fail(node, "unknown cost '" + word + "'; the nearest one is '" + nearest_name(word, known) + "'");
  }

  [[nodiscard]] static std::vector<std::string> known_names() {
    std::vector<std::string> names{"planning"};
    for (const Cost& cost : kCosts) names.emplace_back(cost.name);
    return names;
  }

  Origin origin_;
  CostModel costs_;
};

}  // namespace

std::string costs_text(const CostModel& costs) {
  std::string text = "# Seconds that work takes on this machine; measured by driftmesh calibrate.\n";
  const auto add = [&](const std::string& entry, double seconds, const char* meaning) {
    text += fmt::format("{:<26}# {}\n", fmt::format("{}: {:.3g}", entry, seconds), meaning);
  };
  for (const Cost& cost : kCosts) add(cost.name, costs.*(cost.member), cost.meaning);
  text += "planning:                 # a unit of each kind of effort (docs/experiments.md)\n";
  for (const auto& [kind, unit] : costs.planning.unit) text += fmt::format("  {}: {:.3g}\n", kind, unit);
  return text;
}

CostModel read_costs(const std::string& path) {
  return CostReader(path).read(read_file(path));
}

}  // namespace driftmesh::config
