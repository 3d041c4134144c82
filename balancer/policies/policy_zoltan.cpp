#include <algorithm>
#include <memory>
#include <utility>

#include "balancer/planner/remap_parts.hpp"
#include "balancer/planner/surplus.hpp"
#include "balancer/planner/within_memory.hpp"
#include "balancer/snapshot/effort.hpp"
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
  struct Options {
    bool polish = true;       ///< even out unbalanced parts by moving single subdomains
    double tolerance = 0.02;  ///< fraction of a rank's share
    double touch_up = 0.1;    ///< fraction of the ideal time: a smaller imbalance needs no new parts
    double most_moves = 2;    ///< see Policy::most_moves
    double part_size = 4;     ///< subdomains: of smaller parts none are made
  };

  ZoltanPolicy(ZoltanParameters parameters, const Options& options)
      : parameters_(std::move(parameters)), options_(options) {}

  [[nodiscard]] Placement placement() const override { return Placement::kLeader; }

  [[nodiscard]] std::vector<Move> plan(const LoadSnapshot& snapshot, Rank) const override {
    if (snapshot.subdomains.empty() || snapshot.ranks.size() < 2) return {};
    if (has_no_use_for_parts(snapshot)) return moves_of_single_ones(snapshot);
    const LoadSnapshot possible = within_memory(snapshot);
    const std::vector<Part> parts = zoltan_partition(possible, parameters_);
    const auto owners = keeps_parts() ? owners_of(parts) : remap_parts(possible, parts, options_.tolerance);
    LoadSnapshot planned = possible;
    for (std::size_t i = 0; i < owners.size(); ++i)
      if (!planned.subdomains[i].fixed) planned.subdomains[i].owner = owners[i];
    keep_within_memory(snapshot, planned);
    sum_up(planned);
    if (options_.polish) planned = deal_surplus(planned, options_.tolerance);
    return moves_between(snapshot, planned);
  }

  [[nodiscard]] std::optional<std::vector<Move>> touch_up(const LoadSnapshot& snapshot) const override {
    return moves_of_single_ones(snapshot);
  }

  [[nodiscard]] double planning_seconds(const LoadSnapshot& snapshot) const override {
    return has_no_use_for_parts(snapshot) ? 0 : PlanningCosts{}.seconds(effort_of_parts(snapshot, parameters_));
  }

  [[nodiscard]] double most_moves() const override { return options_.most_moves; }

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
    return finishing_time(snapshot) <= (1 + options_.touch_up) * ideal_time(snapshot) ||
           subdomains_per_part(snapshot) < options_.part_size;
  }
  [[nodiscard]] std::vector<Move> moves_of_single_ones(const LoadSnapshot& snapshot) const {
    return moves_between(snapshot, deal_surplus(snapshot, options_.tolerance));
  }

  ZoltanParameters parameters_;
  Options options_;
};

/// Rank 0 plans for all. Input files may still ask for plans of all ranks at once, which earlier versions made.
void require_leader(Parameters& parameters) {
  const auto given = parameters.any_of({"placement"});
  if (given.contains("placement") && given.at("placement") == "collective")
    parameters.fail("placement", "collective",
                    "leave it out, and rank 0 plans for all; where that takes too long, use the policy stealing");
  static_cast<void>(parameters.choice("placement", {"leader"}));
}

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
  require_leader(parameters);
  ZoltanPolicy::Options options;
  options.polish = parameters.flag("polish", options.polish);
  options.tolerance = parameters.number("tolerance", options.tolerance, 0, 10);
  options.touch_up = parameters.number("touch-up", options.touch_up, 0, 10);
  options.most_moves = parameters.number("most-moves", options.most_moves, 0, 1e9);
  options.part_size = parameters.number("part-size", options.part_size, 0, 1e9);
  return std::make_unique<ZoltanPolicy>(std::move(all), options);
}

}  // namespace driftmesh::balancer
