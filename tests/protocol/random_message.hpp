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
      case 1: {
        HandOff hand_off{subdomain(), epoch(), Bytes(below(50))};
        for (std::byte& byte : hand_off.packed) byte = std::byte(below(256));
        return hand_off;
      }
      case 2:
        return LocationUpdate{subdomain(), rank(), epoch()};
      case 3: {
        LoadReport report{epoch(), epoch(), amount(), {}};
        for (auto n = below(5); n > 0; --n) report.loads.push_back({subdomain(), epoch(), amount(), random_()});
        return report;
      }
      case 4:
        return Plan{epoch(), moves()};
      case 5:
        return Token{random_(), static_cast<std::int64_t>(random_()), below(2) == 1};
      case 6:
        return Terminate{random_(), static_cast<std::int64_t>(random_()), static_cast<std::int64_t>(random_())};
      case 7:
        return Finish{};
      case 8:
        return WorkRequest{rank(), epoch(), amount(), amount(), epoch()};
      case 9:
        return WorkAnswer{epoch(), moves()};
      case 10:
        return LoadNews{epoch(), amount(), amount(), amount()};
      default:
        return JointRound{epoch(), static_cast<JointRound::Stage>(below(3))};
    }
  }

 private:
  std::uint64_t below(std::uint64_t n) { return random_() % n; }
  Rank rank() { return static_cast<Rank>(below(static_cast<std::uint64_t>(kLimits.ranks))); }
  SubdomainId subdomain() { return static_cast<SubdomainId>(below(static_cast<std::uint64_t>(kLimits.subdomains))); }
  Epoch epoch() { return static_cast<Epoch>(random_()); }
  double amount() { return static_cast<double>(random_()) / 3; }
  std::vector<PlannedMove> moves() {
    std::vector<PlannedMove> result;
    for (auto n = below(5); n > 0; --n) result.push_back({subdomain(), rank()});
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
