#include "balancer/snapshot/deliberation.hpp"

namespace driftmesh::balancer {
namespace {

thread_local DeliberationLog* innermost_log = nullptr;

}  // namespace

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kDone:
      return "done";
    case Verdict::kEven:
      return "even";
    case Verdict::kSmallGain:
      return "small gain";
    case Verdict::kTooEarly:
      return "too early";
    case Verdict::kCostlyPlanning:
      return "planning takes longer";
    case Verdict::kNoMoves:
      return "no moves";
    case Verdict::kSmallSaving:
      return "small saving";
    case Verdict::kOtherPlan:
      return "another plan";
    case Verdict::kInvalid:
      return "invalid";
    case Verdict::kFixed:
      return "fixed";
    case Verdict::kTooLarge:
      return "too large";
    case Verdict::kNoMemory:
      return "no memory";
    case Verdict::kCostsMore:
      return "costs more than its work";
    case Verdict::kNeedless:
      return "needless";
    case Verdict::kGone:
      return "gone";
    case Verdict::kNoGiver:
      return "no giver";
    case Verdict::kAsked:
      return "asked";
  }
  return "";
}

const char* name_of(Deliberation::Subject subject) {
  switch (subject) {
    case Deliberation::Subject::kLoad:
      return "load";
    case Deliberation::Subject::kPlan:
      return "plan";
    case Deliberation::Subject::kAdvice:
      return "advice";
    case Deliberation::Subject::kRequest:
      return "request";
    case Deliberation::Subject::kAdmission:
      return "admission";
  }
  return "";
}

DeliberationLog::DeliberationLog() : outer_(innermost_log) {
  innermost_log = this;
}

DeliberationLog::~DeliberationLog() {
  innermost_log = outer_;
}

bool is_logged() {
  return innermost_log != nullptr;
}

void note(Deliberation deliberation) {
  if (is_logged()) innermost_log->noted_.push_back(std::move(deliberation));
}

void note_comparison(std::size_t back, double border, bool made) {
  if (!is_logged()) return;
  Deliberation& plan = innermost_log->noted_.rbegin()[static_cast<std::ptrdiff_t>(back)];
  plan.border = border;
  if (!made && plan.verdict == Verdict::kDone) plan.verdict = Verdict::kOtherPlan;
}

std::vector<Deliberation::KnownLoad> known_loads(const LoadSnapshot& snapshot) {
  std::vector<Deliberation::KnownLoad> loads;
  for (const Rank r : ids_of(snapshot.ranks))
    if (snapshot.ranks[r].remaining > 0 || snapshot.ranks[r].speed > 0) loads.push_back({r, 0, snapshot.ranks[r]});
  return loads;
}

}  // namespace driftmesh::balancer
