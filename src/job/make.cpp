#include "job/make.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/stopwatch.hpp"
#include "distributed/piece_series.hpp"
#include "distributed/write_distributed.hpp"
#include "job/check.hpp"
#include "job/checkpoint_file.hpp"
#include "job/prepare.hpp"
#include "job/rank_report.hpp"
#include "job/write_files.hpp"
#include "mesh/narrow_place.hpp"
#include "sizing/size_tree_file.hpp"

namespace driftmesh::job {
namespace {

/// A large domain is cut where one piece was in view.
PlaceKind kind_when_cut(const Place& place) {
  return place.kind() == kOnePiece ? kSubdomains : place.kind();
}

Use use_of(const Asked& asked, const Place& place, bool cut, double forecast) {
  const Wanted& wanted = asked.wanted;
  Use use{.by = asked.by, .in_subdomains = cut || (place.kind() & kMany) != 0, .writes = wanted.mesh};
  if (!cut) return use;
  use.stores = !asked.request.run.scratch.empty();
  use.sleeps = asked.request.run.sleep || use.stores;
  use.gathers = wanted.gathered && place.processes().all > 1;
  if (kind_when_cut(place) == kSubdomains && !wanted.whole && place.processes().all == 1)  // each thread a piece
    use.at_once = std::min(1.0, static_cast<double>(place.ranks()) * kTrianglesInSeries / forecast);
  return use;
}

/// Subdomains sleep where memory is short. In virtual time, which that would change, they do as they are told.
Limits limits_with_sleep(const Asked& asked, const Place& place, const Pslg& pslg, double forecast, Use& use) {
  const Request::Limits& limits = asked.request.limits;
  Limits found = find_limits(limits, pslg, use, place.processes());
  if (use.sleeps || place.kind() == kSimulated || !(forecast > static_cast<double>(found.in_memory))) return found;
  use.sleeps = true;
  return find_limits(limits, pslg, use, place.processes());
}

void check_capacity(const Asked& asked, const Place& place, const Decomposition& decomposition, double forecast,
                    const Use& use) {
  double subdomain = 0;
  for (const Decomposition::Subdomain& s : decomposition.subdomains) subdomain = std::max(subdomain, s.predicted);
  const int processes = place.processes().all;
  const bool whole = processes == 1 ? asked.wanted.whole : asked.wanted.gathered;
  const double file = whole ? forecast : forecast * use.at_once / processes;
  check_capacity(subdomain, use.writes ? file : 0, use.by);
}

Order in_one_piece(const Asked& asked, const Place& place, Domain&& domain, Triangulated&& triangulated,
                   RunRecord& record) {
  const Request::Limits& limits = asked.request.limits;
  const Use use = use_of(asked, place, false, triangulated.forecast);
  if (!limits.keep_incomplete)
    check_forecast(find_limits(limits, domain.pslg, use, place.processes()), triangulated.forecast, asked.by == kMesh,
                   [&] { return find_narrow_place(triangulated.mesh); });
  record.acute_corners = triangulated.acute_corners;
  record.forecast = triangulated.forecast;
  record.max_area = triangulated.bounds.plain.area;
  Order order;
  order.limits = limits;
  order.use = use;
  if (place.kind() == kRanks) {  // each of them triangulates it
    order.plan.bounds = std::move(triangulated.bounds);
    order.plan.bounds.size = nullptr;
    order.plan.bounds.step = nullptr;
    order.pslg = std::move(domain.pslg);
    order.shares = place.speeds(asked.request);
  } else {
    order.whole = Whole{std::move(domain), std::move(triangulated)};
  }
  return order;
}

Keeping keeping_of(const Request& request) {
  return {request.run.checkpoint, request.run.every, request.run.resume, {}};
}

Order in_subdomains(const Asked& asked, const Place& place, Domain&& domain, const Triangulated& triangulated,
                    RunRecord& record, Watch& watch) {
  const Request& request = asked.request;
  Use use = use_of(asked, place, true, triangulated.forecast);
  const Limits limits = limits_with_sleep(asked, place, domain.pslg, triangulated.forecast, use);
  check_forecast(limits, triangulated.forecast, false, [&] { return find_narrow_place(triangulated.mesh); });
  const IdVector<Rank, double> speeds = place.speeds(request);
  Prepared prepared = prepare(request, domain, triangulated, asked.given, kind_when_cut(place), speeds, watch);
  check_capacity(asked, place, prepared.plan.decomposition, prepared.forecast, use);
  watch.pieces(place.pieces(prepared.plan.decomposition));
  add_prepared(record, prepared);
  prepared.plan.work.sleep = use.sleeps;
  prepared.plan.bounds.size = nullptr;  // see Order::size
  prepared.plan.bounds.step = nullptr;
  domain.pslg.holes = triangulated.holes;
  return {.plan = std::move(prepared.plan),
          .pslg = std::move(domain.pslg),
          .sizing = request.sizing,
          .limits = request.limits,
          .patience = request.patience,
          .shares = speeds,
          .use = use,
          .scratch = request.run.scratch,
          .keeping = keeping_of(request),
          .rasters = std::move(domain.rasters),
          .size = std::move(domain.size),
          .step = std::move(domain.step)};
}

/// The order of a run that has ended before its time, for the present place.
Order going_on(const Asked& asked, const Place& place, RunRecord& record, Watch& watch) {
  const Request& request = asked.request;
  const IdVector<Rank, double> speeds = place.speeds(request);
  Order order =
      timed(watch, "load", [&] { return resumed_order(request, static_cast<std::int32_t>(speeds.size()), record); });
  Use use = use_of(asked, place, true, record.forecast);
  const Limits limits = limits_with_sleep(asked, place, order.pslg, record.forecast, use);
  check_forecast(limits, record.forecast, false, {});
  check_capacity(asked, place, order.plan.decomposition, record.forecast, use);
  plan_anew(order.plan, request, kind_when_cut(place), speeds);
  order.plan.work.sleep = use.sleeps;
  watch.pieces(place.pieces(order.plan.decomposition));
  order.limits = request.limits;
  order.patience = request.patience;
  order.shares = speeds;
  order.use = use;
  order.scratch = request.run.scratch;
  order.keeping = keeping_of(request);
  return order;
}

/// The number of ranks on which a number of triangles for each rank depends.
std::int32_t ranks_counted(const Place& place) {
  return (place.kind() & kMany) != 0 ? place.ranks() : 1;
}

/// Where the lengths are compiled at all, they are those of a size tree.
void save_sizes(const Request& request, const Domain& domain, const Triangulated& triangulated, Watch& watch) {
  if (request.sizing.save_tree.empty()) return;
  std::vector<CornerPoints> triangles;
  const Triangulation& mesh = triangulated.mesh;
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive()) triangles.push_back({mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)});
  timed(watch, "save sizes", [&] {
    write_size_tree(dynamic_cast<const SizeTree&>(*domain.size), triangles, domain_digest(domain.pslg),
                    request.sizing.save_tree);
  });
}

