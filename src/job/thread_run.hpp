#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/growing_array.hpp"
#include "decompose/subdomain_mesh.hpp"
#include "distributed/ranks.hpp"
#include "driftmesh/distributed_piece.hpp"
#include "driftmesh/files.hpp"
#include "job/checkpoints.hpp"
#include "job/facts_book.hpp"
#include "job/limits.hpp"
#include "job/order.hpp"
#include "job/place.hpp"
#include "job/pulse.hpp"
#include "job/rank_report.hpp"
#include "job/record.hpp"
#include "job/request.hpp"
#include "job/watch.hpp"
#include "runtime/threads/refinement_in_rounds.hpp"

namespace driftmesh::job {

/// The refinement of a mesh in subdomains by threads of this process, or of several, and its results, which do not
/// depend on the number of threads and processes.
class ThreadRun final : public Refined {
 public:
  /// `order`: its plan maps the subdomains to `threads` ranks; or to `ranks`, if not null, which refine them together
  /// and of which each has `threads` threads. With them, refine(), save(), take_piece() and take_live() are collective,
  /// and write() and report() are for those that know of them. `watch` and `ranks` outlive the object.
  ThreadRun(Order order, const Limits& limits, std::int32_t threads, Watch& watch, Ranks* ranks = nullptr);
  ~ThreadRun() override;

  /// Throws what the work on a subdomain or the watch throws, and LimitError at a limit. With checkpoints, one is left
  /// then (see Checkpoints). `pulse`: that of this rank, or null.
  void refine(Pulse* pulse = nullptr);
  /// What is left of the run meanwhile, if it ends at once.
  [[nodiscard]] KeyText left() const;

  // After refine():

  void report(RunRecord& record) override;
  /// What this process did, its threads as one.
  [[nodiscard]] RankReport rank_report();
  [[nodiscard]] int rounds() const { return refinement_->rounds(); }
  [[nodiscard]] const CheckpointRecord& checkpoints() const { return kept_; }
  [[nodiscard]] const std::vector<Point>& holes() const { return order_.pslg.holes; }
  [[nodiscard]] const RunPlan* plan() const override { return &order_.plan; }
  void write(const Request::Output& files, const Draw& draw, Watch& watch) override;
  [[nodiscard]] DistributedPiece take_piece(Watch& watch) override;
  [[nodiscard]] LiveMesh take_live(const Request& request) override;
  void save(const Request& request, Watch& watch) override;

 private:
  /// The plan for more generations.
  [[nodiscard]] RunPlan lasting_plan(const Request& request) const;
  /// The length that the size field asks for at each vertex; empty without one. `thread`: that asks.
  [[nodiscard]] GrowingArray<double, VertexId> lengths_at(const SubdomainMesh& part, std::size_t thread) const;
  /// Frees the subdomains and what they need.
  void release();
  /// Has checkpoints made at fences.
  void keep(RefinementInRounds::Watch& watch, Pulse* pulse);
  /// Goes on with what a checkpoint has of subdomains that are here.
  void take_up();
  void note(const Subdomain& subdomain, const SizeField* size);
  [[nodiscard]] MeshFacts facts();
  [[nodiscard]] std::vector<SubdomainCensus> census() const;
  [[nodiscard]] DistributedPiece assemble();
  [[nodiscard]] Ranks& ranks() { return ranks_ != nullptr ? *ranks_ : alone_; }
  void write_pieces(const std::string& path, const WriteOptions& options) const;

  Order order_;
  Ranks* ranks_;
  IdVector<SubdomainId, Rank> holders_;  // among these
  std::vector<const SizeField*> sizes_;  // that of the order for each thread
  Watch& watch_;
  Limits limits_;
  std::unique_ptr<ScratchFile> scratch_;  // if subdomains sleep on disk
  FactsBook book_;
  std::optional<RefinementInRounds> refinement_;
  OneRank alone_;
  std::optional<Checkpoints> checkpoints_;  // meanwhile
  CheckpointRecord kept_;
};

}  // namespace driftmesh::job
