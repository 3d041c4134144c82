// How even a mesh that follows a front keeps many ranks, in virtual time: the mesh is real and made here, ranks are
// not. A solver takes the same time for each triangle and step; making a generation, moving subdomains and waiting for
// the slowest rank is what is lost. Prints rows for bench/adaptive.py, which makes a table of them, after every fifth
// generation.
//
// usage: driftmesh_bench_adaptive_ranks [RANKS [SUBDOMAINS PER RANK [SHORTEST LENGTH [GENERATIONS]]]]

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "adapt/few_moves.hpp"
#include "adapt/session.hpp"
#include "balancer/zoltan/zoltan_partition.hpp"
#include "decompose/decomposition.hpp"
#include "driftmesh/pslg.hpp"
#include "job/here.hpp"
#include "job/make.hpp"
#include "job/request.hpp"
#include "protocol/mpi/mpi_transport.hpp"
#include "runtime/plan_run.hpp"

using namespace driftmesh;

namespace {

constexpr double kWidth = 0.06, kGrowth = 0.2, kRadius = 0.15, kSpeed = 0.003;  // the ring in bench/adaptive.py
constexpr double kSolver = 1e-6;                                                // seconds for a triangle and a step
constexpr int kSteps = 20;                                                      // in a generation
constexpr double kBandwidth = 1e9;                                              // bytes per second of a rank
constexpr double kPacking = 1e-7;  // seconds for a triangle, on either side

struct Options {
  int ranks = 512;
  int each = 8;  // subdomains
  double shortest = 0.001;
  int generations = 20;
};

double length_at(const Point& p, double shortest, int generation) {
  const double away = std::abs(std::hypot(p.x - 0.5, p.y - 0.5) - kRadius - kSpeed * generation) - kWidth / 2;
  return shortest + kGrowth * std::max(0.0, away);
}

class Ring final : public SizeField {
 public:
  explicit Ring(double shortest) : shortest_(shortest) {}
  [[nodiscard]] double edge_length(const Point& p) const override { return length_at(p, shortest_, 0); }

 private:
  double shortest_;
};

adapt::Session first_generation(const Options& options, const adapt::Means& means) {
  Pslg square;
  square.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  square.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
  job::Request request;
  request.decomposition.subdomains = options.ranks * options.each;
  const Ring ring(options.shortest);
  job::Given given;
  given.input = &square;
  given.size = &ring;
  job::Here here(job::kSubdomains, means.threads);
  job::RunRecord record;
  job::Watch watch;
  job::LiveMesh live = job::make({request, job::kLibrary, given, {.mesh = true, .whole = true}}, here, record, watch)
                           ->take_live(request);
  return {adapt::Start{std::move(live.plan), std::move(live.pslg), std::move(live.parts), std::move(live.lengths)},
          {.gradation = kGrowth},
          [](Mesh&) {},
          means};
}

/// What there is in a generation, by subdomain.
struct Counts {
  IdVector<SubdomainId, double> triangles, made;
  IdVector<SubdomainId, double> divided;  // its share in the time of dividing
  double all = 0, all_made = 0;
};

void set_divided(const adapt::Session& session, Counts& counts) {
  const auto parents = session.parents();
  std::map<std::vector<std::int32_t>, int> parts_of;
  for (const auto& of_one : parents) ++parts_of[of_one];
  double all = 0;
  for (const SubdomainId s : ids_of(counts.divided))
    if (parts_of[parents[to_index(s)]] > 1) all += counts.divided[s] = counts.triangles[s];
  for (double& share : counts.divided) share /= std::max(1.0, all);
}

Counts counts_of(const adapt::Session& session) {
  const std::size_t parts = session.decomposition().size();
  const IdVector<SubdomainId, double> none(parts, 0.0);
  Counts counts{none, none, none};
  const Mesh& mesh = session.piece().mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto s = static_cast<SubdomainId>(mesh.subdomains[t]);
    const bool is_new = !session.stayed_triangles().empty() && session.stayed_triangles()[t] < 0;
    counts.triangles[s] += 1, counts.all += 1;
    if (is_new) counts.made[s] += 1, counts.all_made += 1;
  }
  set_divided(session, counts);
  return counts;
}

using Holders = IdVector<SubdomainId, Rank>;

Holders by_zoltan(const adapt::Session& session, const adapt::Loads& loads, const Holders& holders,
                  const balancer::ZoltanParameters& parameters) {
  balancer::LoadSnapshot snapshot;
  snapshot.layout = layout_of(session.decomposition(), holders, static_cast<std::int32_t>(loads.speeds.size()));
  for (const double speed : loads.speeds) snapshot.ranks.push_back({.speed = speed});
  for (const SubdomainId s : ids_of(loads.work)) {
    snapshot.ranks[holders[s]].remaining += loads.work[s];
    snapshot.subdomains.push_back({.id = s,
                                   .owner = holders[s],
                                   .remaining = loads.work[s],
                                   .bytes = static_cast<std::uint64_t>(loads.bytes[s]),
                                   .cost = loads.bytes[s]});
  }
  Holders next;
  for (const balancer::Part part : balancer::zoltan_partition(snapshot, parameters))
    next.push_back(static_cast<Rank>(part));
  return next;
}

/// A way of placing, with what came of it.
struct Way {
  std::string name;
  std::function<Holders(const adapt::Loads&, const Holders&)> place;
  Holders holders{};
  double solving = 0, total = 0, moved = 0, worst = 1;
};

double slowest(const Holders& holders, std::size_t ranks, const std::function<double(SubdomainId)>& seconds) {
  IdVector<Rank, double> all(ranks, 0.0);
  for (const SubdomainId s : ids_of(holders)) all[holders[s]] += seconds(s);
  return *std::ranges::max_element(all);
}

