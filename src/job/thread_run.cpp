#include "job/thread_run.hpp"

#include <algorithm>
#include <utility>

#include "adapt/generation.hpp"
#include "adapt/parcel.hpp"
#include "adapt/saved.hpp"
#include "base/in_parts.hpp"
#include "base/key_error.hpp"
#include "distributed/assembly.hpp"
#include "distributed/held_subdomains.hpp"
#include "distributed/packed_parts.hpp"
#include "distributed/parts_file.hpp"
#include "distributed/piece_series.hpp"
#include "distributed/write_distributed.hpp"
#include "driftmesh/error.hpp"
#include "io/other_coordinates.hpp"
#include "job/domain.hpp"
#include "job/memory.hpp"
#include "job/rank_report.hpp"
#include "job/sleeping_room.hpp"
#include "job/write_files.hpp"
#include "runtime/plan_run.hpp"

namespace driftmesh::job {

ThreadRun::ThreadRun(Order order, const Limits& limits, std::int32_t threads, Watch& watch, Ranks* ranks)
    : order_(std::move(order)), ranks_(ranks), watch_(watch), limits_(limits), book_(order_.plan.decomposition) {
  if (ranks_ != nullptr) {
    holders_ = order_.plan.owners;
    deal_to_threads(order_.plan, threads, [this](SubdomainId s) { return holders_[s] == ranks_->rank(); });
  }
  sizes_.assign(to_index(threads), order_.size.get());
  order_.plan.bounds.size = sizes_.front();
  order_.plan.bounds.step = order_.step.get();
  scratch_ = open_scratch(order_.scratch, forecast_of(order_.plan));
  order_.plan.scratch = scratch_.get();
}

ThreadRun::~ThreadRun() {
  release();
}

void ThreadRun::release() {
  refinement_.reset();
  if (scratch_) scratch_->discard();
  scratch_.reset();
  order_.plan.scratch = nullptr;
  order_.plan.bounds.size = nullptr;
  order_.plan.bounds.step = nullptr;
  order_.size.reset();
  order_.step.reset();
}

void ThreadRun::refine(Pulse* pulse) {
  double forecast = 0;
  for (const SubdomainId s : ids_of(order_.plan.owners))
    if (ranks_ == nullptr || holders_[s] == ranks_->rank())
      forecast += order_.plan.decomposition.subdomains[s].predicted;
  RefinementInRounds::Watch watch{.progress = [=, this](std::int64_t made) { watch_.refining(made, forecast); },
                                  .check = [this](std::int64_t made) { check_limits(limits_, made); },
                                  .check_all = [this](std::int64_t made) { check_number(limits_, made); },
                                  .stalled = [this](const std::string& why) { watch_.stalled(why); }};
  if (inspects_at_once(order_.plan))
    watch.finished = [this](const Subdomain& subdomain, const SizeField* size) { note(subdomain, size); };
  if (pulse != nullptr)
    watch.stepped = [pulse](std::int64_t made, std::optional<SubdomainId> next) {
      pulse->does(next ? "refining subdomain " + to_string(*next) : "waiting for its threads", made);
    };
  std::optional<HeldOnRanks> others;
  if (ranks_ != nullptr) others.emplace(HeldOnRanks{*ranks_, holders_});
  if (!order_.keeping.checkpoint.empty()) keep(watch, pulse);
  refinement_.emplace(order_.plan, sizes_, std::move(watch), others);
  if (!order_.keeping.resume.empty()) ranks().agree([this] { take_up(); });
  refinement_->run();
  if (checkpoints_) kept_ = checkpoints_->record();
  checkpoints_.reset();
}

void ThreadRun::keep(RefinementInRounds::Watch& watch, Pulse* pulse) {
  std::function<void()> saving;
  if (pulse != nullptr) saving = [pulse] { pulse->is_at("writing a checkpoint"); };
  checkpoints_.emplace(
      Checkpoints::Rules{.path = order_.keeping.checkpoint,
                         .every = order_.keeping.every,
                         .fence_every = std::min(1.0, order_.keeping.every),
                         .subdomains = order_.plan.decomposition.size(),
                         .saving = std::move(saving)},
      ranks(), [this] { return order_.keeping.heads; }, [this](std::int64_t made) { check_number(limits_, made); },
      watch_);
  watch.halts = [this] { return checkpoints_->halts(); };
  watch.fence = [this](bool rests) { return checkpoints_->fence(rests, *refinement_); };
  watch.check = [this](std::int64_t made) {
    try {
      check_limits(limits_, made);
    } catch (const LimitError&) {
      checkpoints_->end_for(std::current_exception());
    }
  };
}

KeyText ThreadRun::left() const {
  const bool has_saved = checkpoints_ && checkpoints_->record().count > 0;
  const std::string& kept = has_saved ? order_.keeping.checkpoint : order_.keeping.resume;
  if (kept.empty()) return "Nothing was written";
  return KeyText::of("What was done until the last checkpoint is in {}: go on with driftmesh mesh {run.resume} {}",
                     kept, kept);
}

void ThreadRun::take_up() {
  const PartsFile file(order_.keeping.resume, kCheckpointFile);
  file.understand([&] {
    for (const SubdomainId s : ids_of(order_.plan.owners))
      if (ranks_ == nullptr || holders_[s] == ranks_->rank()) refinement_->take_up(s, file.part(s));
  });
}

void ThreadRun::report(RunRecord& run) {
  add_facts(run, facts());
  for (const RankOutcome& outcome : refinement_->outcomes()) {
    run.ranks.push_back({outcome, 0});
    run.seconds_refine = std::max(run.seconds_refine, outcome.times.total());
  }
  run.on_threads = true;
  run.rounds = refinement_->rounds();
  run.checkpoints = kept_;
  run.peak = run.peak_refining = peak_memory();
  add_plan(run, order_.plan);
}

RankReport ThreadRun::rank_report() {
  RankReport report{{}, facts()};
  const auto outcomes = refinement_->outcomes();
  report.rank.times = outcomes.front().times;
  for (const RankOutcome& outcome : outcomes) {
    report.rank.triangles += outcome.triangles;
    report.rank.subdomains += outcome.subdomains;
    report.rank.interface_splits += outcome.interface_splits;
  }
  report.rank.peak = peak_memory();
  return report;
}

void ThreadRun::note(const Subdomain& subdomain, const SizeField* size) {
  QualityBounds bounds = order_.plan.bounds;
  bounds.size = size;
  book_.note(subdomain, bounds);
}

/// In parallel what is not in the book yet. Sums are formed in the same order for any number of threads.
MeshFacts ThreadRun::facts() {
  std::vector<const Subdomain*> open;
  for (const auto& [id, subdomain] : refinement_->subdomains())
    if (!book_.has(id)) open.push_back(&subdomain);
  in_parts(open.size(), sizes_.size(), [&](std::size_t thread, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) note(*open[i], sizes_[thread]);
  });
  MeshFacts all;
  for (const auto& [id, subdomain] : refinement_->subdomains()) add_facts(all, book_.of(id));
  return all;
}

