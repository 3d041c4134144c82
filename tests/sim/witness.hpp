#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "balancer/snapshot/codec.hpp"
#include "protocol/codec.hpp"
#include "protocol/rank_protocol.hpp"
#include "protocol/transport_layer.hpp"
#include "sim/adversary_effects.hpp"

namespace driftmesh::sim {

/// Whether an encoded message is a T of the protocol.
template <class T>
[[nodiscard]] bool is(const Bytes& bytes) {
  static const std::byte type = protocol::encode(T{})[1];
  return bytes.size() > 1 && bytes[1] == type;
}

/// Whether it is advice that contains a T of the balancer.
template <class T>
[[nodiscard]] bool is_advice(const Bytes& bytes) {
  static const std::byte type = protocol::encode(balancer::encode(T{}))[1];
  return bytes.size() > 1 && bytes[1] == type;
}

/// Sees everything that all ranks send and receive: finds violations of docs/protocol.md, and counts what an adversary
/// achieved.
class Witness {
 public:
  /// `work_is_over`: whether all work is really done; can be called at any time.
  Witness(std::int32_t ranks, std::size_t subdomains, std::function<bool()> work_is_over)
      : ranks_(to_index(ranks)), moves_(subdomains), work_is_over_(std::move(work_is_over)) {}

  /// `rank` sends to `destination`; `counters` are those of its protocol at that moment.
  void sent(Rank rank, Rank destination, const Bytes& bytes, const protocol::ProtocolCounters& counters) {
    ++clock_;
    if (is<protocol::Token>(bytes)) {
      if (destination < rank) token_passed(rank, decoded<protocol::Token>(bytes), counters);
      return;
    }
    if (is<protocol::HandOff>(bytes)) {
      const SubdomainId s = decoded<protocol::HandOff>(bytes).subdomain;
      ++moves_.at(s);
      under_way_[s] = clock_;
    } else if (is<protocol::SplitBatch>(bytes)) {
      const auto batch = decoded<protocol::SplitBatch>(bytes);
      for (const auto& group : batch.groups) split_sent(group);
    } else if (is_advice<balancer::Admission>(bytes)) {
      const auto step =
          std::get<balancer::Admission>(balancer::decode(rank, decoded<protocol::Advice>(bytes), kLimits));
      effects_.questions += step.stage == balancer::Admission::Stage::kAsk ? 1 : 0;
      effects_.answers += step.stage == balancer::Admission::Stage::kAnswer ? 1 : 0;
    }
  }

  /// `rank` receives from `source`; `holds` says whether a subdomain is there.
  void received(Rank source, Rank rank, const Bytes& bytes, const std::function<bool(SubdomainId)>& holds) {
    if (is<protocol::Token>(bytes)) {
      const auto token = decoded<protocol::Token>(bytes);
      ranks_[rank].tokens[token.round][source] = token;  // once: there may be copies
    } else if (is<protocol::HandOff>(bytes)) {
      arrived(decoded<protocol::HandOff>(bytes).subdomain);
    } else if (is<protocol::SplitBatch>(bytes)) {
      const auto batch = decoded<protocol::SplitBatch>(bytes);
      for (const auto& group : batch.groups) split_received(group);
    } else if (is<protocol::LocationUpdate>(bytes)) {
      located(rank, decoded<protocol::LocationUpdate>(bytes));
    } else if (is_advice<balancer::Plan>(bytes)) {
      const auto plan = std::get<balancer::Plan>(balancer::decode(rank, decoded<protocol::Advice>(bytes), kLimits));
      for (const auto& move : plan.moves) effects_.late_plans += holds(move.subdomain) ? 0 : 1;
    }
  }

  [[nodiscard]] const AdversaryEffects& effects() const { return effects_; }
  /// The problem of a token that a rank answered with, or "".
  [[nodiscard]] const std::string& token_problem() const { return token_problem_; }
  /// The problem of the route of a SPLIT, or "".
  [[nodiscard]] const std::string& hops_problem() const { return hops_problem_; }

 private:
  // A group of SPLITs on one leg of its route. Each point is announced once, so no other group begins with it.
  using Leg = std::tuple<SubdomainId, GlobalRootId, dyadic::Path, std::uint32_t>;
  struct OfRank {
    std::map<std::uint64_t, std::map<Rank, protocol::Token>> tokens;  // received, by round; a question adds nothing
    std::int64_t handled = 0;                                         // at its last answer
    std::map<std::tuple<SubdomainId, Rank, protocol::Epoch>, int> locations;
  };