Order new_order(const Asked& asked, const Place& place, RunRecord& record, Watch& watch) {
  const Request& request = asked.request;
  Domain domain = read_domain(request, asked.given, watch);
  record_domain(record, request, domain);
  Triangulated triangulated = triangulate_domain(request, domain, ranks_counted(place), place.cut(request), watch);
  save_sizes(request, domain, triangulated, watch);
  if (!triangulated.cut) return in_one_piece(asked, place, std::move(domain), std::move(triangulated), record);
  return in_subdomains(asked, place, std::move(domain), triangulated, record, watch);
}

Order order_for(const Asked& asked, const Place& place, RunRecord& record, Watch& watch) {
  const Request& request = asked.request;
  check(request, place.kind(), asked.given.policies);
  if (!place.is_team()) check_alone(request);
  if (request.run.method == Method::kPdr && place.cut(request) == Cut::kAlways)
    throw KeyError("run.method", "is pdr, which only experiments have", "use driftmesh run");
  if (place.kind() != kSimulated) check_ranks(request, place.kind(), ranks_counted(place));
  if (asked.before) asked.before();
  if (asked.by != kLibrary) cap_memory(request.limits);
  const bool is_new = request.run.resume.empty();
  Order order = is_new ? new_order(asked, place, record, watch) : going_on(asked, place, record, watch);
  if (!request.run.checkpoint.empty()) order.keeping.heads = checkpoint_heads(request, record, order);
  return order;
}

const Pslg& input_of(const Order& order) {
  return order.whole ? order.whole->domain.pslg : order.pslg;
}

/// Each rank has its own memory.
std::unique_ptr<Refined> obey(Place& place, Order&& order, const SizeField* size, Watch& watch) {
  const Limits limits = find_limits(order.limits, input_of(order), order.use, place.processes());
  return timed(watch, "refine", [&] { return place.refine(std::move(order), limits, size, watch); });
}

TriangulatedDomain triangulated_at(const Asked& asked, PlaceKind kind, std::int32_t ranks, Cut cut, Watch& watch) {
  check(asked.request, kind, asked.given.policies);
  TriangulatedDomain made{read_domain(asked.request, asked.given, watch), {}};
  made.triangulated = triangulate_domain(asked.request, made.domain, ranks, cut, watch);
  return made;
}

}  // namespace

Wanted wanted_of(const Request::Output& output) {
  const bool draws = !output.picture.empty();
  return {.mesh = draws || !output.meshes.empty(),
          .whole = needs_whole(output),
          .gathered = draws || !std::ranges::all_of(output.meshes, is_written_by_all)};
}

std::unique_ptr<Refined> make(const Asked& asked, Place& place, RunRecord& record, Watch& watch) {
  return obey(place, place.share([&] { return order_for(asked, place, record, watch); }), asked.given.size, watch);
}

std::unique_ptr<Refined> follow(Place& place, Watch& watch) {
  return obey(place, place.share({}), nullptr, watch);
}

TriangulatedDomain make_triangulated(const Asked& asked, Watch& watch) {
  return triangulated_at(asked, kOnePiece, 1, Cut::kNever, watch);
}

CutDomain make_cut(const Asked& asked, std::int32_t ranks, Watch& watch) {
  auto [domain, triangulated] = triangulated_at(asked, ranks > 1 ? kRanks : kSubdomains, ranks, Cut::kAlways, watch);
  const Stopwatch cutting;
  Decomposition decomposition = cut(asked.request, triangulated, ranks);
  return {std::move(domain), std::move(decomposition), cutting.seconds()};
}

}  // namespace driftmesh::job
