#include "protocol/termination.hpp"

#include <string>
#include <utility>

#include "protocol/protocol_error.hpp"

namespace driftmesh::protocol {

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

// Hand-offs are rare. A rank that handles SPLITs all the time would have probes go around without end.
void Termination::subdomain_handled() {
  work_handled(1);
  has_received_ = true;
}

void Termination::receive(Rank source, const Token& token) {
  probe_.receive(source, token);
}

void Termination::receive(Rank source, const Terminate& terminate) {
  if (pass_.receive(source, terminate)) phase_ = Phase::kDraining;
}

void Termination::receive(Rank source, const Finish&) {
  if (phase_ == Phase::kWorking) throw ProtocolError(source, "finish before termination");
  finish_due_ = true;
}

void Termination::advance(bool passive, std::vector<Outgoing>& out) {
  if (passive) resting_ = true;
  if (alone_) return advance_alone(passive);
  probe_.relay(out);
  if (phase_ == Phase::kWorking) answer_probe(passive, out);
  if (phase_ == Phase::kDraining) answer_pass(out);
}

// A single rank need not ask others: it sends only to itself.
void Termination::advance_alone(bool passive) {
  if (phase_ == Phase::kWorking && passive && work_ == 0) phase_ = Phase::kDraining;
  if (phase_ == Phase::kDraining && control_ == 0) phase_ = Phase::kFinished;
}

// What this rank adds to a probe; it turns white.
Token Termination::own_token() {
  has_received_ = false;
  return {probe_.round(), work_, std::exchange(black_, false)};
}

void Termination::answer_probe(bool passive, std::vector<Outgoing>& out) {
  const bool fails_anyway = has_received_ || probe_.so_far().black;
  const bool answers = probe_.due() && (passive || fails_anyway);
  if (!probe_.place().is_root()) {
    if (answers) probe_.answer(own_token(), out);
    return;
  }
  if (answers) conclude(passive);
  if (phase_ != Phase::kWorking || probe_.asked()) return;  // it is over, or the probe is on its way
  probe_.ask();
  probe_.relay(out);
}

// At the root: a probe has come back.
void Termination::conclude(bool passive) {
  const Token all = probe_.close(own_token());
  if (passive && !all.black && all.count == 0) phase_ = Phase::kDraining;
}

// When every rank has stopped sending control messages, a sum of 0 says that all have arrived.
void Termination::answer_pass(std::vector<Outgoing>& out) {
  if (finish_due_) return finish(out);
  pass_.relay(out);
  const Terminate own{pass_.round(), work_, control_};
  if (!pass_.place().is_root()) {
    if (pass_.due()) pass_.answer(own, out);
    return;
  }
  if (pass_.due()) {
    const Terminate all = pass_.close(own);
    if (all.work != 0)
      throw Error("after termination " + std::to_string(all.work) +
                  " SPLITs or hand-offs are sent and not handled: termination was wrong");
    if (all.control == 0) return finish(out);
  }
  if (pass_.asked()) return;  // the pass is on its way
  pass_.ask();
  pass_.relay(out);
}

void Termination::finish(std::vector<Outgoing>& out) {
  phase_ = Phase::kFinished;
  const TreePlace& place = pass_.place();
  for (std::size_t i = 0; i < place.children(); ++i) out.push_back({place.child(i), Finish{}});
}

}  // namespace driftmesh::protocol
