#pragma once

#include <array>
#include <cstdint>

#include "protocol/rules.hpp"

namespace driftmesh::testing {

/// Other rules, sound or broken, over a tree of termination that few ranks suffice to make high.
class RulesOverTree final : public protocol::Rules {
 public:
  /// `rules` must outlive the object.
  RulesOverTree(const protocol::Rules& rules, std::int32_t arity) : rules_(rules), arity_(arity) {}

  [[nodiscard]] bool counts_as_sent(Station station) const override { return rules_.counts_as_sent(station); }
  [[nodiscard]] bool counts_as_handled(Station station) const override { return rules_.counts_as_handled(station); }
  [[nodiscard]] bool flushes_when_idle() const override { return rules_.flushes_when_idle(); }
  [[nodiscard]] bool passive(bool program_is_passive, bool aggregator_empty, bool nothing_held) const override {
    return rules_.passive(program_is_passive, aggregator_empty, nothing_held);
  }
  [[nodiscard]] bool rests(bool has_work) const override { return rules_.rests(has_work); }
  [[nodiscard]] std::int32_t arity() const override { return arity_; }
  [[nodiscard]] bool supersedes(const protocol::Location& news, const protocol::Location& record) const override {
    return rules_.supersedes(news, record);
  }

 private:
  const protocol::Rules& rules_;
  std::int32_t arity_;
};

/// A chain, narrow trees, and that of real runs.
[[nodiscard]] inline std::int32_t arity_for(std::uint64_t seed) {
  static constexpr std::array<std::int32_t, 5> kArities{1, 2, 3, 8, protocol::TreePlace::kMostChildren};
  return kArities[seed / 8 % kArities.size()];
}

}  // namespace driftmesh::testing
