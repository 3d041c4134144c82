#include "verify/stayed.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <type_traits>
#include <utility>

#include "base/formatted.hpp"
#include "driftmesh/id_vector.hpp"

namespace driftmesh {
namespace {

constexpr std::int32_t kNotThere = -1;

using PlaceBits = std::pair<std::uint64_t, std::uint64_t>;

PlaceBits bits_at(const Point& p) {
  return {std::bit_cast<std::uint64_t>(p.x), std::bit_cast<std::uint64_t>(p.y)};
}

/// The numbers of items in the order of their keys.
template <class Key>
class Sorted {
 public:
  template <class KeyOf>
  Sorted(std::size_t count, const KeyOf& key_of) {
    items_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) items_.emplace_back(key_of(i), static_cast<std::int32_t>(i));
    std::ranges::sort(items_);
  }
  /// Calls visit for each item with the key, ascending, until it returns true.
  template <class Visit>
  void find(const Key& key, const Visit& visit) const {
    auto at = std::ranges::lower_bound(items_, key, {}, &std::pair<Key, std::int32_t>::first);
    for (; at != items_.end() && at->first == key; ++at)
      if (visit(at->second)) return;
  }

 private:
  std::vector<std::pair<Key, std::int32_t>> items_;
};

using Corners3 = std::array<std::int32_t, 3>;

Corners3 sorted_corners(Corners3 corners) {
  std::ranges::sort(corners);
  return corners;
}

std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> markers_by_ends(const Mesh& mesh) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> markers;
  for (const Mesh::Edge& edge : mesh.edges)
    markers.emplace(std::pair(std::min(edge.a, edge.b), std::max(edge.a, edge.b)), edge.marker);
  return markers;
}

class Comparison {
 public:
  Comparison(const Mesh& before, const Mesh& now, std::size_t most_examples)
      : before_(before),
        now_(now),
        most_examples_(most_examples),
        old_places_(before.points.size(), [&](std::size_t v) { return bits_at(before.points[v]); }),
        old_triangles_(before.triangles.size(), [&](std::size_t t) { return sorted_corners(before.triangles[t]); }) {}

  StayedReport run(const std::optional<NumberMap>& map) {
    if (map) {
      old_point_ = numbers("point", map->points, now_.points.size(), before_.points.size());
      old_triangle_ = numbers("triangle", map->triangles, now_.triangles.size(), before_.triangles.size());
      check_mapped_points();
      check_mapped_triangles();
    } else {
      find_points();
      find_triangles();
    }
    count(old_point_, before_.points.size(), report_.points);
    count(old_triangle_, before_.triangles.size(), report_.triangles);
    compare_labels();
    compare_edges();
    compare_data();
    return std::move(report_);
  }

 private:
  template <class... Values>
  void contradict(Pattern<std::type_identity_t<Values>...> pattern, const Values&... values) {
    ++report_.contradictions;
    if (report_.examples.size() < most_examples_) report_.examples.push_back(formatted(pattern, values...));
  }

  /// The old number of each item as a map says; entries out of range and numbers that are in use twice contradict.
  std::vector<std::int32_t> numbers(const char* kind, const std::vector<NumberMap::Entry>& entries, std::size_t count,
                                    std::size_t old_count) {
    constexpr std::int64_t kNotListed = -2;
    std::vector<std::int64_t> listed(count, kNotListed);
    for (const auto& [now, old] : entries) {
      if (now < 0 || std::cmp_greater_equal(now, count))
        contradict("the map lists {} {}, which the new mesh has not", kind, now);
      else if (old < -1 || std::cmp_greater_equal(old, old_count))
        contradict("the map gives {} {} the old number {}, which the old mesh has not", kind, now, old);
      else if (std::exchange(listed[static_cast<std::size_t>(now)], old) != kNotListed)
        contradict("the map lists {} {} twice", kind, now);
    }
    std::vector<std::int32_t> numbers(count, kNotThere);
    std::vector<bool> used(old_count, false);
    for (std::size_t i = 0; i < count; ++i) {
      const std::int64_t old = listed[i] == kNotListed ? static_cast<std::int64_t>(i) : listed[i];
      if (old < 0) continue;
      if (std::cmp_greater_equal(old, old_count)) {
        contradict("{} {} is not in the map, but the old mesh has no such number", kind, i);
      } else if (used[static_cast<std::size_t>(old)]) {
        contradict("{} {} has the old number {}, which another one has, too", kind, i, old);
      } else {
        used[static_cast<std::size_t>(old)] = true;
        numbers[i] = static_cast<std::int32_t>(old);
      }
    }
    return numbers;
  }

