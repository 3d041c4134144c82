#include "balancer/planner/remap_parts.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "balancer/snapshot/effort.hpp"

namespace driftmesh::balancer {
namespace {

/// A matching of parts and ranks, made one pair after the other.
class Matching {
 public:
  Matching(const LoadSnapshot& snapshot, std::span<const Part> parts, double tolerance)
      : speeds_(assumed_speeds(snapshot.ranks)),
        work_(speeds_.size()),
        rank_of_(speeds_.size()),
        taken_(speeds_.size()) {
    for (std::size_t i = 0; i < parts.size(); ++i) work_[parts[i]] += snapshot.subdomains[i].remaining;
    for (const Part p : ids_of(work_)) limit_ = std::max(limit_, time(p, made_for(p)));
    limit_ *= 1 + tolerance;
  }

  void join_if_possible(Part part, Rank rank) {
    if (rank_of_[part] || taken_[rank] || time(part, rank) > limit_) return;
    rank_of_[part] = rank;
    taken_[rank] = true;
  }

  // The slowest rank takes the part with least work, and so on: no other way finishes earlier.
  void join_rest() {
    std::vector<Part> parts;
    std::vector<Rank> ranks;
    for (const Part p : ids_of(rank_of_))
      if (!rank_of_[p]) parts.push_back(p);
    for (const Rank r : ids_of(taken_))
      if (!taken_[r]) ranks.push_back(r);
    std::ranges::sort(parts, {}, [&](Part p) { return std::pair(work_[p], p); });
    std::ranges::sort(ranks, {}, [&](Rank r) { return std::pair(speeds_[r], r); });
    for (std::size_t i = 0; i < parts.size(); ++i) rank_of_[parts[i]] = ranks[i];
  }

  // The rest may not fit: then every rank takes its own part.
  void settle() {
    if (std::ranges::any_of(ids_of(rank_of_), [&](Part p) { return time(p, *rank_of_[p]) > limit_; }))
      for (const Part p : ids_of(rank_of_)) rank_of_[p] = made_for(p);
  }

  [[nodiscard]] Rank rank_of(Part part) const { return *rank_of_[part]; }

 private:
  static Rank made_for(Part part) { return Rank{to_int(part)}; }
  [[nodiscard]] double time(Part part, Rank rank) const { return work_[part] / speeds_[rank]; }

  IdVector<Rank, double> speeds_;
  IdVector<Part, double> work_;
  double limit_ = 0;
  IdVector<Part, std::optional<Rank>> rank_of_;
  IdVector<Rank, bool> taken_;
};

}  // namespace

std::vector<Rank> remap_parts(const LoadSnapshot& snapshot, std::span<const Part> parts, double tolerance) {
  note_effort("remap", static_cast<double>(parts.size()));
  std::map<std::pair<Part, Rank>, double> shared;  // work of a part owned by a rank
  for (std::size_t i = 0; i < parts.size(); ++i)
    shared[{parts[i], snapshot.subdomains[i].owner}] += snapshot.subdomains[i].remaining;
  std::vector<std::tuple<double, Part, Rank>> most_first;
  for (const auto& [pair, work] : shared) most_first.emplace_back(-work, pair.first, pair.second);
  std::sort(most_first.begin(), most_first.end());

  Matching matching(snapshot, parts, tolerance);
  for (const auto& [work, part, rank] : most_first) matching.join_if_possible(part, rank);
  matching.join_rest();
  matching.settle();
  std::vector<Rank> owners;
  for (const Part part : parts) owners.push_back(matching.rank_of(part));
  return owners;
}

}  // namespace driftmesh::balancer
