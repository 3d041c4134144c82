#include <memory>
#include <utility>

#include "balancer/effort.hpp"
#include "balancer/remap_parts.hpp"
#include "balancer/surplus.hpp"
#include "balancer/zoltan/zoltan_partition.hpp"
#include "base/letter_case.hpp"
#include "driftmesh/policy.hpp"
#include "driftmesh/policy_parameters.hpp"

namespace driftmesh::balancer {
namespace {

/// Whether graphs are partitioned by Zoltan itself. SCOTCH and ParMETIS keep nothing where it is, and number parts as
/// they like.
bool has_own_graphs(const ZoltanParameters& parameters) {
  const auto package = parameters.find("GRAPH_PACKAGE");
  return package == parameters.end() || upper_case(package->second) == "PHG";
}

/// The length of the open borders of `s` with subdomains of `rank`.
double border_with(const LoadSnapshot& snapshot, const SubdomainLoad& s, Rank rank) {
  double length = 0;
  for (const Neighbor& n : (*snapshot.layout)[s.id].neighbors) {
    const SubdomainLoad* const other = find(snapshot, n.subdomain);
    if (other && other->owner == rank && is_open_border(snapshot, s, *other)) length += n.length;
  }
  return length;
}

/// Takes back moves without which the owner still finishes in time and no more border lies between ranks.
void take_back_needless(const LoadSnapshot& from, LoadSnapshot& planned, double tolerance) {
  const IdVector<Rank, double> speeds = assumed_speeds(from.ranks);
  const double time = std::max(finishing_time(planned), ideal_time(from) * (1 + tolerance));
  for (bool any = true; std::exchange(any, false);)
    for (std::size_t i = 0; i < planned.subdomains.size(); ++i) {
      SubdomainLoad& s = planned.subdomains[i];
      const Rank owner = from.subdomains[i].owner;
      RankLoad& home = planned.ranks[owner];
      if (s.owner == owner || home.remaining + s.remaining > time * speeds[owner]) continue;
      note_effort("border", 2);
      if (border_with(planned, s, owner) < border_with(planned, s, s.owner)) continue;
      home.remaining += s.remaining;
      planned.ranks[s.owner].remaining -= s.remaining;
      s.owner = owner;
      any = true;
    }
}

/// Parts by Zoltan, in proportion to the speeds of the ranks: compact and, with the approach repartition or refine,
/// close to the current distribution. Small imbalances are fixed by moving single subdomains instead of making new
/// parts.
class ZoltanPolicy final : public Policy {
 public:
  ZoltanPolicy(ZoltanParameters parameters, Placement placement, double touch_up, const Dealing& dealing,
               double most_moves)
      : parameters_(std::move(parameters)),
        placement_(placement),
        touch_up_(touch_up),
        dealing_(dealing),
        most_moves_(most_moves) {}

  [[nodiscard]] Placement placement() const override { return placement_; }
  // A touch-up only deals single subdomains.
  [[nodiscard]] Dealing dealing(const LoadSnapshot& own) const override {
    return {dealing_.polish || wants_touch_up_alone(own), dealing_.tolerance};
  }

  [[nodiscard]] std::vector<Move> plan(const LoadSnapshot& snapshot, Rank) const override {
    if (snapshot.subdomains.empty() || snapshot.ranks.size() < 2) return {};
    if (wants_touch_up_alone(snapshot)) return moves_between(snapshot, deal_surplus(snapshot, dealing_.tolerance));
    const std::vector<Part> parts = zoltan_partition(snapshot, parameters_);
    const auto owners = keeps_parts() ? owners_of(parts) : remap_parts(snapshot, parts, dealing_.tolerance);
    LoadSnapshot planned = snapshot;
    for (std::size_t i = 0; i < owners.size(); ++i)
      if (!planned.subdomains[i].fixed) planned.subdomains[i].owner = owners[i];
    sum_up(planned);
    if (dealing_.polish) planned = deal_surplus(planned, dealing_.tolerance);
    take_back_needless(snapshot, planned, dealing_.tolerance);
    return moves_between(snapshot, planned);
  }

