#include "support/adversarial_network.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "driftmesh/error.hpp"

namespace driftmesh::protocol {

class AdversarialNetwork::Endpoint final : public Transport {
 public:
  Endpoint(AdversarialNetwork& network, Rank rank) : network_(network), rank_(rank) {}
  [[nodiscard]] Rank rank() const override { return rank_; }
  [[nodiscard]] std::int32_t ranks() const override { return static_cast<std::int32_t>(network_.boxes_.size()); }
  void send(Rank destination, Bytes bytes) override { network_.send(rank_, destination, std::move(bytes)); }
  std::optional<Received> poll() override { return network_.poll(rank_); }
  void idle() override {}
  [[nodiscard]] double now() const override { return static_cast<double>(network_.steps_); }

 private:
  AdversarialNetwork& network_;
  Rank rank_;
};

Adversary Adversary::from_seed(std::uint64_t seed) {
  std::mt19937_64 random(seed * 2 + 1);
  Adversary result;
  result.seed = seed;
  result.fifo = random() % 4 == 0;
  result.delay = static_cast<double>(random() % 10) / 10;
  result.starve = random() % 3 == 0;
  result.hold_one = random() % 2 == 0;
  result.copy = random() % 2 == 0 ? 0.2 : 0;
  return result;
}

AdversarialNetwork::AdversarialNetwork(std::int32_t ranks, Adversary adversary)
    : adversary_(std::move(adversary)), random_(adversary_.seed), boxes_(to_index(ranks)) {
  for (const Rank r : first_ids<Rank>(ranks)) endpoints_.push_back(std::make_unique<Endpoint>(*this, r));
  const auto size = static_cast<std::uint64_t>(ranks);
  if (adversary_.starve && ranks > 1) {
    starved_ = static_cast<Rank>(below(size));
    starve_from_ = below(40 * size);
    starve_to_ = starve_from_ + 1 + below(200 * size);
  }
  if (adversary_.hold_one) {
    held_serial_ = below(60);
    release_ = below(400 * size);
  }
}

AdversarialNetwork::~AdversarialNetwork() = default;

Transport& AdversarialNetwork::transport(Rank rank) {
  return *endpoints_.at(rank);
}

const std::vector<Parcel>& AdversarialNetwork::under_way(Rank destination) const {
  return boxes_.at(destination);
}

void AdversarialNetwork::send(Rank source, Rank destination, Bytes bytes) {
  if (!boxes_.has(destination))
    throw LimitError("rank " + to_string(source) + " sends to rank " + to_string(destination) + " of " +
                     std::to_string(boxes_.size()));
  auto& box = boxes_[destination];
  const bool copy = adversary_.may_copy && adversary_.may_copy(source, bytes) && chance(adversary_.copy);
  if (copy) box.push_back({source, bytes, serial_, true, steps_});
  box.push_back({source, std::move(bytes), serial_, false, steps_});
  ++serial_, ++in_flight_, ++activity_;
}

std::optional<Received> AdversarialNetwork::poll(Rank destination) {
  auto& box = boxes_[destination];
  if (box.empty() || chance(adversary_.delay)) return std::nullopt;
  const auto candidates = deliverable(box);
  if (candidates.empty()) return std::nullopt;
  return deliver(box, candidates[below(candidates.size())]);
}

bool AdversarialNetwork::is_held(const Parcel& parcel) const {
  return parcel.serial == held_serial_ && steps_ < release_;
}

Urgency AdversarialNetwork::urgency(const Parcel& parcel) const {
  if (is_held(parcel)) return Urgency::kNotYet;
  return adversary_.urgency ? adversary_.urgency(parcel, steps_) : Urgency::kAnyTime;
}

// Which parcels may come next: with FIFO, the oldest of each source, and none of a source whose oldest must wait.
std::vector<std::size_t> AdversarialNetwork::deliverable(const std::vector<Parcel>& box) const {
  std::vector<std::size_t> result, first;
  IdVector<Rank, bool> met(boxes_.size(), false);
  for (std::size_t i = 0; i < box.size(); ++i) {
    const Rank source = box[i].source;
    const bool in_order = !met[source] || !adversary_.fifo || box[i].is_copy;
    if (!box[i].is_copy) met[source] = true;
    if (!in_order) continue;
    const Urgency urgent = urgency(box[i]);
    if (urgent != Urgency::kNotYet) result.push_back(i);
    if (urgent == Urgency::kFirst) first.push_back(i);
  }
  return first.empty() ? result : first;
}

Received AdversarialNetwork::deliver(std::vector<Parcel>& box, std::size_t which) {
  Parcel parcel = std::move(box[which]);
  box.erase(box.begin() + static_cast<std::ptrdiff_t>(which));
  ++activity_, ++counters_.delivered;
  // The first of two twins to arrive is the message, the second the copy.
  const auto twin = std::find_if(box.begin(), box.end(), [&](const Parcel& p) { return p.serial == parcel.serial; });
  if (twin != box.end() && parcel.is_copy) std::swap(parcel.is_copy, twin->is_copy);
  if (parcel.is_copy)
    ++counters_.copies;
  else
    --in_flight_;
  for (const Parcel& other : box) {
    if (other.source == parcel.source && other.serial < parcel.serial && !other.is_copy) {
      ++counters_.reordered;
      break;
    }
  }
  if (steps_ < release_ && held_serial_ < parcel.serial) ++counters_.held;
  return {parcel.source, std::move(parcel.bytes)};
}

bool AdversarialNetwork::is_starved(Rank rank) const {
  return rank == starved_ && steps_ >= starve_from_ && steps_ < starve_to_;
}

RunResult AdversarialNetwork::run(IdSpan<Rank, const RankStep> steps, const std::function<void(Rank)>& after_step) {
  std::vector<Rank> going;
  for (const Rank r : ids_of(boxes_)) going.push_back(r);
  IdVector<Rank, std::uint64_t> idle_since(boxes_.size(), UINT64_MAX);  // the activity at the last idle step
  const auto stalled = [&] {
    return in_flight_ == 0 &&
           std::all_of(going.begin(), going.end(), [&](Rank r) { return idle_since[r] == activity_; });
  };
  while (!going.empty()) {
    if (++steps_ > adversary_.step_limit) return {RunEnd::kStepLimit, steps_};
    const Rank rank = going[below(going.size())];
    if (is_starved(rank)) {
      ++counters_.starved;
      continue;
    }
    const StepResult result = steps[rank]();
    idle_since[rank] = result == StepResult::kIdle ? activity_ : UINT64_MAX;
    if (result == StepResult::kFinished) std::erase(going, rank);
    if (after_step) after_step(rank);
    if (result != StepResult::kBusy && !going.empty() && stalled()) return {RunEnd::kStalled, steps_};
  }
  return {RunEnd::kFinished, steps_};
}

}  // namespace driftmesh::protocol
