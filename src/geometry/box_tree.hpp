#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "geometry/box.hpp"

namespace driftmesh {

/// Boxes packed along a Hilbert curve into a tree with eight children per node (Kamel and Faloutsos, "On packing
/// R-trees", CIKM 1993). Queries are const and may run in several threads at once.
class BoxTree {
 public:
  BoxTree() = default;
  /// At most 2^31 - 1 boxes, which are copied. Answers refer to them by index.
  explicit BoxTree(const std::vector<Box>& boxes);

  /// Calls visit(index) for every box that passes enter(box), in an order that depends on the tree alone. `enter`
  /// must accept every box that contains an accepted one.
  template <class Enter, class Visit>
  void search(Enter&& enter, Visit&& visit) const {
    if (!levels_.empty()) visit_below(levels_.size() - 1, 0, levels_.back().size(), enter, visit);
  }

  /// search() for the boxes that contain p.
  template <class Visit>
  void visit_containing(const Point& p, Visit&& visit) const {
    search([&p](const Box& box) { return box.contains(p); }, visit);
  }

  /// An item near p, not always the nearest, found by following the nearest box from the top. There must be items.
  [[nodiscard]] std::int32_t beside(const Point& p) const;

  /// Calls visit(i, j), i < j, once for every two items whose boxes overlap, in an order that depends on the tree
  /// alone.
  template <class Visit>
  void visit_overlapping(Visit&& visit) const {
    if (!levels_.empty()) join_within(levels_.size() - 1, 0, levels_.back().size(), visit);
  }

  /// The item with the least squared_distance(index), the lowest index among equals; -1 for an empty tree. The function
  /// gives an item's squared distance to p, at least that of its box.
  template <class SquaredDistance>
  [[nodiscard]] std::int32_t nearest(const Point& p, SquaredDistance&& squared_distance) const {
    Nearest best;
    if (!levels_.empty()) improve_below(levels_.size() - 1, 0, levels_.back().size(), p, squared_distance, best);
    return best.item;
  }

 private:
  static constexpr std::size_t kChildren = 8;
  struct Nearest {
    double squared_distance = std::numeric_limits<double>::infinity();
    std::int32_t item = -1;
  };

  template <class Enter, class Visit>
  void visit_below(std::size_t level, std::size_t begin, std::size_t end, Enter& enter, Visit& visit) const {
    for (std::size_t i = begin; i < end; ++i) {
      if (!enter(levels_[level][i])) continue;
      if (level == 0)
        visit(items_[i]);
      else
        visit_below(level - 1, kChildren * i, children_end(level, i), enter, visit);
    }
  }

  template <class Visit>
  void join_within(std::size_t level, std::size_t begin, std::size_t end, Visit& visit) const {
    for (std::size_t i = begin; i < end; ++i) {
      if (level > 0) join_within(level - 1, kChildren * i, children_end(level, i), visit);
      for (std::size_t j = i + 1; j < end; ++j) join(level, i, j, visit);
    }
  }

  template <class Visit>
  void join(std::size_t level, std::size_t i, std::size_t j, Visit& visit) const {
    const Box &box = levels_[level][i], &other = levels_[level][j];
    if (!box.overlaps(other)) return;
    if (level == 0) {
      visit(std::min(items_[i], items_[j]), std::max(items_[i], items_[j]));
      return;
    }
    for (std::size_t k = kChildren * i; k < children_end(level, i); ++k)
      if (levels_[level - 1][k].overlaps(other))
        for (std::size_t l = kChildren * j; l < children_end(level, j); ++l) join(level - 1, k, l, visit);
  }

  template <class SquaredDistance>
  void improve_below(std::size_t level, std::size_t begin, std::size_t end, const Point& p, SquaredDistance& distance,
                     Nearest& best) const {
    struct Child {
      double squared_distance;
      std::size_t index;
    };
    std::array<Child, kChildren> children;
    std::size_t count = 0;
    for (std::size_t i = begin; i < end; ++i) {  // nearest first
      const double distance_to_box = levels_[level][i].squared_distance(p);
      std::size_t k = count++;
      for (; k > 0 && children[k - 1].squared_distance > distance_to_box; --k) children[k] = children[k - 1];
      children[k] = {distance_to_box, i};
    }
    for (std::size_t k = 0; k < count && children[k].squared_distance <= best.squared_distance; ++k) {
      const std::size_t i = children[k].index;
      if (level == 0)
        improve(items_[i], distance(items_[i]), best);
      else
        improve_below(level - 1, kChildren * i, children_end(level, i), p, distance, best);
    }
  }

  static void improve(std::int32_t item, double squared_distance, Nearest& best) {
    if (squared_distance < best.squared_distance ||
        (squared_distance == best.squared_distance && (best.item < 0 || item < best.item)))
      best = {squared_distance, item};
  }
  [[nodiscard]] std::size_t children_end(std::size_t level, std::size_t i) const {
    return std::min(kChildren * (i + 1), levels_[level - 1].size());
  }

  std::vector<std::int32_t> items_;  // in the order of the curve
  std::vector<std::vector<Box>>
      levels_;  // level 0: boxes of items_; box i of a level holds boxes 8i... of the one below
};

}  // namespace driftmesh
