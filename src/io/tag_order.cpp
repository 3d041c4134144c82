#include "io/tag_order.hpp"

#include <algorithm>
#include <numeric>

namespace driftmesh {
namespace {

constexpr std::size_t kUnset = ~std::size_t{0};

// Empty unless the tags are consecutive numbers in some order.
std::vector<std::size_t> order_of_range(const std::vector<std::uint64_t>& tags) {
  if (tags.empty()) return {};
  const auto [low, high] = std::minmax_element(tags.begin(), tags.end());
  if (*high - *low != tags.size() - 1) return {};
  std::vector<std::size_t> order(tags.size(), kUnset);
  for (std::size_t i = 0; i < tags.size(); ++i) {
    std::size_t& place = order[tags[i] - *low];
    if (place != kUnset) return {};
    place = i;
  }
  return order;
}

}  // namespace

std::vector<std::size_t> order_by_tag(const std::vector<std::uint64_t>& tags) {
  std::vector<std::size_t> order = order_of_range(tags);
  if (order.size() == tags.size()) return order;
  order.resize(tags.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return tags[i] < tags[j]; });
  return order;
}

TagIndex::TagIndex(std::vector<std::uint64_t> ascending)
    : tags_(std::move(ascending)), is_range_(!tags_.empty() && tags_.back() - tags_.front() == tags_.size() - 1) {}

std::int32_t TagIndex::search(std::uint64_t tag) const {
  const auto found = std::lower_bound(tags_.begin(), tags_.end(), tag);
  return found != tags_.end() && *found == tag ? static_cast<std::int32_t>(found - tags_.begin()) : -1;
}

}  // namespace driftmesh
