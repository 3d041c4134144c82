#include "mesh/blocks.hpp"

#include <algorithm>

namespace driftmesh {
namespace {

class BlockFinder {
 public:
  BlockFinder(std::size_t points, const std::vector<std::array<std::int32_t, 2>>& edges)
      : edges_(edges), begin_(points + 2, 0), at_(2 * edges.size()), number_(points, 0), lowest_(points, 0) {
    for (const auto& edge : edges)
      for (const std::int32_t end : edge) ++begin_[end + 2];
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    for (std::size_t e = 0; e < edges.size(); ++e)
      for (const std::int32_t end : edges[e]) at_[begin_[end + 1]++] = static_cast<std::int32_t>(e);
    blocks_.of_edge.assign(edges.size(), kNone);
  }

  Blocks find() {
    for (const auto& edge : edges_)
      if (number_[edge[0]] == 0) walk_from(edge[0]);
    put_in_order();
    return std::move(blocks_);
  }

 private:
  struct Step {
    std::int32_t point;
    std::int32_t entrance;  // the edge by which it was reached; -1: none
    std::size_t next;       // place in at_
  };

  [[nodiscard]] std::int32_t other_end(std::int32_t edge, std::int32_t point) const {
    return edges_[edge][0] == point ? edges_[edge][1] : edges_[edge][0];
  }

  void enter(std::int32_t point, std::int32_t entrance) {
    number_[point] = lowest_[point] = ++count_;
    way_.push_back({point, entrance, begin_[point]});
  }

  void walk_from(std::int32_t start) {
    enter(start, -1);
    while (!way_.empty()) {
      const std::int32_t point = way_.back().point;
      if (way_.back().next == begin_[point + 1]) {
        leave();
        continue;
      }
      const std::int32_t edge = at_[way_.back().next++], to = other_end(edge, point);
      if (edge == way_.back().entrance) continue;
      if (number_[to] == 0) {
        open_.push_back(edge);
        enter(to, edge);
      } else if (number_[to] < number_[point]) {
        open_.push_back(edge);
        lowest_[point] = std::min(lowest_[point], number_[to]);
      }
    }
  }

  /// A point from which no edge leads back beyond the one before it ends a block.
  void leave() {
    const Step left = way_.back();
    way_.pop_back();
    if (way_.empty()) return;
    const std::int32_t before = way_.back().point;
    lowest_[before] = std::min(lowest_[before], lowest_[left.point]);
    if (lowest_[left.point] < number_[before]) return;
    std::int32_t edge = -1;
    do {
      edge = open_.back();
      open_.pop_back();
      blocks_.of_edge[edge] = BlockId{blocks_found_};
    } while (edge != left.entrance);
    ++blocks_found_;
  }

  void put_in_order() {
    std::vector<BlockId> number(to_index(blocks_found_), kNone);
    for (std::int32_t e = 0; e < static_cast<std::int32_t>(edges_.size()); ++e) {
      BlockId& renamed = number[to_index(blocks_.of_edge[e])];
      if (renamed == kNone) {
        renamed = blocks_.edges.next_id();
        blocks_.edges.emplace_back();
      }
      blocks_.of_edge[e] = renamed;
      blocks_.edges[renamed].push_back(e);
    }
  }

  const std::vector<std::array<std::int32_t, 2>>& edges_;
  std::vector<std::size_t> begin_;  // for each point, where its edges in at_ begin; and the end
  std::vector<std::int32_t> at_;
  std::vector<std::int32_t> number_, lowest_;  // for each point, in the order of the walk from 1; 0: not yet reached
  std::int32_t count_ = 0;
  std::vector<Step> way_;
  std::vector<std::int32_t> open_;  // edges whose block is not yet known
  std::int32_t blocks_found_ = 0;
  Blocks blocks_;
};

}  // namespace

Blocks blocks_of(std::size_t points, const std::vector<std::array<std::int32_t, 2>>& edges) {
  return BlockFinder(points, edges).find();
}

}  // namespace driftmesh
