#pragma once

#include <map>
#include <utility>
#include <vector>

#include "protocol/rank_protocol.hpp"
#include "protocol/rank_step.hpp"
#include "protocol/toy_world.hpp"
#include "protocol/transport.hpp"

namespace driftmesh::protocol::toy {

/// A rank's loop with toy subdomains: the real protocol, codec and transport, and, at random, what a balancer does:
/// moves, outdated or repeated advice, waiting for an answer while otherwise idle.
class ToyRank {
 public:
  /// `rules` must outlive the rank.
  ToyRank(Transport& transport, const World& world, const Rules& rules = sound_rules(), const MeshRules& mesh = {})
      : transport_(transport),
        world_(world),
        mesh_(mesh),
        protocol_(transport.rank(), transport.ranks(), world.owners, world.aggregation, rules),
        random_{world.seed * 7919 + static_cast<std::uint64_t>(to_int(transport.rank()))},
        moves_left_(world.moves),
        advice_left_(world.moves) {
    for (const SubdomainId s : ids_of(world.owners))
      if (world.owners[s] == transport.rank()) put(Subdomain(world, s));
  }

  StepResult step() {
    const bool heard = poll();
    const bool active = work();
    if (active) balance();
    if (!active || random_.chance(3)) protocol_.rest(!active);
    send();
    if (protocol_.finished()) return StepResult::kFinished;
    return heard || active ? StepResult::kBusy : StepResult::kIdle;
  }

  [[nodiscard]] const RankProtocol& protocol() const { return protocol_; }
  [[nodiscard]] const std::map<SubdomainId, Subdomain>& subdomains() const { return subdomains_; }
  /// Whether there is work here, or something that will become work.
  [[nodiscard]] bool at_work() const {
    return protocol_.aggregated() > 0 || protocol_.held_groups() > 0 || any_active();
  }
  [[nodiscard]] bool broken() const {
    return std::any_of(subdomains_.begin(), subdomains_.end(), [](const auto& s) { return s.second.broken(); });
  }

 private:
  void put(Subdomain subdomain) {
    const SubdomainId id = subdomain.id();
    subdomains_.insert_or_assign(id, std::move(subdomain));
  }
  [[nodiscard]] bool any_active() const {
    return std::any_of(subdomains_.begin(), subdomains_.end(), [](const auto& s) { return s.second.active(); });
  }

  bool poll() {
    bool heard = false;
    for (int i = 0; i < 3; ++i) {
      const auto received = transport_.poll();
      if (!received) break;
      heard = true;
      auto delivery = protocol_.receive(received->source, decode(received->source, received->bytes, world_.limits()));
      if (delivery.arrival) put(Subdomain(delivery.arrival->subdomain, delivery.arrival->packed));
      for (const SplitGroup& group : delivery.splits)
        for (const SplitPoint<GlobalRootId>& split : group.points) subdomains_.at(group.to).tell(split);
    }
    return heard;
  }

  // Does a unit of work of one active subdomain. Returns whether there was any.
  bool work() {
    std::vector<Subdomain*> active;
    for (auto& [id, subdomain] : subdomains_)
      if (subdomain.active()) active.push_back(&subdomain);
    if (active.empty()) return false;
    Subdomain& subdomain = *active[random_.below(active.size())];
    std::vector<SplitPoint<GlobalRootId>> said;
    subdomain.work(mesh_, said);
    for (const SplitPoint<GlobalRootId>& split : said) {
      const Edge edge = world_.edges[split.root];
      tell(edge.one == subdomain.id() ? edge.other : edge.one, split);
    }
    return true;
  }

  void tell(SubdomainId to, const SplitPoint<GlobalRootId>& split) {
    if (protocol_.holds(to))
      subdomains_.at(to).tell(split);
    else
      protocol_.send_split(to, split);
  }

  void balance() {
    if (moves_left_ > 0 && random_.chance(15)) {
      --moves_left_;
      auto chosen = subdomains_.begin();
      std::advance(chosen, static_cast<std::ptrdiff_t>(random_.below(subdomains_.size())));
      const Rank to = any_rank();
      if (to != transport_.rank()) {
        protocol_.hand_off(chosen->first, to, chosen->second.pack());
        subdomains_.erase(chosen);
      }
    }
    if (advice_left_ > 0 && random_.chance(10)) {
      --advice_left_;
      const auto s = static_cast<SubdomainId>(random_.below(world_.owners.size()));
      const Location location = protocol_.where(s);
      const Rank to = any_rank();
      for (int twice = 0; twice < 2; ++twice) protocol_.advise(to, LocationUpdate{s, location.owner, location.epoch});
      protocol_.advise(any_rank(), Advice{0, Bytes(24)});
    }
  }

  void send() {
    for (const Outgoing& outgoing : protocol_.take_outgoing())
      transport_.send(outgoing.destination, encode(outgoing.message));
  }

  Rank any_rank() { return static_cast<Rank>(random_.below(static_cast<std::uint64_t>(transport_.ranks()))); }

  Transport& transport_;
  const World& world_;
  MeshRules mesh_;
  RankProtocol protocol_;
  Random random_;
  std::uint64_t moves_left_;
  std::uint64_t advice_left_;
  std::map<SubdomainId, Subdomain> subdomains_;
};

}  // namespace driftmesh::protocol::toy