  [[nodiscard]] static std::vector<bool> used(const std::vector<std::int32_t>& numbers, std::size_t count) {
    std::vector<bool> used(count, false);
    for (const std::int32_t old : numbers)
      if (old >= 0) used[to_index(old)] = true;
    return used;
  }

  void check_mapped_points() {
    const std::vector<bool> in_use = used(old_point_, before_.points.size());
    for (std::size_t v = 0; v < old_point_.size(); ++v) {
      std::int32_t& old = old_point_[v];
      if (old >= 0 && bits_at(before_.points[to_index(old)]) != bits_at(now_.points[v])) {
        contradict("point {} is not where point {} of the old mesh was", v, old);
        old = kNotThere;
      } else if (old < 0) {
        old_places_.find(bits_at(now_.points[v]), [&](std::int32_t other) {
          if (in_use[to_index(other)]) return false;
          contradict("point {} is new by the map, but is where point {} of the old mesh was", v, other);
          return true;
        });
      }
    }
  }

  /// The old numbers of the corners.
  [[nodiscard]] Corners3 old_corners(std::size_t t) const {
    Corners3 corners{};
    for (std::size_t i = 0; i < 3; ++i) corners[i] = old_point_[to_index(now_.triangles[t][i])];
    return corners;
  }

  /// Where regions change, the same triangles are others.
  [[nodiscard]] bool same_region(std::size_t t, std::int32_t old) const {
    return before_.regions.empty() || now_.regions.empty() || now_.regions[t] == before_.regions[to_index(old)];
  }

  void check_mapped_triangles() {
    const std::vector<bool> in_use = used(old_triangle_, before_.triangles.size());
    for (std::size_t t = 0; t < old_triangle_.size(); ++t) {
      std::int32_t& old = old_triangle_[t];
      const Corners3 corners = old_corners(t);
      if (old >= 0 && before_.triangles[to_index(old)] != corners) {
        contradict("triangle {} has not the corners that triangle {} of the old mesh had", t, old);
        old = kNotThere;
      } else if (old < 0 && std::ranges::find(corners, kNotThere) == corners.end()) {
        old_triangles_.find(sorted_corners(corners), [&](std::int32_t other) {
          if (in_use[to_index(other)] || !same_region(t, other)) return false;
          contradict("triangle {} is new by the map, but has the corners of triangle {} of the old mesh", t, other);
          return true;
        });
      }
    }
  }

  /// By their places; of several at one, each once.
  void find_points() {
    std::vector<bool> in_use(before_.points.size(), false);
    for (std::size_t v = 0; v < now_.points.size(); ++v) {
      old_point_.push_back(kNotThere);
      old_places_.find(bits_at(now_.points[v]), [&](std::int32_t other) {
        if (in_use[to_index(other)]) return false;
        in_use[to_index(other)] = true;
        old_point_.back() = other;
        return true;
      });
    }
  }

  void find_triangles() {
    for (std::size_t t = 0; t < now_.triangles.size(); ++t) {
      old_triangle_.push_back(kNotThere);
      const Corners3 corners = old_corners(t);
      if (std::ranges::find(corners, kNotThere) != corners.end()) continue;
      old_triangles_.find(sorted_corners(corners), [&](std::int32_t other) {
        if (before_.triangles[to_index(other)] != corners) return false;
        old_triangle_.back() = other;
        return true;
      });
    }
  }

