#include "balancer/rank_news.hpp"

#include <algorithm>

namespace driftmesh::balancer {
namespace {

constexpr double kNotable = 1.05;

}  // namespace

RankNews::RankNews(const Layout& layout, double now) : ranks_(to_index(layout.ranks), Heard{{}, now}) {
  for (const Layout::Subdomain& s : layout.subdomains) {
    LoadNews& news = ranks_[s.owner].news;
    news.remaining += s.predicted;
    news.spare += s.predicted;
  }
}

bool RankNews::hear(Rank rank, const LoadNews& news, double now) {
  Heard& heard = ranks_[rank];
  if (news.round <= heard.news.round) return false;
  const double believed = std::max(0.0, heard.news.remaining - heard.news.speed * std::max(0.0, now - heard.at));
  heard = {news, now};
  return news.spare > 0 && news.remaining > kNotable * believed;
}

void RankNews::expect(Rank from, Rank to, double work, double now) {
  const IdVector<Rank, RankLoad> current = states(now);
  // A rank cannot give what it has not received yet.
  const auto change = [&](Rank rank, double amount) {
    Heard& heard = ranks_[rank];
    heard.news.remaining = std::max(0.0, current[rank].remaining + amount);
    heard.news.spare = std::clamp(heard.news.spare + std::min(0.0, amount), 0.0, heard.news.remaining);
    if (heard.news.free_memory < kAmpleMemory) heard.news.free_memory = std::max(0.0, heard.news.free_memory - amount);
    heard.at = now;
  };
  change(from, -work);
  change(to, work);
}

void RankNews::assume(const IdVector<Rank, RankLoad>& states, double now) {
  for (const Rank r : ids_of(ranks_)) {
    ranks_[r].news.speed = states[r].speed;
    ranks_[r].news.remaining = states[r].remaining;
    ranks_[r].news.free_memory = states[r].free_memory;
    ranks_[r].at = now;
  }
}

bool RankNews::complete() const {
  return std::all_of(ranks_.begin(), ranks_.end(), [](const Heard& heard) { return heard.news.round > 0; });
}

IdVector<Rank, RankLoad> RankNews::states(double now) const {
  IdVector<Rank, RankLoad> states;
  for (const Heard& heard : ranks_) {
    const LoadNews& news = heard.news;
    states.push_back({news.speed, news.remaining, news.doubt, news.free_memory});
  }
  const IdVector<Rank, double> speeds = assumed_speeds(states);
  for (const Rank r : ids_of(states))
    states[r].remaining = std::max(0.0, states[r].remaining - speeds[r] * std::max(0.0, now - ranks_[r].at));
  return states;
}

IdVector<Rank, bool> RankNews::able(const IdVector<Rank, RankLoad>& states) const {
  IdVector<Rank, bool> able;
  for (const Rank r : ids_of(ranks_)) able.push_back(std::min(ranks_[r].news.spare, states[r].remaining) > 0);
  return able;
}

}  // namespace driftmesh::balancer