  [[nodiscard]] std::optional<std::vector<Move>> touch_up(const LoadSnapshot& snapshot) const override {
    return moves_between(snapshot, deal_surplus(snapshot, dealing_.tolerance));
  }

  [[nodiscard]] double planning_seconds(const LoadSnapshot& snapshot) const override {
    return wants_touch_up_alone(snapshot) ? 0 : PlanningCosts{}.seconds(effort_of_parts(snapshot, parameters_));
  }

  [[nodiscard]] double most_moves() const override { return most_moves_; }

  [[nodiscard]] std::optional<ZoltanParameters> partitioning(const LoadSnapshot& own) const override {
    return wants_touch_up_alone(own) ? std::nullopt : std::optional(parameters_);
  }

 private:
  [[nodiscard]] bool keeps_parts() const {
    const std::string& method = parameters_.at("LB_METHOD");
    return (method == "HYPERGRAPH" || (method == "GRAPH" && has_own_graphs(parameters_))) &&
           parameters_.at("LB_APPROACH") != "PARTITION";
  }
  static std::vector<Rank> owners_of(const std::vector<Part>& parts) {
    std::vector<Rank> owners;
    for (const Part p : parts) owners.push_back(Rank{to_int(p)});
    return owners;
  }

  // Depends only on the states of ranks, which are equal everywhere.
  [[nodiscard]] bool wants_touch_up_alone(const LoadSnapshot& snapshot) const {
    return finishing_time(snapshot) <= (1 + touch_up_) * ideal_time(snapshot);
  }

  ZoltanParameters parameters_;
  Placement placement_;
  double touch_up_;  // of the ideal time
  Dealing dealing_;
  double most_moves_;
};

}  // namespace

std::unique_ptr<Policy> make_zoltan(Parameters& parameters) {
  ZoltanParameters all{
      {"LB_METHOD", upper_case(parameters.choice("method", {"graph", "rcb", "hsfc", "rib", "hypergraph"}))},
      {"LB_APPROACH", upper_case(parameters.choice("approach", {"repartition", "partition", "refine"}))},
      {"IMBALANCE_TOL", "1.03"},
      // Do not omit dense hyperedges: in a small graph, none would be left.
      {"PHG_EDGE_SIZE_THRESHOLD", "1.0"},
      // Borders count twice as much as moves (see zoltan_partition.cpp for their units): where they count alike, parts
      // have longer borders than single moves leave.
      {"PHG_REPART_MULTIPLIER", "2"},
      {"SEED", std::to_string(parameters.integer("seed", 1, 0, INT32_MAX))}};
  // Partition graphs with Zoltan's own partitioner, available in every build.
  if (all["LB_METHOD"] == "GRAPH") all["GRAPH_PACKAGE"] = "PHG";
  for (const auto& [name, value] : parameters.any_of(zoltan_parameter_names())) {
    if (!zoltan_accepts(name, value)) parameters.fail(name, value, "Zoltan's user guide lists valid values");
    all[name] = value;
  }
  if (!has_own_graphs(all) && !zoltan_partitions_with(all))
    parameters.fail("GRAPH_PACKAGE", all["GRAPH_PACKAGE"], "this Zoltan was built without it; PHG is always there");
  const bool collective = parameters.choice("placement", {"leader", "collective"}) == "collective";
  // What ranks know of borders between them may differ, and so would the two directions of an edge, which others do not
  // bear.
  if (collective && !has_own_graphs(all))
    parameters.fail("placement", "collective", "with GRAPH_PACKAGE = " + all["GRAPH_PACKAGE"] + " it must be leader");
  Dealing dealing;
  dealing.polish = parameters.flag("polish", dealing.polish);
  dealing.tolerance = parameters.number("tolerance", dealing.tolerance, 0, 10);
  const double touch_up = parameters.number("touch-up", 0.1, 0, 10);
  const double most_moves = parameters.number("most-moves", 2, 0, 1e9);
  return std::make_unique<ZoltanPolicy>(std::move(all), collective ? Placement::kCollective : Placement::kLeader,
                                        touch_up, dealing, most_moves);
}

}  // namespace driftmesh::balancer
