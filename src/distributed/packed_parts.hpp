#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <utility>

#include "base/bytes.hpp"
#include "driftmesh/ids.hpp"

namespace driftmesh {

/// Parts of a file, which write_parts asks first for their sizes and then for their bytes. Those that fit into some
/// memory are packed once, the others twice, so that they need not be in memory together.
class PackedParts {
 public:
  static constexpr std::uint64_t kMostRoom = std::uint64_t{256} << 20;

  /// `pack`: the bytes of a part, the same each time. `room`: bytes of memory.
  PackedParts(std::function<Bytes(SubdomainId)> pack, std::uint64_t room) : pack_(std::move(pack)), room_(room) {}

  [[nodiscard]] std::uint64_t size(SubdomainId s) {
    Bytes bytes = pack_(s);
    const std::uint64_t size = bytes.size();
    if (size > room_) return size;
    room_ -= size;
    kept_.emplace(s, std::move(bytes));
    return size;
  }
  /// Once for each.
  [[nodiscard]] Bytes take(SubdomainId s) {
    const auto found = kept_.find(s);
    return found == kept_.end() ? pack_(s) : std::move(found->second);
  }

 private:
  std::function<Bytes(SubdomainId)> pack_;
  std::uint64_t room_;
  std::map<SubdomainId, Bytes> kept_;
};

}  // namespace driftmesh
