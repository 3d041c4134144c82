#include "balancer/controller.hpp"

#include <utility>

namespace driftmesh::balancer {

Controller::Controller(Rank self, std::shared_ptr<const Layout> layout, std::shared_ptr<const Policy> policy,
                       const ControllerOptions& options, double now)
    : look_interval_(options.look), next_look_(now) {
  if (layout->ranks < 2) return;
  switch (policy->placement()) {
    case Placement::kNobody:
      break;
    case Placement::kLeader:
    case Placement::kNeighbours:
      conduct_.emplace<PlanningConduct>(self, std::move(layout), std::move(policy), options, now);
      break;
    case Placement::kRequests:
      conduct_.emplace<RequestConduct>(self, std::move(layout), std::move(policy), options, now);
      break;
  }
}

void Controller::receive(Rank source, protocol::Message advice, double now) {
  if (auto* const planning = std::get_if<PlanningConduct>(&conduct_)) planning->receive(source, std::move(advice), now);
  if (auto* const requests = std::get_if<RequestConduct>(&conduct_)) requests->receive(source, std::move(advice), now);
  next_look_ = now;
}

void Controller::arrived(SubdomainId id, protocol::Epoch epoch) {
  if (auto* const planning = std::get_if<PlanningConduct>(&conduct_)) planning->arrived(id, epoch);
  if (auto* const requests = std::get_if<RequestConduct>(&conduct_)) requests->arrived(id);
}

bool Controller::due(double now) const {
  if (conduct_.index() == 0) return false;
  const auto* const requests = std::get_if<RequestConduct>(&conduct_);
  return now >= next_look_ || (requests && requests->expects_work());
}

Decision Controller::think(double now, std::span<const protocol::SubdomainLoad> own, double speed) {
  next_look_ = now + look_interval_;
  if (auto* const planning = std::get_if<PlanningConduct>(&conduct_)) return planning->think({now, own, speed});
  if (auto* const requests = std::get_if<RequestConduct>(&conduct_)) return requests->think({now, own, speed});
  return {};
}

bool Controller::waiting() const {
  if (const auto* const planning = std::get_if<PlanningConduct>(&conduct_)) return planning->waiting();
  if (const auto* const requests = std::get_if<RequestConduct>(&conduct_)) return requests->waiting();
  return false;
}

void Controller::took(double seconds) {
  if (auto* const planning = std::get_if<PlanningConduct>(&conduct_)) planning->took(seconds);
}

}  // namespace driftmesh::balancer
