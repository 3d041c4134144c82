#pragma once

#include <cstdint>
#include <random>

#include "protocol/codec.hpp"

namespace driftmesh::protocol::testing {

inline constexpr WireLimits kLimits{.ranks = 7, .subdomains = 100, .roots = 1000};

/// Messages of every type, with numbers over their whole range.
class RandomMessage {
 public:
  explicit RandomMessage(std::uint64_t seed) : random_(seed) {}

  Message any() { return of_type(below(std::variant_size_v<Message>)); }

  Message of_type(std::uint64_t type) {
    switch (type) {
      case 0: {
        SplitBatch batch;
        for (auto n = below(5); n > 0; --n) batch.groups.push_back(group());
        return batch;
      }
      case 1:
        return HandOff{subdomain(), epoch(), bytes()};
      case 2:
        return LocationUpdate{subdomain(), rank(), epoch()};
      case 3:
        return Token{random_(), static_cast<std::int64_t>(random_()), below(2) == 1};
      case 4:
        return Terminate{random_(), static_cast<std::int64_t>(random_()), static_cast<std::int64_t>(random_())};
      case 5:
        return Finish{};
      case 6:
        return Abandon{};
      default:
        return Advice{static_cast<std::uint8_t>(below(256 - std::variant_size_v<Message> + 1)), bytes()};
    }
  }

 private:
  std::uint64_t below(std::uint64_t n) { return random_() % n; }
  Rank rank() { return static_cast<Rank>(below(static_cast<std::uint64_t>(kLimits.ranks))); }
  SubdomainId subdomain() { return static_cast<SubdomainId>(below(static_cast<std::uint64_t>(kLimits.subdomains))); }
  Epoch epoch() { return static_cast<Epoch>(random_()); }
  Bytes bytes() {
    Bytes result(below(50));
    for (std::byte& byte : result) byte = std::byte(below(256));
    return result;
  }
  SplitGroup group() {
    SplitGroup result{subdomain(), epoch(), rank(), epoch(), {}};
    for (auto n = below(6); n > 0; --n) {
      const auto depth = below(dyadic::kMaxDepth + 1);
      const dyadic::Path path = (dyadic::Path{1} << depth) | below(std::uint64_t{1} << depth);
      result.points.push_back({static_cast<GlobalRootId>(below(static_cast<std::uint64_t>(kLimits.roots))), path});
    }
    return result;
  }

  std::mt19937_64 random_;
};

}  // namespace driftmesh::protocol::testing
