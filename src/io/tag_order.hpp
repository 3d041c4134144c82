#pragma once

#include <cstdint>
#include <vector>

namespace driftmesh {

/// The indices of `tags` in the order of the tags; equal tags keep their order. Linear in the usual case
/// that the tags are consecutive numbers.
[[nodiscard]] std::vector<std::size_t> order_by_tag(const std::vector<std::uint64_t>& tags);

/// Finds the position of a tag among tags in ascending order.
class TagIndex {
 public:
  explicit TagIndex(std::vector<std::uint64_t> ascending);
  /// -1 if there is no such tag.
  [[nodiscard]] std::int32_t find(std::uint64_t tag) const {
    if (is_range_) return tag - tags_.front() < tags_.size() ? static_cast<std::int32_t>(tag - tags_.front()) : -1;
    return search(tag);
  }

 private:
  [[nodiscard]] std::int32_t search(std::uint64_t tag) const;

  std::vector<std::uint64_t> tags_;
  bool is_range_;
};

}  // namespace driftmesh
