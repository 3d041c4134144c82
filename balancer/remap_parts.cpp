#include "balancer/remap_parts.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace driftmesh::balancer {
namespace {

constexpr Rank kNobody = -1;

/// A matching of parts and ranks, made one pair after the other.
class Matching {
 public:
  Matching(const LoadSnapshot& snapshot, std::span<const Rank> parts, double tolerance)
      : speeds_(assumed_speeds(snapshot.ranks)),
        work_(speeds_.size()),
        rank_of_(speeds_.size(), kNobody),
        part_of_(speeds_.size(), kNobody) {
    for (std::size_t i = 0; i < parts.size(); ++i) work_[at(parts[i])] += snapshot.subdomains[i].remaining;
    for (std::size_t r = 0; r < speeds_.size(); ++r) limit_ = std::max(limit_, work_[r] / speeds_[r]);
    limit_ *= 1 + tolerance;
  }

  void join_if_possible(Rank part, Rank rank) {
    if (rank_of_[at(part)] != kNobody || part_of_[at(rank)] != kNobody || time(part, rank) > limit_) return;
    rank_of_[at(part)] = rank;
    part_of_[at(rank)] = part;
  }

  // The slowest rank takes the part with least work, and so on: no other way finishes earlier.
  void join_rest() {
    std::vector<Rank> parts, ranks;
    for (std::size_t i = 0; i < speeds_.size(); ++i) {
      if (rank_of_[i] == kNobody) parts.push_back(static_cast<Rank>(i));
      if (part_of_[i] == kNobody) ranks.push_back(static_cast<Rank>(i));
    }
    std::sort(parts.begin(), parts.end(),
              [&](Rank a, Rank b) { return std::pair(work_[at(a)], a) < std::pair(work_[at(b)], b); });
    std::sort(ranks.begin(), ranks.end(),
              [&](Rank a, Rank b) { return std::pair(speeds_[at(a)], a) < std::pair(speeds_[at(b)], b); });
    for (std::size_t i = 0; i < parts.size(); ++i) rank_of_[at(parts[i])] = ranks[i];
  }

  // What is left over need not fit: then every rank takes the part that was made for it.
  void settle() {
    for (std::size_t p = 0; p < rank_of_.size(); ++p)
      if (time(static_cast<Rank>(p), rank_of_[p]) > limit_) {
        std::iota(rank_of_.begin(), rank_of_.end(), Rank{0});
        return;
      }
  }

  [[nodiscard]] Rank rank_of(Rank part) const { return rank_of_[at(part)]; }

 private:
  static std::size_t at(Rank i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] double time(Rank part, Rank rank) const { return work_[at(part)] / speeds_[at(rank)]; }

  std::vector<double> speeds_;
  std::vector<double> work_;  // of each part
  double limit_ = 0;
  std::vector<Rank> rank_of_, part_of_;
};

}  // namespace

std::vector<Rank> remap_parts(const LoadSnapshot& snapshot, std::span<const Rank> parts, double tolerance) {
  std::map<std::pair<Rank, Rank>, double> shared;  // work of a part that a rank owns
  for (std::size_t i = 0; i < parts.size(); ++i)
    shared[{parts[i], snapshot.subdomains[i].owner}] += snapshot.subdomains[i].remaining;
  std::vector<std::tuple<double, Rank, Rank>> most_first;
  for (const auto& [pair, work] : shared) most_first.emplace_back(-work, pair.first, pair.second);
  std::sort(most_first.begin(), most_first.end());

  Matching matching(snapshot, parts, tolerance);
  for (const auto& [work, part, rank] : most_first) matching.join_if_possible(part, rank);
  matching.join_rest();
  matching.settle();
  std::vector<Rank> owners;
  for (const Rank part : parts) owners.push_back(matching.rank_of(part));
  return owners;
}

}  // namespace driftmesh::balancer
