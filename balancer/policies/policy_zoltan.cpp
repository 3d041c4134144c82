#include <memory>
#include <utility>

#include "balancer/effort.hpp"
#include "balancer/remap_parts.hpp"
#include "balancer/surplus.hpp"
#include "balancer/within_memory.hpp"
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

/// The length of the open borders of `s` with subdomains of its owner.
double border_inside(const LoadSnapshot& snapshot, const SubdomainLoad& s) {
  note_effort("border", 1);
  double length = 0;
  for (const Neighbor& n : (*snapshot.layout)[s.id].neighbors) {
    const SubdomainLoad* const other = find(snapshot, n.subdomain);
    if (other && other->owner == s.owner && is_open_border(snapshot, s, *other)) length += n.length;
  }
  return length;
}

/// Leaves where it is what does not fit into the memory of its new rank, and counts the rest there.
void keep_within_memory(const LoadSnapshot& from, LoadSnapshot& planned) {
  std::vector<std::size_t> newcomers;
  IdVector<Rank, double> needed(planned.ranks.size(), 0);
  for (std::size_t i = 0; i < planned.subdomains.size(); ++i) {
    const SubdomainLoad& s = planned.subdomains[i];
    if (s.owner == from.subdomains[i].owner) continue;
    newcomers.push_back(i);
    needed[s.owner] += memory_for(s);
  }
  // Where not all fit, those stay that have least border with the rest of the part.
  std::vector<std::pair<double, std::size_t>> longest_border_first;
  for (const std::size_t i : newcomers) {
    const SubdomainLoad& s = planned.subdomains[i];
    const bool all_fit = needed[s.owner] <= planned.ranks[s.owner].free_memory;
    longest_border_first.emplace_back(all_fit ? 0 : -border_inside(planned, s), i);
  }
  std::ranges::sort(longest_border_first);
  for (const auto& [border, i] : longest_border_first) {
    SubdomainLoad& s = planned.subdomains[i];
    double& free = planned.ranks[s.owner].free_memory;
    if (memory_for(s) > free)
      s.owner = from.subdomains[i].owner;
    else
      free -= memory_for(s);
  }
}

/// How many subdomains a part has on average. Uneven ones count as the number of equal ones that would fill a part as
/// unevenly.
double subdomains_per_part(const LoadSnapshot& snapshot) {
  double work = 0, squares = 0;
  for (const SubdomainLoad& s : snapshot.subdomains) {
    work += s.remaining;
    squares += s.remaining * s.remaining;
  }
  return squares > 0 ? work * work / squares / static_cast<double>(snapshot.ranks.size()) : 0;
}

/// Parts by Zoltan, in proportion to the speeds of the ranks: compact and, with the approach repartition or refine,
/// close to the current distribution. Small imbalances are fixed by moving single subdomains instead of making new
/// parts, and so are those among few subdomains, of which no even parts can be made.
class ZoltanPolicy final : public Policy {
 public:
  ZoltanPolicy(ZoltanParameters parameters, Placement placement, double touch_up, const Dealing& dealing,
               double most_moves, double part_size)
      : parameters_(std::move(parameters)),
        placement_(placement),
        touch_up_(touch_up),
        dealing_(dealing),
        most_moves_(most_moves),
        part_size_(part_size) {}

  [[nodiscard]] Placement placement() const override { return placement_; }
  // A touch-up only deals single subdomains.
  [[nodiscard]] Dealing dealing(const LoadSnapshot& own) const override {
    return {dealing_.polish || wants_touch_up_alone(own), dealing_.tolerance};
  }

  [[nodiscard]] std::vector<Move> plan(const LoadSnapshot& snapshot, Rank) const override {
    if (snapshot.subdomains.empty() || snapshot.ranks.size() < 2) return {};
    if (has_no_use_for_parts(snapshot)) return moves_between(snapshot, deal_surplus(snapshot, dealing_.tolerance));
    const LoadSnapshot possible = within_memory(snapshot);
    const std::vector<Part> parts = zoltan_partition(possible, parameters_);
    const auto owners = keeps_parts() ? owners_of(parts) : remap_parts(possible, parts, dealing_.tolerance);
    LoadSnapshot planned = possible;
    for (std::size_t i = 0; i < owners.size(); ++i)
      if (!planned.subdomains[i].fixed) planned.subdomains[i].owner = owners[i];
    keep_within_memory(snapshot, planned);
    sum_up(planned);
    if (dealing_.polish) planned = deal_surplus(planned, dealing_.tolerance);
    return moves_between(snapshot, planned);
  }

  [[nodiscard]] std::optional<std::vector<Move>> touch_up(const LoadSnapshot& snapshot) const override {
    return moves_between(snapshot, deal_surplus(snapshot, dealing_.tolerance));
  }

  [[nodiscard]] double planning_seconds(const LoadSnapshot& snapshot) const override {
    return has_no_use_for_parts(snapshot) ? 0 : PlanningCosts{}.seconds(effort_of_parts(snapshot, parameters_));
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

  [[nodiscard]] bool has_no_use_for_parts(const LoadSnapshot& snapshot) const {
    return wants_touch_up_alone(snapshot) || subdomains_per_part(snapshot) < part_size_;
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
  double part_size_;  // subdomains
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
  const double part_size = parameters.number("part-size", 4, 0, 1e9);
  return std::make_unique<ZoltanPolicy>(std::move(all), collective ? Placement::kCollective : Placement::kLeader,
                                        touch_up, dealing, most_moves, part_size);
}

}  // namespace driftmesh::balancer
