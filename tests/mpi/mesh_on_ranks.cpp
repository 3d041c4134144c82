#include "mpi/mesh_on_ranks.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <optional>
#include <random>
#include <utility>

#include "balancer/policies/policy_factory.hpp"
#include "base/bytes.hpp"
#include "distributed/write_distributed.hpp"
#include "job/mpi/mpi_team.hpp"
#include "job/order.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/exceptions.hpp"
#include "protocol/counter_sum.hpp"
#include "support/delaying_transport.hpp"
#include "verify/report_text.hpp"
#include "verify/verify.hpp"

namespace driftmesh::mpi_test {
namespace {

using namespace driftmesh::protocol;

/// Moves random subdomains of this rank that have work to random ranks, every second time it is called.
class Mover {
 public:
  Mover(const Job& job, Rank self, std::int32_t ranks)
      : wanted_(job.moves), ranks_(ranks), random_(job.seed * 131 + static_cast<std::uint64_t>(self)) {}

  void look(SubdomainLoop& loop) {
    if (!wanted_ || random_() % 2 != 0) return;
    std::vector<SubdomainId> active;
    for (const auto& [id, subdomain] : loop.subdomains())
      if (subdomain.active()) active.push_back(id);
    if (active.empty()) return;
    const SubdomainId chosen = active[random_() % active.size()];
    if (loop.hand_over(chosen, static_cast<Rank>(random_() % static_cast<std::uint64_t>(ranks_)))) ++moved_;
  }
  [[nodiscard]] std::int64_t moved() const { return moved_; }

 private:
  bool wanted_;
  std::int32_t ranks_;
  std::mt19937_64 random_;
  std::int64_t moved_ = 0;
};

RunPlan plan_of(const Job& job, const QualityBounds& bounds, const Triangulation& mesh, std::int32_t ranks) {
  DecomposeOptions cutting;
  cutting.subdomains = job.subdomains;
  cutting.bounds = bounds;
  PlanOptions options;
  options.mapping.ranks = ranks;
  options.presplit = job.presplit;
  options.work.aggregation = 1 + job.seed % 20;
  options.work.slice = job.slice;
  options.work.sleep = job.sleep;
  options.balancing = job.balancing;
  return plan_run(decompose_for(mesh, cutting, ranks), bounds, options, balancer::make_policy);
}

/// A rank's share of the totals that are checked at the end.
struct Account {
  ProtocolCounters counters;
  std::int64_t balance = 0;  ///< Safra's count: sent minus handled
  std::int64_t forced = 0;
  bool at_work = false;
  std::vector<SubdomainId> owned;

  [[nodiscard]] Bytes pack() const {
    ByteWriter writer;
    writer.value(counters);
    writer.value(balance);
    writer.value(forced);
    writer.value(at_work);
    writer.array(owned);
    return writer.take();
  }
  static Account unpack(const Bytes& bytes) {
    ByteReader reader(bytes);
    Account account;
    reader.value(account.counters);
    reader.value(account.balance);
    reader.value(account.forced);
    reader.value(account.at_work);
    reader.array(account.owned);
    return account;
  }
};

Account account_of(const SubdomainLoop& loop, const Mover& mover) {
  Account own{
      loop.protocol().counters(), loop.protocol().termination().work_balance(), mover.moved(), loop.at_work(), {}};
  for (const auto& [id, subdomain] : loop.subdomains())
    if (loop.protocol().holds(id)) own.owned.push_back(id);
  return own;
}

void add_up(const std::vector<Bytes>& reports, std::size_t subdomains, Outcome& outcome) {
  IdVector<SubdomainId, int> owners(subdomains);
  std::int64_t balance = 0;
  ProtocolCounters& sum = outcome.counters;
  const auto complain = [&](const std::string& what) { outcome.problems.push_back(what); };
  for (const Bytes& bytes : reports) {
    const Account rank = Account::unpack(bytes);
    sum += rank.counters;
    balance += rank.balance;
    outcome.forced += rank.forced;
    for (const SubdomainId s : rank.owned) ++owners.at(s);
    if (rank.at_work) complain("a rank has finished with work left");
  }
  for (const SubdomainId s : ids_of(owners))
    if (owners[s] != 1) complain(fmt::format("subdomain {} has {} owners", to_int(s), owners[s]));
  if (sum.splits_sent != sum.splits_handled) complain("not every SPLIT that was sent has been handled once");
  if (sum.hand_offs != sum.arrivals) complain("not all subdomains that were handed over have arrived");
  if (balance != 0) complain(fmt::format("the counts of termination add up to {}", balance));
}

/// Keeps the last that it is told of all ranks.
class ToldOfAll final : public job::Watch {
 public:
  void refining_on_all(std::int64_t triangles, double /*forecast*/) override { last = triangles; }
  std::int64_t last = -1;
};

}  // namespace

Mesh gathered(job::Team& team, const job::RankRun& run) {
  const auto channel = team.open();
  ExchangeRunner ranks(channel->transport());
  const DistributedPiece piece = run.assemble(ranks);
  GatherPieces gathering(piece);
  ranks.run(gathering);
  channel->close();
  return gathering.whole();
}

Outcome run(const Job& job) {
  job::MpiTeam team(MpiSession::world());
  Triangulation mesh = triangulate(job.input);
  prepare_corners(mesh);
  Outcome outcome;
  outcome.leads = team.leads();
  outcome.bounds.plain.area = summarize_angles(mesh).total_area / job.cells;
  outcome.bounds.region_max_area = areas_by_region(job.input);
  job::Order order;
  order.plan = plan_of(job, outcome.bounds, mesh, team.ranks());
  order.pslg = job.input;
  order.shares.assign(to_index(team.ranks()), 1);
  if (job.drag) order.shares[static_cast<Rank>(job.seed % order.shares.size())] = 0.2;

  ToldOfAll watch;
  job::RankRun run(team, std::move(order), {}, nullptr, watch);
  Mover mover(job, team.rank(), team.ranks());
  std::optional<DelayingTransport> delaying;
  run.refine(false,
             {.through = [&](Transport& inner) -> Transport& { return delaying.emplace(inner, job.seed, job.delay); },
              .before_step = [&](SubdomainLoop& loop) { mover.look(loop); },
              .after_slice = {}});
  const std::vector<Bytes> reports = team.gather(account_of(run.loop(), mover).pack());
  if (outcome.leads) add_up(reports, run.plan().owners.size(), outcome);
  outcome.mesh = gathered(team, run);
  const bool tells = outcome.leads && team.ranks() > 1;
  if (tells && std::cmp_not_equal(watch.last, outcome.mesh.triangles.size()))
    outcome.problems.push_back(
        fmt::format("rank 0 was told of {} triangles at the end, of {}", watch.last, outcome.mesh.triangles.size()));
  team.close();
  return outcome;
}

void check(const Job& job, const Outcome& outcome) {
  if (!outcome.leads) return;
  for (const std::string& problem : outcome.problems) FAIL_CHECK(problem);
  const VerifyOptions options{.min_angle = outcome.bounds.min_angle, .plain = {.area = outcome.bounds.plain.area}};
  const VerifyReport report = verify(outcome.mesh, job.input, options);
  CHECK_MESSAGE(report.accepted(), report_text(report, options));
  CHECK(outcome.mesh.triangles.size() > job.cells);
}

}  // namespace driftmesh::mpi_test
