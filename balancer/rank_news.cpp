#include "balancer/rank_news.hpp"

#include <algorithm>

namespace driftmesh::balancer {
namespace {

constexpr double kNotable = 1.05;

}  // namespace

RankNews::RankNews(const Layout& layout, double now) : ranks_(static_cast<std::size_t>(layout.ranks), Heard{{}, now}) {
  for (const Layout::Subdomain& s : layout.subdomains) {
    protocol::LoadNews& news = ranks_[static_cast<std::size_t>(s.owner)].news;
    news.remaining += s.predicted;
    news.spare += s.predicted;
  }
}

bool RankNews::hear(Rank rank, const protocol::LoadNews& news, double now) {
  Heard& heard = ranks_[index(rank)];
  if (news.round <= heard.news.round) return false;
  const double believed = std::max(0.0, heard.news.remaining - heard.news.speed * std::max(0.0, now - heard.at));
  heard = {news, now};
  return news.spare > 0 && news.remaining > kNotable * believed;
}

void RankNews::expect(Rank from, Rank to, double work, double now) {
  const std::vector<RankState> current = states(now);
  // What it will get, a rank cannot give yet.
  const auto change = [&](Rank rank, double amount) {
    Heard& heard = ranks_[index(rank)];
    heard.news.remaining = std::max(0.0, current[index(rank)].remaining + amount);
    heard.news.spare = std::clamp(heard.news.spare + std::min(0.0, amount), 0.0, heard.news.remaining);
    heard.at = now;
  };
  change(from, -work);
  change(to, work);
}

void RankNews::assume(const std::vector<RankState>& states, double now) {
  for (std::size_t r = 0; r < ranks_.size(); ++r) {
    ranks_[r].news.speed = states[r].speed;
    ranks_[r].news.remaining = states[r].remaining;
    ranks_[r].at = now;
  }
}

bool RankNews::complete() const {
  return std::all_of(ranks_.begin(), ranks_.end(), [](const Heard& heard) { return heard.news.round > 0; });
}

std::vector<RankState> RankNews::states(double now) const {
  std::vector<RankState> states;
  for (const Heard& heard : ranks_) states.push_back({heard.news.speed, heard.news.remaining});
  const std::vector<double> speeds = assumed_speeds(states);
  for (std::size_t r = 0; r < states.size(); ++r)
    states[r].remaining = std::max(0.0, states[r].remaining - speeds[r] * std::max(0.0, now - ranks_[r].at));
  return states;
}

std::vector<bool> RankNews::able(const std::vector<RankState>& states) const {
  std::vector<bool> able;
  for (std::size_t r = 0; r < ranks_.size(); ++r)
    able.push_back(std::min(ranks_[r].news.spare, states[r].remaining) > 0);
  return able;
}

}  // namespace driftmesh::balancer
