#include "app/real_cluster.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

#include "app/drag.hpp"
#include "app/limits.hpp"
#include "app/memory.hpp"
#include "app/rank_report.hpp"
#include "balancer/mpi/mpi_council.hpp"
#include "base/byte_stream.hpp"
#include "base/error.hpp"
#include "cluster/rank_log.hpp"
#include "protocol/rank_step.hpp"
#include "runtime/plan_bytes.hpp"
#include "runtime/rank_loop.hpp"

namespace driftmesh::app {
namespace {

using protocol::Bytes;

protocol::MpiSession begin_session() {
  static int argc = 0;
  static char** argv = nullptr;
  return {argc, argv};
}

Bytes pack(const RealRun& run) {
  ByteWriter writer;
  writer.array(plan_to_bytes(run.plan));
  writer.text(run.sizing.expression);
  writer.text(run.sizing.background);
  writer.value(run.sizing.gradation.value_or(0));
  writer.value(run.sizing.longest);
  writer.value(run.sizing.shortest);
  writer.array(run.shares);
  return writer.take();
}

RealRun unpack(const Bytes& bytes, std::int32_t ranks) {
  ByteReader reader(bytes);
  RealRun run;
  Bytes plan;
  reader.array(plan);
  run.plan = plan_from_bytes(plan, ranks);
  run.sizing.expression = reader.text();
  run.sizing.background = reader.text();
  if (const auto gradation = reader.value<double>(); gradation > 0) run.sizing.gradation = gradation;
  reader.value(run.sizing.longest);
  reader.value(run.sizing.shortest);
  reader.array(run.shares);
  return run;
}

double forecast_of(const RunPlan& plan, protocol::Rank rank) {
  double forecast = 0;
  for (std::size_t s = 0; s < plan.owners.size(); ++s)
    if (plan.owners[s] == rank) forecast += plan.decomposition.subdomains[s].predicted;
  return forecast;
}

/// One run on this rank: its report and its log.
Bytes refine(protocol::MpiTransport& transport, RealRun run, const RealCluster::Progress& progress,
             const std::function<void()>& wait_for_all) {
  RunPlan& plan = run.plan;
  const std::unique_ptr<SizeField> size = make_size_field(run.sizing);
  plan.bounds.size = size.get();
  plan.max_triangles = find_limits({}, {}, protocol::MpiSession::ranks_on_this_machine()).triangles;
  const double share = run.shares[static_cast<std::size_t>(transport.rank())];
  const double forecast = forecast_of(plan, transport.rank());

  wait_for_all();
  RankLog log(transport, plan);
  RankLoop::Observers observers;
  observers.after_slice = [&](const RankLoop& loop, const RankLoop::Slice& slice) {
    if (progress) progress(loop.triangles(), forecast);
    const double begin = transport.now();
    drag(share, slice.seconds);
    log.worked(loop, slice, slice.seconds + (transport.now() - begin));
  };
  observers.handed_over = [&](const RankLoop& loop, const RankLoop::Passage& passage) { log.departs(loop, passage); };
  observers.settled = [&](const RankLoop& loop, const RankLoop::Passage& passage) { log.arrives(loop, passage); };
  observers.stalled = [](const std::string& why) { fmt::print(stderr, "driftmesh: {}\n", why); };
  const auto council = balancer::make_mpi_council(transport, plan.layout, plan.policy, plan.balancing.options);
  RankLoop loop(transport, plan, CostModel{}, observers, council.get());
  log.begins(loop);
  protocol::run_rank(transport, [&] { return loop.step(); });
  log.ends(loop);

  RankReport report = report_of(loop, plan);
  report.rank.peak = peak_memory();
  ByteWriter writer;
  report.write(writer);
  log.write(writer);
  return writer.take();
}

}  // namespace

RealCluster::RealCluster() : session_(begin_session()), control_(protocol::MpiSession::world()) {}

RealCluster::~RealCluster() {
  if (leads()) static_cast<void>(control_.broadcast({}));  // no more runs
}

ClusterRun RealCluster::run(const RealRun& run, RunRecord& record, const Progress& progress) {
  std::vector<RankLog> logs;
  for (const Bytes& bytes : take_part(control_.broadcast(pack(run)), progress)) {
    ByteReader reader(bytes);
    add_report(record, RankReport::read(reader));
    logs.push_back(RankLog::read(reader));
  }
  add_plan(record, run.plan);
  return RankLog::join(logs);
}

void RealCluster::serve() {
  for (Bytes order = control_.broadcast({}); !order.empty(); order = control_.broadcast({}))
    static_cast<void>(take_part(order, {}));
}

std::vector<Bytes> RealCluster::take_part(const Bytes& order, const Progress& progress) {
  try {
    protocol::MpiTransport transport(protocol::MpiSession::world());
    const auto wait_for_all = [&] {
      static_cast<void>(control_.gather({}));
      static_cast<void>(control_.broadcast({}));
    };
    const Bytes own = refine(transport, unpack(order, ranks()), progress, wait_for_all);
    transport.close();
    return control_.gather(own);
  } catch (const std::exception& error) {
    if (ranks() == 1) throw;
    protocol::MpiSession::abort(fmt::format("driftmesh: rank {}: {}", control_.rank(), error.what()));
  }
}

}  // namespace driftmesh::app
