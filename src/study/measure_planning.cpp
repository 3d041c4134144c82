#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "balancer/cost/move_cost.hpp"
#include "balancer/planner/mend_plan.hpp"
#include "balancer/planner/remap_parts.hpp"
#include "balancer/planner/surplus.hpp"
#include "balancer/policies/policy_factory.hpp"
#include "balancer/snapshot/effort.hpp"
#include "balancer/snapshot/knowledge.hpp"
#include "balancer/snapshot/rank_board.hpp"
#include "balancer/snapshot/rank_news.hpp"
#include "balancer/zoltan/zoltan_partition.hpp"
#include "base/letter_case.hpp"
#include "study/measure_costs.hpp"
#include "study/thread_seconds.hpp"

namespace driftmesh::study {
namespace {

using namespace balancer;

/// A square of subdomains, dealt in rows to ranks of which every third is half as fast.
std::shared_ptr<const Layout> square(std::int32_t side, std::int32_t ranks) {
  Layout layout;
  layout.ranks = ranks;
  for (std::int32_t i = 0; i < side * side; ++i) {
    const std::int32_t x = i % side, y = i / side;
    Layout::Subdomain s{x + 0.5, y + 0.5, 15e3 + 137 * (i % 73), Rank{}, {}};
    s.owner = Rank{static_cast<std::int32_t>(static_cast<std::int64_t>(i) * ranks / (side * side))};
    if (y > 0) s.neighbors.push_back({SubdomainId{i - side}, 1});
    if (x > 0) s.neighbors.push_back({SubdomainId{i - 1}, 1});
    if (x + 1 < side) s.neighbors.push_back({SubdomainId{i + 1}, 1});
    if (y + 1 < side) s.neighbors.push_back({SubdomainId{i + side}, 1});
    layout.subdomains.push_back(std::move(s));
  }
  return std::make_shared<const Layout>(std::move(layout));
}

/// All that rank 0 knows when every rank has reported.
Knowledge knowledge_of(const std::shared_ptr<const Layout>& layout, double slow) {
  IdVector<Rank, LoadReport> reports(to_index(layout->ranks));
  for (const SubdomainId s : ids_of(layout->subdomains))
    reports[(*layout)[s].owner].loads.push_back({s, 0, (*layout)[s].predicted, 100});
  Knowledge knowledge(layout, 1);
  for (const Rank r : ids_of(reports)) {
    reports[r].round = 1;
    reports[r].speed = to_int(r) % 3 == 0 ? slow : 1e6;
    knowledge.hear(r, reports[r], 0);
  }
  return knowledge;
}

/// Seconds and units of each kind of effort, summed over all that was measured.
class Measured {
 public:
  explicit Measured(int repetitions) : repetitions_(repetitions) {}

  /// `action` is mainly effort of this kind; what it notes of kinds that are known already is subtracted.
  void add(const std::string& kind, const std::function<void()>& action) {
    double seconds = HUGE_VAL;
    Efforts efforts;
    for (int i = 0; i < repetitions_; ++i) {
      const EffortLog log;
      const double start = thread_seconds();
      action();
      seconds = std::min(seconds, thread_seconds() - start);
      efforts = log.efforts();
    }
    const double units = efforts[kind];
    efforts.erase(kind);
    const double others = costs().seconds(efforts);
    Sum& sum = sums_[kind];
    sum.seconds += std::max(0.0, seconds - others);
    sum.units += units;
  }

  /// Large cases count most.
  [[nodiscard]] PlanningCosts costs() const {
    PlanningCosts costs;
    for (const auto& [kind, sum] : sums_)
      if (sum.units > 0) costs.unit[kind] = sum.seconds / sum.units;
    return costs;
  }

 private:
  int repetitions_;
  struct Sum {
    double seconds = 0, units = 0;
  };
  std::map<std::string, Sum> sums_;
};

/// The same, and each part belongs to the rank of its number.
LoadSnapshot in_parts(LoadSnapshot snapshot, const std::vector<Part>& parts) {
  for (std::size_t i = 0; i < parts.size(); ++i) snapshot.subdomains[i].owner = Rank{to_int(parts[i])};
  sum_up(snapshot);
  return snapshot;
}

void measure_size(Measured& measured, std::int32_t side, std::int32_t ranks) {
  const auto layout = square(side, ranks);
  const Knowledge equal = knowledge_of(layout, 1e6), unequal = knowledge_of(layout, 0.5e6);
  measured.add("snapshot", [&] { static_cast<void>(unequal.snapshot(0, true)); });
  const LoadSnapshot balanced = equal.snapshot(0, true), snapshot = unequal.snapshot(0, true);
  LoadSnapshot dealt;
  measured.add("deal", [&] { dealt = deal_surplus(balanced, 0.5); });
  measured.add("place", [&] { dealt = deal_surplus(snapshot, 0.02); });
  const RankNews news(*layout, 0);
  measured.add("news", [&] { static_cast<void>(RankBoard(news, layout, 0)); });
  const auto stealing = make_policy("stealing");
  const IdVector<Rank, bool> able(to_index(ranks), true);
  measured.add("search", [&] { static_cast<void>(stealing->victim(snapshot, Rank{0}, able)); });
  measured.add("weigh", [&] { static_cast<void>(worth_moving(snapshot, moves_between(snapshot, dealt), {})); });
  measured.add("border", [&] { static_cast<void>(border_between_ranks(snapshot)); });
  std::vector<Part> parts = zoltan_partition(snapshot, {});  // the first time, it starts MPI
  for (const char* method : {"RCB", "RIB", "HSFC", "GRAPH", "HYPERGRAPH"}) {
    ZoltanParameters parameters{{"LB_METHOD", method}, {"IMBALANCE_TOL", "1.03"}, {"PHG_EDGE_SIZE_THRESHOLD", "1.0"}};
    if (parameters["LB_METHOD"] == "GRAPH") parameters["GRAPH_PACKAGE"] = "PHG";
    measured.add(lower_case(method), [&] { parts = zoltan_partition(snapshot, parameters); });
  }
  const std::vector<Move> whole = moves_between(snapshot, in_parts(snapshot, parts));
  const double soon = 1.03 * ideal_time(snapshot);
  measured.add("mend", [&] { static_cast<void>(mend_plan(snapshot, whole, {}, {soon, soon, whole.size() / 2})); });
  measured.add("remap", [&] { static_cast<void>(remap_parts(snapshot, parts, 0.02)); });
}

}  // namespace

PlanningCosts measure_planning(bool quick) {
  Measured measured(quick ? 1 : 3);
  measure_size(measured, 24, 8);
  if (quick) return measured.costs();
  measure_size(measured, 63, 144);
  measure_size(measured, 143, 1024);
  return measured.costs();
}

}  // namespace driftmesh::study
