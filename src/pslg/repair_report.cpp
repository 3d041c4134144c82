#include <array>
#include <string>
#include <utility>

#include "driftmesh/repair.hpp"
#include "pslg/describe.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t kMaxWarnings = 10;

using NamedItem = std::pair<const RepairItem*, std::string>;

std::array<NamedItem, 11> items_of(const RepairReport& r) {
  const std::string close = r.snap > 0 ? length_text(r.snap) : "rounding error";
  const std::string moved = r.snap > 0 ? " (the largest move is " + length_text(r.largest_move) + ")" : "";
  return {{{&r.rounded_points, "vertices with coordinates below 7.5e-37 rounded to multiples of 1.7e-52"},
           {&r.duplicate_points, "duplicate vertices merged"},
           {&r.close_points, "vertices within " + close + " of another merged" + moved},
           {&r.zero_length_segments, "segments of length zero dropped"},
           {&r.duplicate_segments, "duplicate segments dropped"},
           {&r.points_on_segments, "segments split at a vertex on them"},
           {&r.points_close_segments, "segments bent to pass through a vertex within " + close + moved},
           {&r.crossings, "crossings of segments turned into vertices"},
           {&r.overlaps, "shared pieces of overlapping segments kept once"},
           {&r.collapsed, "pieces of rings without area left between them dropped"},
           {&r.marker_conflicts, "conflicting markers of merged segments, the first kept"}}};
}

}  // namespace

bool RepairReport::changed() const {
  for (const auto& [item, name] : items_of(*this))
    if (item->count > 0) return true;
  return false;
}

std::string RepairReport::summary() const {
  std::string text;
  for (const auto& [item, name] : items_of(*this)) {
    if (item->count == 0) continue;
    text += std::string("repaired: ") + name + ": " + std::to_string(item->count) + "\n";
    for (const std::string& example : item->examples) text += "  " + example + "\n";
    if (item->count > static_cast<std::int64_t>(item->examples.size())) text += "  ...\n";
  }
  const std::size_t listed = warnings.size() <= kMaxWarnings + 1 ? warnings.size() : kMaxWarnings;
  for (std::size_t i = 0; i < listed; ++i) text += "warning: " + warnings[i] + "\n";
  if (listed < warnings.size()) text += "and " + std::to_string(warnings.size() - listed) + " more such warnings\n";
  return text;
}

}  // namespace driftmesh
