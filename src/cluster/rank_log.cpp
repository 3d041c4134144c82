#include "cluster/rank_log.hpp"

#include <algorithm>
#include <utility>

namespace driftmesh {
namespace {

double remaining_on(const RankLoop& loop) {
  double remaining = 0;
  loop.held().each([&](const Work& work) { remaining += work.state().remaining; });
  return remaining;
}

void write_deliberation(ByteWriter& writer, const balancer::Deliberation& d) {
  writer.value(d.subject);
  writer.value(d.verdict);
  for (const double value : {d.time, d.finish, d.ideal, d.noise, d.saves, d.border}) writer.value(value);
  writer.value(d.whole);
  for (const Rank rank : {d.rank, d.thief, d.giver}) writer.value(rank);
  writer.array(d.loads);
  writer.array(d.moves);
}

balancer::Deliberation read_deliberation(ByteReader& reader) {
  balancer::Deliberation d;
  reader.value(d.subject);
  reader.value(d.verdict);
  for (double* value : {&d.time, &d.finish, &d.ideal, &d.noise, &d.saves, &d.border}) reader.value(*value);
  reader.value(d.whole);
  for (Rank* rank : {&d.rank, &d.thief, &d.giver}) reader.value(*rank);
  reader.array(d.loads);
  reader.array(d.moves);
  return d;
}

template <class Record>
void sort_by_time(std::vector<Record>& records, double Record::*time) {
  std::stable_sort(records.begin(), records.end(), [=](const Record& a, const Record& b) { return a.*time < b.*time; });
}

}  // namespace

RankLog::RankLog(const protocol::Transport& transport, const Decomposition* decomposition)
    : transport_(&transport), decomposition_(decomposition), start_(transport.now()) {}

void RankLog::sample(const RankLoop& loop, double seconds, SubdomainId subdomain) {
  samples_.push_back({now(), transport_->rank(), loop.triangles(), remaining_on(loop), seconds, subdomain});
}

void RankLog::begins(const RankLoop& loop) {
  sample(loop, 0, kNoSubdomain);
}

void RankLog::worked(const RankLoop& loop, const RankLoop::Slice& slice, double seconds) {
  sample(loop, seconds, slice.subdomain);
  told_.clear();
  for (const SplitPoint<GlobalRootId>& split : slice.said)
    ++told_[decomposition_->roots[split.root].across_from(slice.subdomain)];
  for (const auto& [neighbor, points] : told_)
    splits_.push_back({now(), transport_->rank(), slice.subdomain, neighbor, points});
}

void RankLog::departs(const RankLoop& loop, const RankLoop::Passage& passage) {
  departures_.push_back({now(), passage.subdomain, passage.epoch, passage.to, passage.bytes});
  sample(loop, 0, kNoSubdomain);
}

void RankLog::arrives(const RankLoop& loop, const RankLoop::Passage& passage) {
  arrivals_.push_back({now(), passage.subdomain, passage.epoch, passage.to, passage.bytes});
  sample(loop, 0, kNoSubdomain);
}

void RankLog::deliberated(std::vector<balancer::Deliberation> considered) {
  for (balancer::Deliberation& d : considered) {
    d.time = now();
    d.rank = transport_->rank();
    deliberations_.push_back(std::move(d));
  }
}

void RankLog::ends(const RankLoop& loop) {
  end_ = now();
  outcome_ = loop.outcome();
  loop.held().each([&](const Work& work) { held_.push_back(work.id()); });
}

void RankLog::write(ByteWriter& writer) const {
  writer.value(end_);
  writer.value(outcome_);
  writer.array(samples_);
  writer.array(splits_);
  writer.number(std::uint64_t{deliberations_.size()});
  for (const balancer::Deliberation& d : deliberations_) write_deliberation(writer, d);
  writer.array(departures_);
  writer.array(arrivals_);
  writer.array(held_);
}

RankLog RankLog::read(ByteReader& reader) {
  RankLog log;
  reader.value(log.end_);
  reader.value(log.outcome_);
  reader.array(log.samples_);
  reader.array(log.splits_);
  for (auto left = reader.number<std::uint64_t>(); left > 0; --left)
    log.deliberations_.push_back(read_deliberation(reader));
  reader.array(log.departures_);
  reader.array(log.arrivals_);
  reader.array(log.held_);
  return log;
}

ClusterRun RankLog::join(const IdVector<Rank, RankLog>& logs) {
  ClusterRun run;
  std::map<std::pair<SubdomainId, protocol::Epoch>, double> arrived;
  std::size_t subdomains = 0;
  for (const RankLog& log : logs) {
    run.makespan = std::max(run.makespan, log.end_);
    run.ranks.push_back(log.outcome_);
    run.samples.insert(run.samples.end(), log.samples_.begin(), log.samples_.end());
    run.splits.insert(run.splits.end(), log.splits_.begin(), log.splits_.end());
    run.deliberations.insert(run.deliberations.end(), log.deliberations_.begin(), log.deliberations_.end());
    for (const Passage& arrival : log.arrivals_) arrived[{arrival.subdomain, arrival.epoch}] = arrival.time;
    subdomains += log.held_.size();
  }
  run.owners.resize(subdomains);
  for (const Rank rank : ids_of(logs)) {
    for (const SubdomainId s : logs[rank].held_) run.owners[s] = rank;
    for (const Passage& p : logs[rank].departures_)
      run.moves.push_back({p.subdomain, rank, p.to, p.time, arrived.at({p.subdomain, p.epoch}), p.bytes});
  }
  sort_by_time(run.moves, &MoveRecord::left);
  sort_by_time(run.samples, &LoadSample::time);
  sort_by_time(run.splits, &SplitRecord::time);
  sort_by_time(run.deliberations, &balancer::Deliberation::time);
  return run;
}

}  // namespace driftmesh
