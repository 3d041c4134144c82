#include "driftmesh/load_snapshot.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "balancer/snapshot/effort.hpp"
#include "protocol/packed_size.hpp"

namespace driftmesh::balancer {
namespace {

template <class States>
auto* find_in(States& states, SubdomainId id) {
  const auto place = std::ranges::lower_bound(states, id, {}, &SubdomainLoad::id);
  return place == states.end() || place->id != id ? nullptr : &*place;
}

}  // namespace

double memory_for(const SubdomainLoad& s) {
  return s.remaining + static_cast<double>(s.bytes) / protocol::kBytesPerTriangle;
}

bool leaves_before(const SubdomainLoad& a, const SubdomainLoad& b) {
  return std::tuple(weight_class(a), -a.turn, -a.remaining, a.id) <
         std::tuple(weight_class(b), -b.turn, -b.remaining, b.id);
}

std::vector<Part> present_parts(const LoadSnapshot& snapshot) {
  std::vector<Part> parts;
  for (const SubdomainLoad& s : snapshot.subdomains) parts.push_back(Part{to_int(s.owner)});
  return parts;
}

void sum_up(LoadSnapshot& snapshot) {
  for (RankLoad& rank : snapshot.ranks) rank.remaining = 0;
  for (const SubdomainLoad& s : snapshot.subdomains) snapshot.ranks[s.owner].remaining += s.remaining;
}

const SubdomainLoad* find(const LoadSnapshot& snapshot, SubdomainId id) {
  return find_in(snapshot.subdomains, id);
}

Rank owner_of(const LoadSnapshot& snapshot, SubdomainId id) {
  const SubdomainLoad* const known = find(snapshot, id);
  return known ? known->owner : (*snapshot.layout)[id].owner;
}

double mean_speed(IdSpan<Rank, const RankLoad> ranks) {
  double sum = 0;
  int known = 0;
  for (const RankLoad& rank : ranks)
    if (is_speed(rank.speed)) sum += rank.speed, ++known;
  return known > 0 ? sum / known : 1;
}

IdVector<Rank, double> assumed_speeds(IdSpan<Rank, const RankLoad> ranks) {
  const double mean = mean_speed(ranks);
  IdVector<Rank, double> speeds;
  speeds.reserve(ranks.size());
  for (const RankLoad& rank : ranks) speeds.push_back(is_speed(rank.speed) ? rank.speed : mean);
  return speeds;
}

double finishing_time(const LoadSnapshot& snapshot) {
  const IdVector<Rank, double> speeds = assumed_speeds(snapshot.ranks);
  double last = 0;
  for (const Rank r : ids_of(speeds)) last = std::max(last, snapshot.ranks[r].remaining / speeds[r]);
  return last;
}

double ideal_time(const LoadSnapshot& snapshot) {
  double work = 0, speed = 0;
  for (const RankLoad& rank : snapshot.ranks) work += rank.remaining;
  for (const double s : assumed_speeds(snapshot.ranks)) speed += s;
  return speed > 0 ? work / speed : 0;
}

bool is_open_border(const LoadSnapshot& snapshot, const SubdomainLoad& a, const SubdomainLoad& b) {
  const auto mostly_ahead = [&](const SubdomainLoad& s) {
    return 2 * s.remaining >= (*snapshot.layout)[s.id].predicted;
  };
  return mostly_ahead(a) && mostly_ahead(b);
}

double border_between_ranks(const LoadSnapshot& snapshot) {
  note_effort("border", static_cast<double>(snapshot.subdomains.size()));
  double twice = 0;
  for (const SubdomainLoad& s : snapshot.subdomains)
    for (const Neighbor& n : (*snapshot.layout)[s.id].neighbors) {
      const SubdomainLoad* const other = find(snapshot, n.subdomain);
      if (other && other->owner != s.owner && is_open_border(snapshot, s, *other)) twice += n.length;
    }
  return twice / 2;
}

LoadSnapshot after(LoadSnapshot snapshot, std::span<const Move> moves) {
  for (const Move& move : moves) {
    SubdomainLoad& s = *find_in(snapshot.subdomains, move.subdomain);
    snapshot.ranks[s.owner].remaining -= s.remaining;
    s.owner = move.destination;
    snapshot.ranks[s.owner].remaining += s.remaining;
  }
  return snapshot;
}

std::vector<Move> moves_between(const LoadSnapshot& from, const LoadSnapshot& to) {
  std::vector<Move> moves;
  for (std::size_t i = 0; i < from.subdomains.size(); ++i)
    if (from.subdomains[i].owner != to.subdomains[i].owner)
      moves.push_back({from.subdomains[i].id, to.subdomains[i].owner});
  return moves;
}

}  // namespace driftmesh::balancer