/// What is joined goes to the rank of the largest of its parts, and what is divided is where it was.
void follow(Way& way, const std::vector<std::vector<std::int32_t>>& parents, const Counts& before) {
  Holders next;
  IdVector<SubdomainId, bool> seen(way.holders.size(), false);
  for (const auto& of_one : parents) {
    const auto triangles_of = [&](std::int32_t s) { return before.triangles[SubdomainId{s}]; };
    const Rank holder = way.holders[SubdomainId{*std::ranges::max_element(of_one, {}, triangles_of)}];
    for (const std::int32_t s : of_one) {
      if (!seen[SubdomainId{s}] && way.holders[SubdomainId{s}] != holder) way.moved += triangles_of(s);
      seen[SubdomainId{s}] = true;
    }
    next.push_back(holder);
  }
  way.holders = std::move(next);
}

/// A generation is made by those who hold it, then subdomains move, then the solver works.
void advance(Way& way, const adapt::Loads& loads, const Counts& counts, const AdaptReport& report) {
  const std::size_t ranks = loads.speeds.size();
  const double each_new = report.refine / std::max(1.0, counts.all_made);
  const double each = (report.lengths + report.join + report.assemble + report.transfer) / counts.all;
  way.total += slowest(way.holders, ranks, [&](SubdomainId s) {
    return each_new * counts.made[s] + each * counts.triangles[s] + report.divide * counts.divided[s];
  });
  const Holders next =
      adapt::imbalance(loads, way.holders) > adapt::kEven ? way.place(loads, way.holders) : way.holders;
  IdVector<Rank, double> moving(ranks, 0.0);
  for (const SubdomainId s : ids_of(next)) {
    if (next[s] == way.holders[s]) continue;
    const double seconds = loads.bytes[s] / kBandwidth + kPacking * counts.triangles[s];
    moving[next[s]] += seconds;
    moving[way.holders[s]] += seconds;
    way.moved += counts.triangles[s];
  }
  way.holders = next;
  way.total += *std::ranges::max_element(moving);
  way.total += slowest(next, ranks, [&](SubdomainId s) { return kSteps * kSolver * counts.triangles[s]; });
  way.solving += kSteps * kSolver * counts.all / static_cast<double>(ranks);
  way.worst = std::max(way.worst, adapt::imbalance(loads, next));
}

void run(const Options& options) {
  OneRank alone;
  const adapt::Means means{.ranks = alone, .threads = 1};
  adapt::Session session = first_generation(options, means);
  session.attach("u", std::vector<double>(session.piece().mesh.points.size(), 1), FieldPlace::kPoints,
                 Transfer::kInterpolate, means);
  const balancer::ZoltanParameters kept{
      {"LB_METHOD", "GRAPH"}, {"GRAPH_PACKAGE", "PHG"}, {"IMBALANCE_TOL", "1.03"}, {"PHG_EDGE_SIZE_THRESHOLD", "1.0"}};
  balancer::ZoltanParameters anew = kept;
  anew["LB_APPROACH"] = "PARTITION";
  const auto by = [&](const balancer::ZoltanParameters& parameters) {
    return [&](const adapt::Loads& loads, const Holders& holders) {
      return by_zoltan(session, loads, holders, parameters);
    };
  };
  const auto repartition = by(kept);
  std::vector<Way> ways{{"none", [](const adapt::Loads&, const Holders& holders) { return holders; }},
                        {"ours",
                         [&](const adapt::Loads& loads, const Holders& holders) {
                           return adapt::even_holders(loads, holders, session.decomposition(),
                                                      [&] { return repartition(loads, holders); });
                         }},
                        {"repartition", repartition},
                        {"from scratch", by(anew)}};
  const auto ranks = static_cast<std::size_t>(options.ranks);
  const auto loads_of = [&](const Counts& counts) {
    adapt::Loads loads;
    loads.work = counts.triangles;
    for (const double triangles : counts.triangles) loads.bytes.push_back(60 * triangles);
    loads.speeds = IdVector<Rank, double>(ranks, 0.0);
    return loads;
  };
  Counts before = counts_of(session);
  const adapt::Loads first = loads_of(before);
  Holders start;
  for (const SubdomainId s : ids_of(first.work))
    start.push_back(static_cast<Rank>(to_index(s) * ranks / first.work.size()));
  start = by(anew)(first, start);
  for (Way& way : ways) way.holders = start;
  double largest = 0;
  for (int generation = 1; generation <= options.generations; ++generation) {
    std::vector<double> lengths;
    for (const Point& p : session.piece().mesh.points) lengths.push_back(length_at(p, options.shortest, generation));
    session.adapt(lengths, means, {});
    const Counts counts = counts_of(session);
    const adapt::Loads loads = loads_of(counts);
    for (Way& way : ways) follow(way, session.parents(), before);
    for (Way& way : ways) advance(way, loads, counts, session.report());
    before = counts;
    largest = std::max(largest, *std::ranges::max_element(counts.triangles) * options.ranks / counts.all);
    if (generation % 5 != 0) continue;
    for (const Way& way : ways)
      fmt::print("| {} | {:.0f} | {} | {:.1f} % | {:.2f} | {:.0f} | {:.2f} |\n", generation, counts.all, way.name,
                 100 * way.solving / way.total, way.worst, way.moved, largest);
  }
}

}  // namespace

int main(int count, char** words) {
  Options options;
  if (count > 1) options.ranks = std::atoi(words[1]);
  if (count > 2) options.each = std::atoi(words[2]);
  if (count > 3) options.shortest = std::atof(words[3]);
  if (count > 4) options.generations = std::atoi(words[4]);
  const protocol::MpiSession session;
  run(options);
  return 0;
}
