#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "driftmesh/id_vector.hpp"
#include "driftmesh/ids.hpp"

namespace driftmesh::balancer {

/// Finds the rank for a subdomain without looking at all of them: ranks of similar speed are ordered by when they would
/// finish a typical subdomain besides their load, and only the first ones of each kind can be the best. Finds what a
/// comparison of all ranks finds, up to rounding.
class RanksByFinish {
 public:
  /// `typical` is the work for which it is fast. Speeds are above 0.
  RanksByFinish(const IdVector<Rank, double>& loads, IdVector<Rank, double> speeds, double typical)
      : speeds_(std::move(speeds)), loads_(loads), typical_(typical) {
    std::map<double, std::size_t> known;
    for (const Rank r : ids_of(speeds_)) {
      constexpr double kSimilar = 1.05;
      const auto place = known.try_emplace(std::floor(std::log(speeds_[r]) / std::log(kSimilar)), kinds_.size()).first;
      if (place->second == kinds_.size()) kinds_.emplace_back();
      kind_of_.push_back(place->second);
      Kind& kind = kinds_[place->second];
      kind.slowest = std::min(kind.slowest, speeds_[r]);
      kind.fastest = std::max(kind.fastest, speeds_[r]);
      kind.order.insert({key(r), r});
    }
  }

  void set_load(Rank r, double load) {
    auto& order = kinds_[kind_of_[r]].order;
    order.erase({key(r), r});
    loads_[r] = load;
    order.insert({key(r), r});
  }

  /// The rank that would finish first if it had this work besides its load: `owner`, if no other is earlier, or of
  /// equals the lowest that `may(rank)` take it.
  template <class May>
  [[nodiscard]] Rank earliest(double work, Rank owner, const May& may) {
    Rank best = owner;
    double least = finish(owner, work);
    for (const Kind& kind : kinds_) {
      const double beyond = (work - typical_) / (work > typical_ ? kind.fastest : kind.slowest);
      for (const auto& [key, r] : kind.order) {
        ++examined_;
        if (key + beyond > least + rounding(least)) break;
        const double time = finish(r, work);
        if (time < least || (time == least && best != owner && r < best)) {
          if (!may(r)) continue;
          best = r;
          least = time;
        }
        if (kind.slowest == kind.fastest) break;  // the others are no earlier
      }
    }
    return best;
  }

  /// The rank whose load is furthest below what it does in `ideal` seconds; of equals the lowest.
  [[nodiscard]] Rank roomiest(double ideal) {
    Rank best{};
    double most = room(best, ideal);
    for (const Kind& kind : kinds_)
      for (const auto& [key, r] : kind.order) {
        ++examined_;
        const double left = ideal - key;
        const double bound = left * (left > 0 ? kind.fastest : kind.slowest) + typical_;
        if (bound < most - rounding(ideal * kind.fastest)) break;
        const double own = room(r, ideal);
        if (own > most || (own == most && r < best)) best = r, most = own;
      }
    return best;
  }

  /// Ranks looked at so far.
  [[nodiscard]] std::size_t examined() const { return examined_; }

 private:
  /// Ranks whose speeds differ by a few percent at most.
  struct Kind {
    double slowest = HUGE_VAL, fastest = 0;
    std::set<std::pair<double, Rank>> order;
  };
  static double rounding(double value) { return 1e-12 * std::abs(value); }

  [[nodiscard]] double finish(Rank r, double work) const { return (loads_[r] + work) / speeds_[r]; }
  [[nodiscard]] double room(Rank r, double ideal) const { return ideal * speeds_[r] - loads_[r]; }
  [[nodiscard]] double key(Rank r) const { return finish(r, typical_); }

  IdVector<Rank, double> speeds_, loads_;
  double typical_;
  std::vector<Kind> kinds_;
  IdVector<Rank, std::size_t> kind_of_;
  std::size_t examined_ = 0;
};

}  // namespace driftmesh::balancer
