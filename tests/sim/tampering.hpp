#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "migration/subdomain.hpp"
#include "protocol/codec.hpp"
#include "protocol/transport.hpp"

namespace driftmesh::sim {

/// Whether the point is in the subdomain's mesh.
inline bool has_point(const Subdomain& subdomain, const protocol::SplitEntry& entry) {
  if (!subdomain.started() || subdomain.dormant()) return false;
  const auto& roots = subdomain.mesh().roots;
  const auto place = std::lower_bound(roots.begin(), roots.end(), entry.edge);
  const Triangulation& mesh = subdomain.mesh().mesh;
  const SubsegmentId s = mesh.descend(static_cast<RootId>(place - roots.begin()), entry.path);
  return mesh.subsegments[Triangulation::id(s)].path == entry.path && !mesh.subsegments[Triangulation::id(s)].is_leaf();
}

/// Takes in SPLITs for one subdomain in a wrong way: changes what it is told. Their number must stay, since ranks count
/// them.
using Tampering = void (*)(protocol::SplitGroup& group, const Subdomain& receiver);

/// As a mesh that puts no missing ancestors in before a point: the point cannot be inserted, and is dropped (another of
/// the same group stands in for it).
inline void drop_orphans(protocol::SplitGroup& group, const Subdomain& receiver) {
  const auto orphan = [&](const protocol::SplitEntry& entry) {
    const protocol::SplitEntry parent{entry.edge, entry.path >> 1};
    return parent.path != 0 && !has_point(receiver, parent) &&
           std::find(group.entries.begin(), group.entries.end(), parent) == group.entries.end();
  };
  const auto sound = std::find_if_not(group.entries.begin(), group.entries.end(), orphan);
  if (sound == group.entries.end()) return;
  const protocol::SplitEntry stand_in = *sound;
  std::vector<protocol::SplitEntry> heeded = group.entries;
  for (protocol::SplitEntry& entry : heeded)
    if (orphan(entry)) entry = stand_in;
  group.entries = std::move(heeded);
}

/// As a mesh that does not see that a point is there already, and cuts the half that lies there instead.
inline void insert_again(protocol::SplitGroup& group, const Subdomain& receiver) {
  for (protocol::SplitEntry& entry : group.entries)
    if (has_point(receiver, entry)) entry.path *= 2;
}

/// Loses the first work that comes to a rank: SPLITs, or a subdomain.
class LosingTransport final : public protocol::Transport {
 public:
  explicit LosingTransport(protocol::Transport& inner) : inner_(inner) {}
  [[nodiscard]] protocol::Rank rank() const override { return inner_.rank(); }
  [[nodiscard]] protocol::Rank ranks() const override { return inner_.ranks(); }
  void send(protocol::Rank destination, protocol::Bytes bytes) override { inner_.send(destination, std::move(bytes)); }
  void idle() override { inner_.idle(); }
  [[nodiscard]] double now() const override { return inner_.now(); }
  std::optional<protocol::Received> poll() override {
    auto received = inner_.poll();
    if (!received || lost_ || protocol::traffic_of(received->source, received->bytes) != protocol::Traffic::kWork)
      return received;
    lost_ = true;
    return inner_.poll();
  }

 private:
  protocol::Transport& inner_;
  bool lost_ = false;
};

/// Between a rank and its network.
class TamperingTransport final : public protocol::Transport {
 public:
  using Find = std::function<const Subdomain*(SubdomainId)>;
  TamperingTransport(protocol::Transport& inner, Tampering tamper, protocol::WireLimits limits, Find find)
      : inner_(inner), tamper_(tamper), limits_(limits), find_(std::move(find)) {}

  [[nodiscard]] protocol::Rank rank() const override { return inner_.rank(); }
  [[nodiscard]] protocol::Rank ranks() const override { return inner_.ranks(); }
  void send(protocol::Rank destination, protocol::Bytes bytes) override { inner_.send(destination, std::move(bytes)); }
  void idle() override { inner_.idle(); }
  [[nodiscard]] double now() const override { return inner_.now(); }
  std::optional<protocol::Received> poll() override {
    auto received = inner_.poll();
    if (!received) return received;
    protocol::Message message = protocol::decode(received->source, received->bytes, limits_);
    auto* const batch = std::get_if<protocol::SplitBatch>(&message);
    if (batch == nullptr) return received;
    for (protocol::SplitGroup& group : batch->groups)
      if (const Subdomain* receiver = find_(group.to)) tamper_(group, *receiver);
    received->bytes = protocol::encode(message);
    return received;
  }

 private:
  protocol::Transport& inner_;
  Tampering tamper_;
  protocol::WireLimits limits_;
  Find find_;
};

}  // namespace driftmesh::sim
