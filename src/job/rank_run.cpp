#include "job/rank_run.hpp"

#include <utility>

#include "base/bytes.hpp"
#include "base/key_error.hpp"
#include "distributed/assembly.hpp"
#include "distributed/held_subdomains.hpp"
#include "driftmesh/error.hpp"
#include "job/domain.hpp"
#include "job/drag.hpp"
#include "job/failure.hpp"
#include "job/memory.hpp"
#include "job/same_on_ranks.hpp"
#include "job/sleeping_room.hpp"
#include "protocol/rank_step.hpp"
#include "runtime/plan_run.hpp"
#include "runtime/threads/thread_crew.hpp"

namespace driftmesh::job {
RankRun::RankRun(Team& team, Order order, const Limits& limits, const SizeField* size, Watch& watch)
    : team_(team), order_(std::move(order)), watch_(watch), limits_(limits), book_(order_.plan.decomposition) {
  agree(team_, [&] {
    size_ = std::move(order_.size);
    if (size_ == nullptr) size_ = size_of(order_.sizing, order_.rasters.open, size, order_.pslg).field;
    order_.plan.bounds.size = size_.get();
    order_.plan.bounds.step = order_.step.get();
    order_.plan.max_triangles = limits_.triangles;
    scratch_ = open_scratch(order_.scratch, forecast_of(order_.plan, team_.rank()) * team_.ranks_on_machine());
    order_.plan.scratch = scratch_.get();
  });
  agree_on_size();
}

/// Makes sure that both sides of each interface start alike.
void RankRun::agree_on_size() {
  if (team_.alone() || size_ == nullptr) return;
  require_same_size(team_, order_.plan.decomposition, *size_);
  if (order_.plan.presplit)
    order_.plan.presplit_paths = std::make_shared<const PresplitPaths>(share_presplit(team_, order_.plan));
}

RankRun::~RankRun() {
  if (scratch_) scratch_->discard();
}

void RankRun::refine(bool logs, const RankHooks& hooks) {
  team_.meet();  // the clocks of all start together
  channel_ = team_.open();
  if (!team_.alone()) progress_.emplace(team_, order_.patience);
  by_itself(team_, [&] {
    if (logs) log_.emplace(channel_->transport(), &order_.plan.decomposition);
    run_loop(hooks);
    if (logs) log_->ends(*loop_);
    if (progress_) progress_->close(loop_->triangles(), [this] { hear_of_others(team_.leads(), false); });
  });
  channel_->close();
  agree_on_failure(team_, failure_);
}

void RankRun::run_loop(const RankHooks& hooks) {
  protocol::Transport& own = channel_->transport();
  protocol::Transport& transport = hooks.through ? hooks.through(own) : own;
  loop_.emplace(transport, order_.plan, CostModel{}, observers(hooks), inspection());
  if (order_.plan.work.threads > 1) {
    crew_ = std::make_unique<ThreadCrew>(to_index(order_.plan.work.threads - 1));
    loop_->hire(*crew_);
  }
  loop_->limit_memory([this] { return room_for(limits_, loop_->triangles()); });
  if (log_) log_->begins(*loop_);
  protocol::run_rank(transport, [&] {
    if (hooks.before_step) hooks.before_step(*loop_);
    return step_or_abandon();
  });
}

/// What the watch throws ends the run as what a slice of work throws does.
void RankRun::hear_of_others(bool shows, bool refines) {
  const std::string silence = progress_->silence();
  if (failure_) return;
  try {
    if (!silence.empty()) watch_.stalled(silence);
    if (shows) watch_.refining_on_all(progress_->triangles(), forecast_of(order_.plan));
  } catch (const std::exception&) {
    failure_ = std::current_exception();
    if (refines) loop_->abandon();
  }
}

protocol::StepResult RankRun::step_or_abandon() {
  if (progress_) {
    const auto next = loop_->next();
    const std::string doing = next ? "refining subdomain " + to_string(*next) : std::string("waiting for other ranks");
    hear_of_others(progress_->tell(loop_->triangles(), doing), true);
  }
  // Not at each poll of an idle rank: a look at its memory takes longer.
  const bool changed = std::exchange(triangles_, loop_->triangles()) != loop_->triangles();
  const bool by_memory = changed && !loop_->abandoned() && memory_is_full(limits_, triangles_);
  try {
    if (!by_memory) return loop_->step();
    failure_ = stopped(by_memory);
  } catch (const std::exception&) {
    if (!loop_->can_abandon()) throw;
    failure_ = loop_->triangles() > limits_.triangles ? stopped(by_memory) : std::current_exception();
  }
  loop_->abandon();
  return protocol::StepResult::kBusy;
}

std::exception_ptr RankRun::stopped(bool by_memory) const {
  return std::make_exception_ptr(Keyed<LimitError>(
      KeyText::of("{}. No mesh was written", stopped_message(limits_, by_memory, loop_->triangles(), true))));
}

RankLoop::Observers RankRun::observers(const RankHooks& hooks) {
  RankLoop::Observers observers;
  observers.stalled = [this](const std::string& why) { watch_.stalled(why); };
  observers.after_slice = [this, &hooks, share = share_of_time(), forecast = forecast_of(order_.plan, team_.rank())](
                              const RankLoop& loop, const RankLoop::Slice& slice) {
    watch_.refining(loop.triangles(), forecast);
    if (hooks.after_slice) hooks.after_slice(slice);
    const double begin = channel_->transport().now();
    drag(share, slice.seconds);
    if (log_) log_->worked(loop, slice, slice.seconds + (channel_->transport().now() - begin));
  };
  if (!log_) return observers;
  observers.handed_over = [this](const RankLoop& loop, const RankLoop::Passage& passage) {
    log_->departs(loop, passage);
  };
  observers.settled = [this](const RankLoop& loop, const RankLoop::Passage& passage) { log_->arrives(loop, passage); };
  observers.deliberated = [this](std::vector<balancer::Deliberation> considered) {
    log_->deliberated(std::move(considered));
  };
  return observers;
}

/// What is done with a subdomain that has nothing to do, while it is in the cache; nothing in a run that is logged: a
/// log times the work alone.
std::function<void(const Subdomain&)> RankRun::inspection() {
  if (log_ || !inspects_at_once(order_.plan)) return {};
  return [this](const Subdomain& subdomain) { book_.note(subdomain, order_.plan.bounds); };
}

double RankRun::share_of_time() const {
  return order_.shares.empty() ? 1 : order_.shares[team_.rank()];
}

RankReport RankRun::report() {
  RankReport report = report_of(loop_->outcome(), loop_->subdomains(), order_.plan, book_);
  report.rank.peak = peak_memory();
  return report;
}

DistributedPiece RankRun::assemble(ExchangeRunner& ranks) const {
  return by_itself(team_, [&] {
    PieceAssembly assembly(team_.rank(), team_.ranks(), order_.plan.decomposition, held_by_rank(loop_->subdomains()));
    ranks.run(assembly);
    DistributedPiece piece = assembly.piece(order_.pslg);
    set_point_data(order_.rasters, piece.mesh);
    return piece;
  });
}

}  // namespace driftmesh::job