  static void count(const std::vector<std::int32_t>& numbers, std::size_t old_count, StayedReport::Count& count) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      count.stayed += numbers[i] >= 0 ? 1 : 0;
      count.numbered += std::cmp_equal(numbers[i], i) ? 1 : 0;
    }
    count.made = static_cast<std::int64_t>(numbers.size()) - count.stayed;
    count.gone = static_cast<std::int64_t>(old_count) - count.stayed;
  }

  /// Regions of triangles and markers of points.
  void compare_labels() {
    for (std::size_t t = 0; t < old_triangle_.size(); ++t)
      if (const std::int32_t old = old_triangle_[t]; old >= 0 && !same_region(t, old))
        contradict("triangle {} was in region {} and is in {}", t, before_.regions[to_index(old)], now_.regions[t]);
    at_change_.assign(now_.points.size(), false);
    for (std::size_t t = 0; t < old_triangle_.size(); ++t)
      if (old_triangle_[t] < 0)
        for (const std::int32_t v : now_.triangles[t]) at_change_[to_index(v)] = true;
    if (before_.point_markers.empty() || now_.point_markers.empty()) return;
    for (std::size_t v = 0; v < old_point_.size(); ++v)
      if (const std::int32_t old = old_point_[v];
          old >= 0 && !at_change_[v] && now_.point_markers[v] != before_.point_markers[to_index(old)])
        contradict("point {} had marker {} and has {}", v, before_.point_markers[to_index(old)], now_.point_markers[v]);
  }

  /// Along triangles that stayed.
  void compare_edges() {
    if (before_.edges.empty()) return;  // the format lists none
    const auto old_markers = markers_by_ends(before_), markers = markers_by_ends(now_);
    for (std::size_t t = 0; t < old_triangle_.size(); ++t) {
      if (old_triangle_[t] < 0) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t a = now_.triangles[t][i], b = now_.triangles[t][(i + 1) % 3];
        const std::int32_t old_a = old_point_[to_index(a)], old_b = old_point_[to_index(b)];
        const auto old = old_markers.find({std::min(old_a, old_b), std::max(old_a, old_b)});
        const auto now = markers.find({std::min(a, b), std::max(a, b)});
        if (old == old_markers.end()) continue;  // or it is listed now, as part of a new line
        if (now == markers.end())
          contradict("the edge from point {} to point {} is no longer listed", a, b);
        else if (now->second != old->second)
          contradict("the edge from point {} to point {} had marker {} and has {}", a, b, old->second, now->second);
        else
          ++report_.edges;
      }
    }
  }

  void compare_data() {
    const auto names = [](const Mesh& mesh) {
      std::vector<std::string> all = mesh.attribute_names;
      for (std::size_t k = all.size(); std::cmp_less(k, mesh.attributes_per_point); ++k)
        all.push_back("attribute" + (mesh.attributes_per_point > 1 ? std::to_string(k) : ""));
      return all;
    };
    const std::vector<std::string> old_names = names(before_), new_names = names(now_);
    std::vector<bool> differs(now_.points.size(), false);
    for (std::size_t k = 0; k < new_names.size(); ++k) {
      const auto found = std::ranges::find(old_names, new_names[k]);
      if (found == old_names.end()) {
        report_.only_in_new.push_back(new_names[k]);
        continue;
      }
      report_.data.push_back(new_names[k]);
      const auto j = static_cast<std::size_t>(found - old_names.begin());
      for (std::size_t v = 0; v < old_point_.size(); ++v) {
        if (old_point_[v] < 0) continue;
        const double now = now_.attributes[v * new_names.size() + k];
        const double old = before_.attributes[to_index(old_point_[v]) * old_names.size() + j];
        if (std::bit_cast<std::uint64_t>(now) == std::bit_cast<std::uint64_t>(old)) continue;
        if (at_change_[v])
          differs[v] = true;
        else
          contradict("'{}' at point {} was {} and is {}", new_names[k], v, old, now);
      }
    }
    for (const std::string& name : old_names)
      if (std::ranges::find(new_names, name) == new_names.end()) report_.only_in_old.push_back(name);
    report_.near_changes = std::ranges::count(differs, true);
  }

  const Mesh& before_;
  const Mesh& now_;
  std::size_t most_examples_;
  Sorted<PlaceBits> old_places_;
  Sorted<Corners3> old_triangles_;
  std::vector<std::int32_t> old_point_, old_triangle_;
  std::vector<bool> at_change_;  // points at triangles that are new
  StayedReport report_;
};

std::string list_of(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "'" : ", '") + name + "'";
  return list;
}

}  // namespace

StayedReport compare_stayed(const Mesh& before, const Mesh& now, const std::optional<NumberMap>& map,
                            std::size_t most_examples) {
  return Comparison(before, now, most_examples).run(map);
}

std::string stayed_text(const StayedReport& report, bool mapped) {
  std::string text;
  const auto add = [&](const char* what, const StayedReport::Count& count) {
    append_formatted(text, "{} {} stayed, {} of them with their numbers; {} new, {} gone\n", what, count.stayed,
                     count.numbered, count.made, count.gone);
  };
  add("same points   ", report.points);
  add("same triangles", report.triangles);
  append_formatted(text, "same edges     {} along triangles that stayed\n", report.edges);
  if (!report.data.empty())
    append_formatted(text, "same data      {}{}\n", list_of(report.data),
                     report.near_changes == 0
                         ? std::string()
                         : formatted("; other values at {} points beside new triangles", report.near_changes));
  if (!report.only_in_old.empty()) append_formatted(text, "lost data      {}\n", list_of(report.only_in_old));
  if (!report.only_in_new.empty()) append_formatted(text, "new data       {}\n", list_of(report.only_in_new));
  if (report.contradictions == 0) {
    if (mapped) text += "map            right\n";
    return text;
  }
  append_formatted(text, "contradictions {}\n", report.contradictions);
  for (const std::string& example : report.examples) text += "               " + example + "\n";
  return text;
}

}  // namespace driftmesh
