#include "cluster/replay/working_rank.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "balancer/codec.hpp"
#include "balancer/effort.hpp"
#include "protocol/codec.hpp"
#include "protocol/packed_size.hpp"

namespace driftmesh {
namespace {

IdVector<SubdomainId, Rank> owners_of(const balancer::Layout& layout) {
  IdVector<SubdomainId, Rank> owners;
  for (const auto& s : layout.subdomains) owners.push_back(s.owner);
  return owners;
}

}  // namespace

std::uint64_t CountedWork::bytes() const {
  constexpr std::uint64_t kOverhead = 40;
  return kOverhead + static_cast<std::uint64_t>(protocol::kBytesPerTriangle * done);
}

WorkingRank::WorkingRank(protocol::Transport& transport, const std::shared_ptr<const balancer::Layout>& layout,
                         const IdVector<SubdomainId, CountedWork>& work, std::shared_ptr<const balancer::Policy> policy,
                         const balancer::ControllerOptions& balancing, const Options& options)
    : transport_(transport),
      layout_(layout),
      owners_(owners_of(*layout)),
      protocol_(transport.rank(), transport.ranks(), owners_),
      limits_{transport.ranks(), static_cast<std::int32_t>(work.size()), 1},
      controller_(transport.rank(), layout, std::move(policy), balancing, transport.now()),
      balancing_(balancing),
      options_(options) {
  for (const SubdomainId i : ids_of(work))
    if ((*layout)[i].owner == transport.rank()) jobs_[i] = work[i];
}

protocol::StepResult WorkingRank::step() {
  const bool heard = poll();
  const bool ran_out = std::exchange(worked_, false) && agenda().empty();
  if (ran_out || controller_.due(transport_.now())) balance();
  send();
  const bool worked = worked_ = work();
  if (!worked) protocol_.rest(!controller_.waiting());
  send();
  if (protocol_.finished()) return protocol::StepResult::kFinished;
  return heard || worked ? protocol::StepResult::kBusy : protocol::StepResult::kIdle;
}

void WorkingRank::send() {
  for (const auto& o : protocol_.take_outgoing()) transport_.send(o.destination, protocol::encode(o.message));
}

bool WorkingRank::poll() {
  bool heard = false;
  while (const auto received = transport_.poll()) {
    heard = true;
    auto delivery = protocol_.receive(received->source, protocol::decode(received->source, received->bytes, limits_));
    if (delivery.arrival) {
      CountedWork job;
      std::memcpy(&job, delivery.arrival->packed.data(), sizeof job);
      jobs_[delivery.arrival->subdomain] = job;
      controller_.arrived(delivery.arrival->subdomain, delivery.arrival->epoch);
    }
    if (delivery.advice)
      controller_.receive(received->source, balancer::decode(received->source, *delivery.advice, limits_),
                          transport_.now());
  }
  return heard;
}

// Work already begun comes first, as in the loop of a real rank.
std::vector<SubdomainId> WorkingRank::agenda() const {
  std::vector<SubdomainId> order;
  for (const auto& [id, job] : jobs_)
    if (!job.finished()) order.push_back(id);
  std::stable_partition(order.begin(), order.end(), [&](SubdomainId id) { return jobs_.at(id).done > 0; });
  return order;
}

std::vector<balancer::ReportedLoad> WorkingRank::loads() const {
  std::vector<balancer::ReportedLoad> own;
  for (const SubdomainId id : agenda()) {
    const CountedWork& job = jobs_.at(id);
    const double remaining = std::max(1.0, experience_.rest((*layout_)[id].on_segments, job.forecast, job.done));
    own.push_back({id, protocol_.where(id).epoch, remaining, job.bytes()});
  }
  return own;
}

void WorkingRank::balance() {
  const std::vector<balancer::ReportedLoad> own = loads();
  const balancer::EffortLog planning;
  const double start = transport_.now();
  const double speed = options_.given_speed > 0 ? options_.given_speed : speed_.value();
  const double free_memory =
      options_.memory < balancer::kAmpleMemory ? options_.memory - occupied() : balancer::kAmpleMemory;
  auto decision = controller_.think(transport_.now(), own, speed, experience_.doubt(own), free_memory);
  transport_.spend(balancer::PlanningCosts{}.seconds(planning.efforts()) * options_.planning_speed);
  if (decision.planned) controller_.took(std::max(transport_.now() - start, options_.planning_speed > 0 ? 0 : 1e-3));
  for (auto& message : decision.messages) protocol_.advise(message.destination, balancer::encode(message.message));
  for (const auto& move : decision.moves) hand_over(move);
}

double WorkingRank::occupied() const {
  double triangles = 0;
  for (const auto& [id, job] : jobs_) triangles += std::max(job.done, job.forecast);
  return triangles;
}

void WorkingRank::hand_over(const balancer::Move& move) {
  const auto node = jobs_.extract(move.subdomain);
  experience_.left(move.subdomain);
  Bytes packed(std::max<std::size_t>(sizeof(CountedWork), node.mapped().bytes()));
  std::memcpy(packed.data(), &node.mapped(), sizeof(CountedWork));
  protocol_.hand_off(move.subdomain, move.destination, std::move(packed));
  ++counts_.moves;
  ++counts_.moves_of[move.subdomain];
}

bool WorkingRank::work() {
  const auto order = agenda();
  if (order.empty()) return false;
  const SubdomainId id = order.front();
  CountedWork& job = jobs_.at(id);
  const bool starts = job.done <= 0;
  const bool has_time = options_.given_speed <= 0;
  const double slice = has_time ? balancing_.triangles_between_looks(options_.slice, speed_.value()) : options_.slice;
  const double amount = std::min(slice, job.work - job.done);
  const double before = transport_.now();
  transport_.spend(amount);  // speeds of the network are triangles a second
  job.done += amount;
  counts_.done += amount;
  last_work = transport_.now();
  speed_.add({amount, last_work - before});
  experience_.worked(id, last_work - before, starts);
  if (job.finished()) experience_.finished(id, (*layout_)[id].on_segments, job.forecast, job.done);
  return true;
}

}  // namespace driftmesh
