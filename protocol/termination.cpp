#include "protocol/termination.hpp"

#include <string>
#include <utility>

#include "protocol/protocol_error.hpp"

namespace driftmesh::protocol {
namespace {

constexpr Rank kFirst{0};  // of the ring: it starts the probes and the passes

}  // namespace

void Termination::work_sent(std::int64_t count) {
  if (resting_)
    throw Error("rank " + to_string(self_) +
                " sends work although it was passive and has received none since: termination could miss it");
  work_ += count;
}

void Termination::work_handled(std::int64_t count) {
  work_ -= count;
  black_ = true;
  resting_ = false;
}

// Rank 0 awaits the token of the round that it started; any other rank that of the round after its last.
void Termination::receive(Rank source, const Token& token) {
  const std::uint64_t due = self_ == kFirst ? round_ : round_ + 1;
  if (token.round > due) throw ProtocolError(source, "token of round " + std::to_string(token.round) + " is not due");
  if (phase_ == Phase::kWorking && token.round == due && due != 0) token_ = token;
}

void Termination::receive(Rank source, const Terminate& terminate) {
  const std::uint64_t due = self_ == kFirst ? pass_ : pass_ + 1;
  if (terminate.pass > due)
    throw ProtocolError(source, "termination pass " + std::to_string(terminate.pass) + " is not due");
  if (phase_ == Phase::kFinished || terminate.pass != due) return;
  phase_ = Phase::kDraining;
  terminate_ = terminate;
}

void Termination::receive(Rank source, const Finish&) {
  if (phase_ == Phase::kWorking) throw ProtocolError(source, "finish before termination");
  if (phase_ == Phase::kDraining) finish_due_ = true;
}

std::optional<Outgoing> Termination::advance(bool passive) {
  if (passive) resting_ = true;
  if (ranks_ == 1) {
    advance_alone(passive);
    return std::nullopt;
  }
  switch (phase_) {
    case Phase::kWorking:
      if (!passive) return std::nullopt;
      return self_ == kFirst ? probe() : pass_token();
    case Phase::kDraining:
      if (finish_due_) return finish();
      return self_ == kFirst ? fence() : pass_terminate();
    case Phase::kFinished:
      break;
  }
  return std::nullopt;
}

// A single rank need not ask others: it sends only to itself.
void Termination::advance_alone(bool passive) {
  if (phase_ == Phase::kWorking && passive && work_ == 0) phase_ = Phase::kDraining;
  if (phase_ == Phase::kDraining && control_ == 0) phase_ = Phase::kFinished;
}

// Rank 0: evaluates the returned token, and sends the next one, or Terminate.
std::optional<Outgoing> Termination::probe() {
  if (round_ != 0 && !token_) return std::nullopt;  // it is in transit
  if (token_ && !token_->black && !black_ && token_->count + work_ == 0) {
    phase_ = Phase::kDraining;
    return fence();
  }
  token_.reset();
  black_ = false;
  return Outgoing{next(), Token{++round_, 0, false}};
}

std::optional<Outgoing> Termination::pass_token() {
  if (!token_) return std::nullopt;
  Token token = *std::exchange(token_, std::nullopt);
  token.count += work_;
  token.black = token.black || black_;
  black_ = false;
  round_ = token.round;
  return Outgoing{next(), token};
}

// Rank 0: evaluates the returned pass, and sends the next one, or Finish.
std::optional<Outgoing> Termination::fence() {
  if (pass_ != 0 && !terminate_) return std::nullopt;  // it is in transit
  if (terminate_) {
    if (terminate_->work != 0)
      throw ProtocolError(Rank{ranks_ - 1}, "after termination " + std::to_string(terminate_->work) +
                                                " SPLITs or hand-offs are sent and not handled: termination was wrong");
    if (terminate_->control == 0) return finish();
  }
  terminate_.reset();
  return Outgoing{next(), Terminate{++pass_, work_, control_}};
}

std::optional<Outgoing> Termination::pass_terminate() {
  if (!terminate_) return std::nullopt;
  Terminate terminate = *std::exchange(terminate_, std::nullopt);
  terminate.work += work_;
  terminate.control += control_;
  pass_ = terminate.pass;
  return Outgoing{next(), terminate};
}

// The last rank of the ring has no successor to inform.
std::optional<Outgoing> Termination::finish() {
  phase_ = Phase::kFinished;
  finish_due_ = false;
  if (next() == kFirst) return std::nullopt;
  return Outgoing{next(), Finish{}};
}

}  // namespace driftmesh::protocol
