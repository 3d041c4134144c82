#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "driftmesh/load_snapshot.hpp"

/// What those who plan see, propose and reject, and why. They note it as they go, and whoever logs a run collects it.
namespace driftmesh::balancer {

/// What became of a plan, a move or a request.
enum class Verdict : std::int32_t {
  kDone,            ///< planned, made, advised or passed on
  kEven,            ///< the load is even, as far as forecasts and speeds are to be trusted
  kSmallGain,       ///< an even load would gain less than moves are made for
  kTooEarly,        ///< no rank runs out of work soon
  kCostlyPlanning,  ///< it would gain less time than planning takes
  kNoMoves,         ///< the policy proposes none
  kSmallSaving,     ///< with their costs, the moves save less than moves are made for
  kOtherPlan,       ///< another plan is made: it ends earlier, or leaves less border
  kInvalid,         ///< no such subdomain or rank, its owner, or its second move
  kFixed,           ///< it is on its way, has just moved, or is nearly finished
  kTooLarge,        ///< it does not fit into one message
  kNoMemory,        ///< there is no memory for it where it would go
  kCostsMore,       ///< moving it takes longer than finishing it
  kNeedless,        ///< all finish as early without it
  kGone,            ///< it is no longer there, or finished
  kNoGiver,         ///< no rank has work to give
  kAsked,           ///< the rank where it would go is asked first
};

/// In the words of the log.
[[nodiscard]] const char* name_of(Verdict verdict);

/// A planned move, and what became of it.
struct JudgedMove {
  SubdomainId subdomain{};
  Rank from{}, to{};
  Verdict verdict = Verdict::kDone;
};

/// One thing that a rank considered.
struct Deliberation {
  enum class Subject : std::int32_t {
    kLoad,       ///< the load as it knows it, and whether to plan
    kPlan,       ///< moves that its policy proposes
    kAdvice,     ///< moves that a planner advises it to make
    kRequest,    ///< `thief` asks for work: the broker passes it on to `giver`
    kAdmission,  ///< moves that it asks the receiver for, or what came of that
  };
  struct KnownLoad {
    Rank rank{};
    std::int32_t unused = 0;
    RankLoad load;
  };

  Subject subject = Subject::kLoad;
  Verdict verdict = Verdict::kDone;
  double time = 0;  ///< seconds; set by the log of the run, and so is `rank`
  Rank rank{};      ///< the rank that considered it
  double finish = 0, ideal = 0,
         noise = 0;                ///< for kLoad, in seconds from now: see finishing_time, ideal_time, noise_of
  double saves = 0;                ///< seconds beyond noise, gained by a load made even or by a plan
  double border = 0;               ///< length between ranks after a plan, if it was compared with others
  bool whole = false;              ///< the moves of a plan are all made, or none (Kept::kAll)
  std::vector<KnownLoad> loads{};  ///< ranks with work or a known speed
  std::vector<JudgedMove> moves{};
  Rank thief{}, giver{};
};

[[nodiscard]] const char* name_of(Deliberation::Subject subject);

/// Collects what is noted on this thread while it exists.
class DeliberationLog {
 public:
  DeliberationLog();
  ~DeliberationLog();
  DeliberationLog(const DeliberationLog&) = delete;
  DeliberationLog& operator=(const DeliberationLog&) = delete;

  [[nodiscard]] std::vector<Deliberation> take() { return std::move(noted_); }

 private:
  friend void note(Deliberation deliberation);
  friend void note_comparison(std::size_t back, double border, bool made);
  DeliberationLog* outer_;
  std::vector<Deliberation> noted_;
};

/// Whether anybody collects what is noted.
[[nodiscard]] bool is_logged();
/// To the innermost log of this thread, if there is one.
void note(Deliberation deliberation);
/// Notes the border that the plan noted `back` before the last would leave. Unless it is `made`, another one is.
void note_comparison(std::size_t back, double border, bool made);

/// The loads of the ranks that a planner knows something of.
[[nodiscard]] std::vector<Deliberation::KnownLoad> known_loads(const LoadSnapshot& snapshot);

}  // namespace driftmesh::balancer
