#include "balancer/controller.hpp"

#include <algorithm>
#include <utility>

namespace driftmesh::balancer {
namespace {

// Passes each call on to the conducts that implement it.
template <class... Answers>
struct Each : Answers... {
  using Answers::operator()...;
};
template <class... Answers>
Each(Answers...) -> Each<Answers...>;  // clang deduces it for aggregates from version 17 on

}  // namespace

Controller::Controller(Rank self, std::shared_ptr<const Layout> layout, std::shared_ptr<const Policy> policy,
                       const ControllerOptions& options, double now)
    : self_(self), admissions_(self), look_interval_(options.look), next_look_(now) {
  if (layout->ranks < 2) return;
  switch (policy->placement()) {
    case Placement::kNobody:
      break;
    case Placement::kLeader:
    case Placement::kNeighbors:
      conduct_.emplace<PlanningConduct>(self, std::move(layout), std::move(policy), options, now);
      break;
    case Placement::kRequests:
      conduct_.emplace<RequestConduct>(self, std::move(layout), std::move(policy), options, now);
      break;
  }
}

void Controller::receive(Rank source, Message advice, double now) {
  next_look_ = now;
  if (auto* const step = std::get_if<Admission>(&advice)) {
    if (conduct_.index() != 0) admissions_.receive(source, std::move(*step));
    return;
  }
  std::visit(Each{[&](auto& conduct) { conduct.receive(source, std::move(advice), now); }, [](std::monostate) {}},
             conduct_);
}

void Controller::arrived(SubdomainId id, protocol::Epoch epoch) {
  admissions_.arrived(id);
  std::visit(Each{[&](PlanningConduct& planning) { planning.arrived(id, epoch); },
                  [&](RequestConduct& requests) { requests.arrived(id); }, [](std::monostate) {}},
             conduct_);
}

bool Controller::due(double now) const {
  if (conduct_.index() == 0) return false;
  const auto* const requests = std::get_if<RequestConduct>(&conduct_);
  return now >= next_look_ || (requests && requests->expects_work()) || pressing();
}

bool Controller::pressing() const {
  return admissions_.pressing() ||
         std::visit(Each{[](const auto& conduct) { return conduct.pressing(); }, [](std::monostate) { return false; }},
                    conduct_);
}

Decision Controller::think(double now, std::span<const ReportedLoad> own, double speed, double doubt,
                           double free_memory) {
  next_look_ = now + look_interval_;
  std::vector<ReportedLoad> rest;
  Admissions::Settled settled;
  if (admissions_.waiting()) {
    rest.assign(own.begin(), own.end());
    settled = admissions_.settle(free_memory, rest);
    tell(settled);
    own = rest;
  }
  // A planner that knows of admitted moves takes them off as well: others do not, and it may forget them.
  const Situation situation{now, own, speed, doubt, std::max(0.0, free_memory - admissions_.set_aside())};
  Decision decision = std::visit(
      Each{[&](auto& conduct) { return conduct.think(situation); }, [](std::monostate) { return Decision{}; }},
      conduct_);
  const auto append = [](auto& to, auto&& from) { to.insert(to.end(), from.begin(), from.end()); };
  append(decision.messages, admissions_.ask(decision.asks, own));
  append(decision.messages, settled.messages);
  append(decision.moves, settled.moves);
  return decision;
}

/// What does not come is not waited for, and whoever planned it should learn of the memory here.
void Controller::tell(const Admissions::Settled& settled) {
  std::visit(Each{[&](PlanningConduct& planning) {
                    for (const SubdomainId id : settled.gone) planning.gone(id);
                    if (settled.refused) planning.refused();
                  },
                  [&](RequestConduct& requests) {
                    for (const SubdomainId id : settled.not_coming) requests.not_coming(id);
                    if (settled.refused) requests.refused();
                  },
                  [](std::monostate) {}},
             conduct_);
}

bool Controller::waiting() const {
  return admissions_.waiting() ||
         std::visit(Each{[](const auto& conduct) { return conduct.waiting(); }, [](std::monostate) { return false; }},
                    conduct_);
}

void Controller::give_up() {
  conduct_ = std::monostate();
  admissions_ = Admissions(self_);
}

void Controller::took(double seconds) {
  std::visit(Each{[&](PlanningConduct& planning) { planning.took(seconds); }, [](auto&) {}}, conduct_);
}

void Controller::looked(double now, double seconds) {
  constexpr double kWorkPerLook = 50;  // times as long
  next_look_ = std::max(next_look_, now + kWorkPerLook * seconds);
}

}  // namespace driftmesh::balancer
