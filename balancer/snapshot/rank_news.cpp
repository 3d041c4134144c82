#include "balancer/snapshot/rank_news.hpp"

#include <algorithm>
#include <utility>

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
  reported_ += heard.news.round == 0 ? 1 : 0;
  const double believed = state(rank, now).remaining;
  set_speed(rank, news.speed);
  heard = {news, now};
  return news.spare > 0 && news.remaining > kNotable * believed;
}

void RankNews::hear_memory(Rank rank, double free_memory) {
  if (LoadNews& news = ranks_[rank].news; news.round == 0) news.free_memory = free_memory;
}

void RankNews::expect(Rank from, Rank to, double work, double now) {
  // A rank cannot give what it has not received yet.
  const auto change = [&](Rank rank, double amount) {
    Heard& heard = ranks_[rank];
    heard.news.remaining = std::max(0.0, state(rank, now).remaining + amount);
    heard.news.spare = std::clamp(heard.news.spare + std::min(0.0, amount), 0.0, heard.news.remaining);
    if (heard.news.free_memory < kAmpleMemory) heard.news.free_memory = std::max(0.0, heard.news.free_memory - amount);
    heard.at = now;
  };
  change(from, -work);
  change(to, work);
}

IdVector<Rank, RankLoad> RankNews::states(double now) const {
  IdVector<Rank, RankLoad> states;
  states.reserve(ranks_.size());
  for (const Rank r : ids_of(ranks_)) states.push_back(state(r, now));
  return states;
}

RankLoad RankNews::state(Rank rank, double now) const {
  const LoadNews& news = ranks_[rank].news;
  const double done = known_or_mean(news.speed) * std::max(0.0, now - ranks_[rank].at);
  return {news.speed, std::max(0.0, news.remaining - done), news.doubt, news.free_memory};
}

bool RankNews::can_give(Rank rank, const RankLoad& state) const {
  return std::min(ranks_[rank].news.spare, state.remaining) > 0;
}

double RankNews::known_or_mean(double speed) const {
  return is_speed(speed) ? speed : known_ > 0 ? sum_ / known_ : 1;
}

void RankNews::set_speed(Rank rank, double speed) {
  const double before = std::exchange(ranks_[rank].news.speed, speed);
  if (is_speed(before)) sum_ -= before, --known_;
  if (is_speed(speed)) sum_ += speed, ++known_;
}

}  // namespace driftmesh::balancer
