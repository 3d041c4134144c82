#include "adapt/loads.hpp"

#include <algorithm>
#include <cmath>

#include "adapt/of_all_parts.hpp"
#include "base/bytes.hpp"
#include "base/formatted.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh::adapt {
namespace {

double triangles_of(const Part& part) {
  return static_cast<double>(part.mesh->mesh.live_triangles());
}

void require_sound(const Generation& before, const Spent& spent) {
  const auto require_seconds = [](double seconds) {
    if (!(seconds >= 0 && std::isfinite(seconds)))
      throw Error(formatted("spent: {} seconds were told; time must be at least 0, and finite", seconds));
  };
  if (spent.on_rank) require_seconds(*spent.on_rank);
  if (!spent.on_parts) return;
  if (spent.on_parts->size() != before.here.size())
    throw Error(formatted("spent: there are {} numbers of seconds for {} subdomains; give one for each of this rank",
                          spent.on_parts->size(), before.here.size()));
  std::ranges::for_each(*spent.on_parts, require_seconds);
}

/// What one rank tells all.
struct ToldByRank {
  double seconds = 0;  ///< -1: none for the rank as a whole
  double triangles = 0;
  std::int64_t by_parts = 0;
};

std::vector<ToldByRank> told_by_all(const Generation& before, const Spent& spent, Ranks& ranks) {
  ToldByRank own{spent.on_rank.value_or(-1), 0, spent.on_parts ? 1 : 0};
  for (const SubdomainId s : before.here) own.triangles += triangles_of(before.parts[s]);
  ByteWriter writer;
  writer.value(own);
  std::vector<ToldByRank> all;
  for (const Bytes& bytes : ranks.bytes_of_all(writer.take())) ByteReader(bytes).value(all.emplace_back());
  return all;
}

/// A part takes its packed form and its share of fields.
double bytes_of(const Generation& generation, SubdomainId s, const Fields& fields) {
  constexpr double kBytesPacked = 32;  // per triangle, with half a point
  double bytes = kBytesPacked;
  for (const auto& [name, field] : fields) {
    const double places = field.place == FieldPlace::kPoints ? 0.5 : field.place == FieldPlace::kCorners ? 3 : 1;
    bytes += places * static_cast<double>(field.components) * sizeof(double);
  }
  return bytes * triangles_of(generation.parts[s]);
}

/// Seconds a triangle, of the parts after.
IdVector<SubdomainId, double> costs_of(const Generation& before, const Descendants& descendants,
                                       const std::vector<double>& seconds, Ranks& ranks) {
  struct Cost {
    double seconds = 0, triangles = 0;
  };
  const IdVector<SubdomainId, Cost> told = of_all_parts(ranks, before, [&](SubdomainId s) {
    const auto i = std::ranges::lower_bound(before.here, s) - before.here.begin();
    return Cost{seconds[static_cast<std::size_t>(i)], triangles_of(before.parts[s])};
  });
  IdVector<SubdomainId, Cost> of_whole(before.parts.size());
  for (const SubdomainId s : ids_of(told)) {
    of_whole[descendants.whole[s]].seconds += told[s].seconds;
    of_whole[descendants.whole[s]].triangles += told[s].triangles;
  }
  IdVector<SubdomainId, double> costs;
  for (const SubdomainId whole : descendants.whole_of)
    costs.push_back(of_whole[whole].seconds / of_whole[whole].triangles);
  return costs;
}

}  // namespace

Loads loads_of(const Generation& before, const Generation& after, const Descendants& descendants, const Fields& fields,
               const Spent& spent, Ranks& ranks) {
  ranks.agree([&] { require_sound(before, spent); });
  const std::vector<ToldByRank> told = told_by_all(before, spent, ranks);
  const bool by_parts = std::ranges::all_of(told, [](const ToldByRank& t) { return t.by_parts != 0; });
  Loads loads;
  for (const ToldByRank& t : told) loads.speeds.push_back(!by_parts && t.seconds > 0 ? t.triangles / t.seconds : 0);
  loads.bytes = of_all_parts(ranks, after, [&](SubdomainId s) { return bytes_of(after, s, fields); });
  loads.work = of_all_parts(ranks, after, [&](SubdomainId s) { return triangles_of(after.parts[s]); });
  if (!by_parts) return loads;
  const IdVector<SubdomainId, double> costs = costs_of(before, descendants, *spent.on_parts, ranks);
  double seconds = 0, triangles = 0;
  for (const SubdomainId s : ids_of(costs)) {
    seconds += costs[s] * loads.work[s];
    triangles += loads.work[s];
  }
  for (const SubdomainId s : ids_of(costs))
    if (seconds > 0) loads.work[s] *= costs[s] * triangles / seconds;
  return loads;
}

IdVector<Rank, double> speeds_of(const Loads& loads) {
  double known = 0, count = 0;
  for (const double speed : loads.speeds)
    if (speed > 0) known += speed, ++count;
  IdVector<Rank, double> speeds = loads.speeds;
  for (double& speed : speeds)
    if (!(speed > 0)) speed = count > 0 ? known / count : 1;
  return speeds;
}

double imbalance(const Loads& loads, const IdVector<SubdomainId, Rank>& holders) {
  const IdVector<Rank, double> speed_of = speeds_of(loads);
  IdVector<Rank, double> work(speed_of.size(), 0.0);
  double all = 0, speeds = 0, slowest = 0;
  for (const SubdomainId s : ids_of(holders)) {
    work[holders[s]] += loads.work[s];
    all += loads.work[s];
  }
  for (const Rank r : ids_of(work)) {
    speeds += speed_of[r];
    slowest = std::max(slowest, work[r] / speed_of[r]);
  }
  return all > 0 ? std::max(1.0, slowest * speeds / all) : 1;
}

}  // namespace driftmesh::adapt