  static constexpr protocol::WireLimits kLimits{1 << 20, 1 << 20, 1 << 20};

  template <class T>
  static T decoded(const Bytes& bytes) {
    return std::get<T>(protocol::decode(Rank{0}, bytes, kLimits));
  }
  static Leg leg(const protocol::SplitGroup& group) {
    return {group.to, group.points.front().root, group.points.front().path, group.hops};
  }

  // Rules 2, 3 and 4: a rank adds its own count, and blackens the token if it has handled anything since the last one.
  void token_passed(Rank rank, const protocol::Token& token, const protocol::ProtocolCounters& counters) {
    OfRank& known = ranks_[rank];
    protocol::Token came;
    for (const auto& [source, below] : known.tokens.at(token.round)) came += below;
    const std::int64_t handled = counters.splits_handled + counters.arrivals;
    const bool has_handled = std::exchange(known.handled, handled) != handled;
    const bool black = came.black || has_handled;
    const std::int64_t count = came.count + counters.splits_sent + counters.hand_offs - handled;
    if (token.black != black)
      complain(token_problem_, rank,
               token.black ? "blackens a token without a reason" : "passes a token on white that must be black");
    if (token.count != count) complain(token_problem_, rank, "adds a wrong count to a token");
  }

  void split_sent(const protocol::SplitGroup& group) {
    if (group.hops == 0) first_epoch_[leg(group)] = group.epoch;
    splits_[group.to][leg(group)] = clock_;
  }

  void split_received(const protocol::SplitGroup& group) {
    splits_[group.to].erase(leg(group));
    if (under_way_.contains(group.to)) ++effects_.splits_ahead;
    effects_.most_hops = std::max<std::int64_t>(effects_.most_hops, group.hops);
    Leg first = leg(group);
    std::get<3>(first) = 0;
    if (group.hops > group.epoch - first_epoch_.at(first) || group.epoch > moves_.at(group.to))
      complain(hops_problem_, group.origin,
               "has sent SPLITs that were forwarded more often than their subdomain moved");
  }

  void arrived(SubdomainId s) {
    const std::uint64_t left = under_way_.at(s);
    under_way_.erase(s);
    for (const auto& [leg, sent] : splits_[s])
      if (sent < left) {
        ++effects_.hand_offs_ahead;
        return;
      }
  }

  void located(Rank rank, const protocol::LocationUpdate& update) {
    if (work_is_over_()) ++effects_.late_locations;
    if (update.epoch < moves_.at(update.subdomain)) ++effects_.outdated_locations;
    if (++ranks_[rank].locations[{update.subdomain, update.owner, update.epoch}] > 1) ++effects_.repeated_locations;
  }

  static void complain(std::string& problem, Rank rank, const char* what) {
    if (problem.empty()) problem = "rank " + to_string(rank) + " " + what;
  }

  std::uint64_t clock_ = 0;  // sends so far
  IdVector<Rank, OfRank> ranks_;
  IdVector<SubdomainId, protocol::Epoch> moves_;
  std::map<SubdomainId, std::uint64_t> under_way_;              // when they left
  std::map<SubdomainId, std::map<Leg, std::uint64_t>> splits_;  // under way, and when they were sent
  std::map<Leg, protocol::Epoch> first_epoch_;
  std::function<bool()> work_is_over_;
  AdversaryEffects effects_;
  std::string token_problem_, hops_problem_;
};

/// Between a rank and its network: shows the witness both directions, and lets time pass according to the work done.
class WitnessedTransport final : public protocol::TransportLayer {
 public:
  using Holds = std::function<bool(SubdomainId)>;
  using Counters = std::function<const protocol::ProtocolCounters&()>;
  WitnessedTransport(protocol::Transport& inner, Witness& witness, Holds holds, Counters counters)
      : TransportLayer(inner), witness_(witness), holds_(std::move(holds)), counters_(std::move(counters)) {}

  void send(Rank destination, Bytes bytes) override {
    witness_.sent(rank(), destination, bytes, counters_());
    TransportLayer::send(destination, std::move(bytes));
  }
  std::optional<protocol::Received> poll() override {
    auto received = TransportLayer::poll();
    if (received) witness_.received(received->source, rank(), received->bytes, holds_);
    return received;
  }
  [[nodiscard]] double now() const override { return TransportLayer::now() + spent_; }
  void spend(double seconds) override { spent_ += seconds; }

 private:
  Witness& witness_;
  Holds holds_;
  Counters counters_;
  double spent_ = 0;
};

}  // namespace driftmesh::sim