/// From the book as far as it has it.
std::vector<SubdomainCensus> ThreadRun::census() const {
  std::vector<SubdomainCensus> all;
  for (const auto& [id, subdomain] : refinement_->subdomains()) {
    if (book_.has(id))
      all.push_back(book_.census_of(id));
    else
      show_subdomain(subdomain, [&](SubdomainId shown, const SubdomainMesh& part) {
        all.push_back(census_of(order_.plan.decomposition, shown, part));
      });
  }
  return all;
}

void ThreadRun::write_pieces(const std::string& path, const WriteOptions& options) const {
  const PieceSeries series(order_.plan.decomposition, refinement_->subdomains(), census(), order_.pslg);
  const auto make = [&](Rank k) {
    DistributedPiece piece = series.piece(k);
    set_point_data(order_.rasters, piece.mesh);
    change_coordinates(piece.mesh, coordinates_wanted(piece.mesh, path, options), path);
    return piece;
  };
  if (options.ghost_layer)
    write_ghosted_series(path, series.size(), make);
  else
    write_series(path, series.size(), sizes_.size(), make);
}

DistributedPiece ThreadRun::assemble() {
  PieceAssembly assembly(ranks().rank(), ranks().ranks(), order_.plan.decomposition,
                         held_by_rank(refinement_->subdomains()), census());
  ranks().run(assembly);
  DistributedPiece piece = assembly.piece(order_.pslg);
  set_point_data(order_.rasters, piece.mesh);
  return piece;
}

