#include "balancer/snapshot/rank_board.hpp"

#include <algorithm>
#include <utility>

#include "balancer/snapshot/effort.hpp"

namespace driftmesh::balancer {
namespace {

bool is_idle(const RankLoad& rank) {
  return rank.remaining <= 0;
}

}  // namespace

RankBoard::RankBoard(const RankNews& news, std::shared_ptr<const Layout> layout, double now) {
  snapshot_.layout = std::move(layout);
  snapshot_.ranks = news.states(now);
  note_effort("news", static_cast<double>(snapshot_.ranks.size()));
  for (const Rank r : ids_of(snapshot_.ranks)) {
    able_.push_back(news.can_give(r, snapshot_.ranks[r]));
    givers_ += able_.back();
    idle_ += is_idle(snapshot_.ranks[r]);
    work_ += snapshot_.ranks[r].remaining;
    speed_ += news.known_or_mean(snapshot_.ranks[r].speed);
  }
}

void RankBoard::put(Rank rank, const RankLoad& state, bool able) {
  work_ = std::max(0.0, work_ + state.remaining - snapshot_.ranks[rank].remaining);
  idle_ += is_idle(state);
  idle_ -= is_idle(std::exchange(snapshot_.ranks[rank], state));
  givers_ += able;
  givers_ -= able_[rank];
  able_[rank] = able;
}

std::uint32_t RankBoard::rivals() const {
  return static_cast<std::uint32_t>((idle_ - std::min<std::size_t>(idle_, 1)) / std::max<std::size_t>(1, givers_));
}

}  // namespace driftmesh::balancer
