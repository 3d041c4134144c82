#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <string_view>

#include "base/mix.hpp"

namespace driftmesh::testing {

/// Values in their order, to the last bit, as one number.
class ValueDigest {
 public:
  void add(std::uint64_t value) { value_ = mix(value_ + kMixStep + value); }
  void add(std::int64_t value) { add(static_cast<std::uint64_t>(value)); }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(std::span<const std::int32_t> values) {
    add(std::uint64_t{values.size()});
    for (const std::int32_t value : values) add(std::int64_t{value});
  }
  void add(std::string_view text) {
    for (const char c : text) add(std::int64_t{c});
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0;
};

}  // namespace driftmesh::testing
