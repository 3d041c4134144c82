#include "balancer/snapshot/knowledge.hpp"

#include <algorithm>
#include <utility>

#include "balancer/snapshot/effort.hpp"

namespace driftmesh::balancer {
namespace {

// The rest of a sequence of work after `done` of it is done.
double left_of(double work, double& done) {
  const double taken = std::min(work, done);
  done -= taken;
  return work - taken;
}

}  // namespace

Knowledge::Knowledge(std::shared_ptr<const Layout> layout, double patience)
    : layout_(std::move(layout)), patience_(patience), ranks_(to_index(layout_->ranks)) {
  for (const Layout::Subdomain& s : layout_->subdomains) ranks_[s.owner].unlisted += s.predicted;
}

void Knowledge::hear(Rank rank, const LoadReport& report, double now) {
  Heard& heard = ranks_[rank];
  if (heard.any && report.round <= heard.round) return;
  heard_ += heard.any ? 0 : 1;
  heard = {true, report.round, now, report.speed, report.doubt, {}, report.unlisted, report.free_memory};
  for (const ReportedLoad& load : report.loads) {
    const auto [known, first] = claims_.try_emplace(load.subdomain, Claim{rank, load.epoch});
    if (!first && load.epoch < known->second.epoch) continue;
    known->second = {rank, load.epoch};
    heard.loads.push_back(load);
  }
  settle_planned(rank, report, now);
}

// A planned move is settled when its destination reports the subdomain, when its owner has seen the plan and still
// reports it, or when it has been too long.
void Knowledge::settle_planned(Rank rank, const LoadReport& report, double now) {
  for (const ReportedLoad& load : report.loads) {
    const auto planned = planned_.find(load.subdomain);
    if (planned == planned_.end()) continue;
    const bool made = rank != planned->second.from;
    const bool refused = rank == planned->second.from && report.plan >= planned->second.plan;
    if (made || refused) planned_.erase(planned);
  }
  std::erase_if(planned_, [&](const auto& p) { return now - p.second.at > patience_; });
}

void Knowledge::expect(std::span<const Move> moves, const LoadSnapshot& planned_on, std::uint32_t plan, double now) {
  for (const Move& move : moves)
    if (const SubdomainLoad* const s = find(planned_on, move.subdomain))
      planned_[move.subdomain] = {s->owner, move.destination, plan, now, *s};
}

void Knowledge::put_off(std::uint32_t plan, double seconds) {
  for (auto& [id, planned] : planned_)
    if (planned.plan == plan) planned.at += seconds;
}

std::map<Rank, double> Knowledge::on_its_way() const {
  std::map<Rank, double> needed;
  for (const auto& [id, planned] : planned_) needed[planned.to] += memory_for(planned.load);
  return needed;
}

Rank Knowledge::owner_of(SubdomainId id) const {
  const auto known = claims_.find(id);
  return known == claims_.end() ? (*layout_)[id].owner : known->second.owner;
}

double Knowledge::list(LoadSnapshot& snapshot, Rank rank, const std::vector<SubdomainLoad>& arriving,
                       double now) const {
  const Heard& heard = ranks_[rank];
  double done = heard.any ? heard.speed * std::max(0.0, now - heard.at) : 0;
  std::int32_t turn = 0;
  const auto add = [&](SubdomainId id, double work, std::uint64_t bytes) {
    if (const double left = left_of(work, done); left > 0)
      snapshot.subdomains.push_back({id, rank, left, bytes, turn++});
  };
  for (const ReportedLoad& load : heard.loads)
    if (owner_of(load.subdomain) == rank && !planned_.contains(load.subdomain))
      add(load.subdomain, load.remaining, load.bytes);
  for (const SubdomainLoad& s : arriving) add(s.id, s.remaining, s.bytes);
  return left_of(heard.unlisted, done);
}

void Knowledge::list_silent(LoadSnapshot& snapshot) const {
  for (const SubdomainId id : ids_of(layout_->subdomains)) {
    const Layout::Subdomain& s = (*layout_)[id];
    if (!ranks_[s.owner].any && !planned_.contains(id) && !claims_.contains(id))
      snapshot.subdomains.push_back({id, s.owner, s.predicted, 0, to_int(id)});
  }
}

LoadSnapshot Knowledge::snapshot(double now, bool with_silent) const {
  LoadSnapshot snapshot;
  snapshot.layout = layout_;
  std::map<Rank, std::vector<SubdomainLoad>> arriving;
  for (const auto& [id, planned] : planned_) arriving[planned.to].push_back(planned.load);
  static const std::vector<SubdomainLoad> kNone;
  IdVector<Rank, double> unlisted;
  for (const Rank r : ids_of(ranks_)) {
    const auto coming = arriving.find(r);
    snapshot.ranks.push_back({ranks_[r].speed, 0, ranks_[r].doubt, ranks_[r].any ? ranks_[r].free_memory : 0});
    unlisted.push_back(list(snapshot, r, coming == arriving.end() ? kNone : coming->second, now));
  }
  for (const auto& [rank, loads] : arriving)
    for (const SubdomainLoad& s : loads) snapshot.ranks[rank].free_memory -= memory_for(s);
  if (with_silent) list_silent(snapshot);
  note_effort("snapshot", static_cast<double>(with_silent ? layout_->subdomains.size() : snapshot.subdomains.size()));
  std::ranges::sort(snapshot.subdomains, {}, &SubdomainLoad::id);
  sum_up(snapshot);
  for (const Rank r : ids_of(ranks_))
    if (ranks_[r].any || !with_silent) snapshot.ranks[r].remaining += unlisted[r];
  return snapshot;
}

}  // namespace driftmesh::balancer
