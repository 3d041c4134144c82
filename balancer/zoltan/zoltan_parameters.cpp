// Which of Zoltan's parameters can be used, and with which values this build of it works.
#include <memory>
#include <utility>

#include "balancer/zoltan/zoltan_partition.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh::balancer {

const std::vector<std::string>& zoltan_parameter_names() {
  static const std::vector<std::string> names{"ADD_OBJ_WEIGHT",
                                              "AVERAGE_CUTS",
                                              "CHECK_GEOM",
                                              "CHECK_GRAPH",
                                              "CHECK_HYPERGRAPH",
                                              "DETERMINISTIC",
                                              "GRAPH_BUILD_TYPE",
                                              "GRAPH_FAST_BUILD_BASE",
                                              "GRAPH_PACKAGE",
                                              "GRAPH_SYMMETRIZE",
                                              "GRAPH_SYM_WEIGHT",
                                              "HYPERGRAPH_PACKAGE",
                                              "IMBALANCE_TOL",
                                              "KEEP_CUTS",
                                              "LB_APPROACH",
                                              "LB_METHOD",
                                              "PHG_BAL_TOL_ADJUSTMENT",
                                              "PHG_COARSENING_LIMIT",
                                              "PHG_COARSENING_METHOD",
                                              "PHG_COARSEPARTITION_METHOD",
                                              "PHG_CUT_OBJECTIVE",
                                              "PHG_EDGE_SIZE_THRESHOLD",
                                              "PHG_EDGE_WEIGHT_OPERATION",
                                              "PHG_FROM_GRAPH_METHOD",
                                              "PHG_MATCH_MAX_NEIGHBORS",
                                              "PHG_MULTILEVEL",
                                              "PHG_OUTPUT_LEVEL",
                                              "PHG_PROCESSOR_REDUCTION_LIMIT",
                                              "PHG_RANDOMIZE_INPUT",
                                              "PHG_RCB_REDUCTION",
                                              "PHG_REFINEMENT_LIMIT",
                                              "PHG_REFINEMENT_LOOP_LIMIT",
                                              "PHG_REFINEMENT_METHOD",
                                              "PHG_REFINEMENT_QUALITY",
                                              "PHG_REPART_MULTIPLIER",
                                              "PHG_USE_TIMERS",
                                              "RCB_LOCK_DIRECTIONS",
                                              "RCB_MULTICRITERIA_NORM",
                                              "RCB_OUTPUT_LEVEL",
                                              "RCB_OVERALLOC",
                                              "RCB_RECOMPUTE_BOX",
                                              "RCB_RECTILINEAR_BLOCKS",
                                              "RCB_REUSE",
                                              "RCB_SET_DIRECTIONS",
                                              "REDUCE_DIMENSIONS",
                                              "DEGENERATE_RATIO",
                                              "SCOTCH_METHOD",
                                              "SCOTCH_STRAT",
                                              "SCOTCH_STRAT_FILE",
                                              "SCOTCH_TYPE",
                                              "SEED",
                                              "USE_TIMERS"};
  return names;
}

bool zoltan_partitions_with(const ZoltanParameters& parameters) {
  // Two subdomains, both on the first of two ranks.
  Layout layout;
  layout.ranks = 2;
  layout.subdomains.resize(2);
  layout.subdomains[SubdomainId{0}].neighbors = {{SubdomainId{1}, 1.0}};
  layout.subdomains[SubdomainId{1}].neighbors = {{SubdomainId{0}, 1.0}};
  LoadSnapshot trial;
  for (const SubdomainId id : ids_of(layout.subdomains)) trial.subdomains.push_back({id, Rank{0}, 1000, 100});
  trial.layout = std::make_shared<const Layout>(std::move(layout));
  trial.ranks.resize(2, RankLoad{1});
  sum_up(trial);
  try {
    static_cast<void>(zoltan_partition(trial, parameters));
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace driftmesh::balancer
