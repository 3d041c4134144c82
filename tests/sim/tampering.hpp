#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <set>
#include <utility>
#include <variant>

#include "migration/packed_form.hpp"
#include "migration/subdomain.hpp"
#include "protocol/codec.hpp"
#include "protocol/transport_layer.hpp"
#include "sim/witness.hpp"

namespace driftmesh::sim {

/// Whether the point is in the subdomain's mesh.
inline bool has_point(const Subdomain& subdomain, const SplitPoint<GlobalRootId>& split) {
  if (!subdomain.started() || subdomain.dormant()) return false;
  const auto& roots = subdomain.mesh().roots;
  const auto place = std::lower_bound(roots.begin(), roots.end(), split.root);
  const Triangulation& mesh = subdomain.mesh().mesh;
  const SubsegmentId s = mesh.descend(static_cast<RootId>(place - roots.begin()), split.path);
  return mesh.subsegments[s].path == split.path && !mesh.subsegments[s].is_leaf();
}

/// Makes a subdomain handle SPLITs wrongly, by changing their content. Their number must not change, since ranks count
/// them.
using Tampering = void (*)(protocol::SplitGroup& group, const Subdomain& receiver);

/// Like a mesh that does not insert missing ancestors before a point: the point cannot be inserted, and is dropped
/// (another one of the same group takes its place).
inline void drop_orphans(protocol::SplitGroup& group, const Subdomain& receiver) {
  const auto orphan = [&](const SplitPoint<GlobalRootId>& split) {
    const SplitPoint<GlobalRootId> parent{split.root, split.path >> 1};
    return parent.path != 0 && !has_point(receiver, parent) &&
           std::find(group.points.begin(), group.points.end(), parent) == group.points.end();
  };
  const auto sound = std::find_if_not(group.points.begin(), group.points.end(), orphan);
  if (sound == group.points.end()) return;
  const SplitPoint<GlobalRootId> stand_in = *sound;
  std::vector<SplitPoint<GlobalRootId>> heeded = group.points;
  for (SplitPoint<GlobalRootId>& split : heeded)
    if (orphan(split)) split = stand_in;
  group.points = std::move(heeded);
}

/// Like a mesh that does not notice that a point exists already, and splits the half that lies there instead.
inline void insert_again(protocol::SplitGroup& group, const Subdomain& receiver) {
  for (SplitPoint<GlobalRootId>& split : group.points)
    if (has_point(receiver, split)) split.path *= 2;
}

/// Changes the SPLITs that a rank receives.
class TamperingTransport final : public protocol::TransportLayer {
 public:
  using Find = std::function<const Subdomain*(SubdomainId)>;
  TamperingTransport(protocol::Transport& inner, Tampering tamper, protocol::WireLimits limits, Find find)
      : TransportLayer(inner), tamper_(tamper), limits_(limits), find_(std::move(find)) {}

  std::optional<protocol::Received> poll() override {
    auto received = TransportLayer::poll();
    if (!received || !is<protocol::SplitBatch>(received->bytes)) return received;
    auto batch = std::get<protocol::SplitBatch>(protocol::decode(received->source, received->bytes, limits_));
    for (protocol::SplitGroup& group : batch.groups)
      if (const Subdomain* receiver = find_(group.to)) tamper_(group, *receiver);
    received->bytes = protocol::encode(batch);
    return received;
  }

 private:
  Tampering tamper_;
  protocol::WireLimits limits_;
  Find find_;
};

/// Loses the first work that arrives at a rank: SPLITs, or a subdomain.
class LosingTransport final : public protocol::TransportLayer {
 public:
  using TransportLayer::TransportLayer;
  std::optional<protocol::Received> poll() override {
    auto received = TransportLayer::poll();
    if (!received || lost_ || protocol::traffic_of(received->source, received->bytes) != protocol::Traffic::kWork)
      return received;
    lost_ = true;
    return TransportLayer::poll();
  }

 private:
  bool lost_ = false;
};

/// Like a rank that believes it still has a subdomain that it had before: drops it.
class UnwelcomingTransport final : public protocol::TransportLayer {
 public:
  UnwelcomingTransport(protocol::Transport& inner, protocol::WireLimits limits)
      : TransportLayer(inner), limits_(limits) {}

  void send(Rank destination, Bytes bytes) override {
    if (is<protocol::HandOff>(bytes)) known_.insert(subdomain_of(rank(), bytes));
    TransportLayer::send(destination, std::move(bytes));
  }
  std::optional<protocol::Received> poll() override {
    auto received = TransportLayer::poll();
    if (!received || !is<protocol::HandOff>(received->bytes)) return received;
    return known_.contains(subdomain_of(received->source, received->bytes)) ? TransportLayer::poll() : received;
  }

 private:
  [[nodiscard]] SubdomainId subdomain_of(Rank source, const Bytes& bytes) const {
    return std::get<protocol::HandOff>(protocol::decode(source, bytes, limits_)).subdomain;
  }

  protocol::WireLimits limits_;
  std::set<SubdomainId> known_;
};

/// Like a packed form without the pending points of the subdomain.
class ForgetfulTransport final : public protocol::TransportLayer {
 public:
  ForgetfulTransport(protocol::Transport& inner, protocol::WireLimits limits)
      : TransportLayer(inner), limits_(limits) {}

  void send(Rank destination, Bytes bytes) override {
    if (is<protocol::HandOff>(bytes)) {
      auto leaving = std::get<protocol::HandOff>(protocol::decode(rank(), bytes, limits_));
      leaving.packed = without_pending(leaving.packed);
      bytes = protocol::encode(leaving);
    }
    TransportLayer::send(destination, std::move(bytes));
  }

 private:
  static Bytes without_pending(const Bytes& packed) {
    const SubdomainState state = unpack(packed);
    SubdomainView view{state.id, state.refined, {}, {}, state.dormant ? &*state.dormant : nullptr};
    if (state.body) view.body.emplace(SubdomainView::Body{state.body->part, state.body->refiner, state.body->forecast});
    return pack(view);
  }

  protocol::WireLimits limits_;
};

/// Like a rank that changes color when it forwards SPLITs, which shows in the token that it passes on.
class RecoloringTransport final : public protocol::TransportLayer {
 public:
  using Forwarded = std::function<std::int64_t()>;
  /// `forwarded`: the number of SPLITs that the rank has forwarded so far.
  RecoloringTransport(protocol::Transport& inner, bool black, Forwarded forwarded)
      : TransportLayer(inner), black_(black), forwarded_(std::move(forwarded)) {}

  void send(Rank destination, Bytes bytes) override {
    if (destination < rank() && is<protocol::Token>(bytes)) {
      auto token = std::get<protocol::Token>(protocol::decode(rank(), bytes, {}));
      if (forwarded_() != std::exchange(known_, forwarded_())) token.black = came_black_ || black_;
      came_black_ = false;
      bytes = protocol::encode(token);
    }
    TransportLayer::send(destination, std::move(bytes));
  }
  std::optional<protocol::Received> poll() override {
    auto received = TransportLayer::poll();
    if (received && is<protocol::Token>(received->bytes))
      came_black_ |= std::get<protocol::Token>(protocol::decode(received->source, received->bytes, {})).black;
    return received;
  }

 private:
  bool black_;
  Forwarded forwarded_;
  std::int64_t known_ = 0;   // forwarded at its last answer
  bool came_black_ = false;  // a token from below
};

}  // namespace driftmesh::sim