void ThreadRun::write(const Request::Output& files, const Draw& draw, Watch& watch) {
  if (std::ranges::any_of(files.meshes, is_in_pieces))
    timed(watch, "write", [&] {
      const WriteOptions options = writing_of(files, {}, watch);
      for_each_in_pieces(files, watch, [&](const std::string& path) { write_pieces(path, options); });
    });
  if (!needs_whole(files)) return;
  DistributedPiece piece = take_piece(watch);
  write_whole(files, piece.mesh, order_.pslg.holes, draw, watch);
}

DistributedPiece ThreadRun::take_piece(Watch& watch) {
  DistributedPiece piece = timed(watch, "assemble", [&] { return assemble(); });
  release();
  return piece;
}

/// Without bounds that describe this mesh alone.
RunPlan ThreadRun::lasting_plan(const Request& request) const {
  RunPlan plan = order_.plan;
  plan.bounds.plain.area = request.bounds.area;
  plan.bounds.size = nullptr;
  plan.bounds.step = nullptr;
  plan.scratch = nullptr;
  return plan;
}

GrowingArray<double, VertexId> ThreadRun::lengths_at(const SubdomainMesh& part, std::size_t thread) const {
  GrowingArray<double, VertexId> lengths;
  if (sizes_[thread] != nullptr)
    for (const Point& p : part.mesh.points) lengths.push_back(sizes_[thread]->edge_length(p));
  return lengths;
}

LiveMesh ThreadRun::take_live(const Request& request) {
  LiveMesh live;
  std::vector<std::pair<const SubdomainMesh*, GrowingArray<double, VertexId>*>> sized;
  for (auto& [id, subdomain] : refinement_->subdomains()) {
    SubdomainMesh& part = live.parts[id] = subdomain.take_mesh();
    if (sizes_.front() != nullptr) sized.emplace_back(&part, &live.lengths[id]);
  }
  const auto add_lengths = [&] {
    in_parts(sized.size(), sizes_.size(), [&](std::size_t thread, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) *sized[i].second = lengths_at(*sized[i].first, thread);
    });
  };
  if (ranks_ != nullptr)
    ranks_->agree(add_lengths);
  else
    add_lengths();
  live.plan = lasting_plan(request);
  release();
  live.pslg = std::move(order_.pslg);
  live.rasters = std::move(order_.rasters);
  live.limits = limits_;
  return live;
}

void ThreadRun::save(const Request& request, Watch& watch) {
  const std::string& path = request.output.session;
  watch.writing(path);
  adapt::SavedHead head;
  head.plan = lasting_plan(request);
  head.shares = static_cast<std::int32_t>(head.plan.decomposition.size());
  head.pslg = order_.pslg;
  ByteWriter rasters;
  order_.rasters.write(rasters);
  head.more = rasters.take();
  std::vector<SubdomainId> here;
  for (const auto& [id, subdomain] : refinement_->subdomains()) here.push_back(id);
  const auto packed = [&](SubdomainId s) {
    Bytes bytes;
    show_subdomain(refinement_->subdomains().at(s), [&](SubdomainId, const SubdomainMesh& part) {
      bytes = adapt::pack(s, adapt::first_part(part, head.plan.bounds, lengths_at(part, 0)), {});
    });
    return bytes;
  };
  timed(watch, "save", [&] {
    PackedParts parts(packed, std::min(PackedParts::kMostRoom, room_under_cap() / 4));
    adapt::save(path, head,
                {.here = std::move(here),
                 .size = [&](SubdomainId s) { return parts.size(s); },
                 .pack = [&](SubdomainId s) { return parts.take(s); }},
                ranks());
  });
}

}  // namespace driftmesh::job
