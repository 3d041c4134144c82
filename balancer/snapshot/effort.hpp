#pragma once

#include <cstddef>
#include <map>
#include <string>

/// How long planning takes, for simulated time: planners note what they do, and whoever simulates charges for it.
namespace driftmesh::balancer {

/// Work of planning, by kind. Its units grow like the time that it takes: subdomains for what looks at each once,
/// subdomains times the levels of bisection for what divides them into parts.
using Efforts = std::map<std::string, double>;

/// Collects what planners on this thread note while it exists.
class EffortLog {
 public:
  EffortLog();
  ~EffortLog();
  EffortLog(const EffortLog&) = delete;
  EffortLog& operator=(const EffortLog&) = delete;

  [[nodiscard]] const Efforts& efforts() const { return efforts_; }

 private:
  friend void note_effort(const char* kind, double units);
  EffortLog* outer_;
  Efforts efforts_;
};

/// To the innermost log of this thread, if there is one.
void note_effort(const char* kind, double units);

/// The levels of bisection that make this many parts, at least one.
[[nodiscard]] double bisections(std::size_t parts);

/// Seconds for each unit of effort on the reference machine. Measured by `driftmesh calibrate`; docs/benchmarks.md has
/// the machine.
struct PlanningCosts {
  std::map<std::string, double> unit = {{"snapshot", 26e-9},  // a subdomain in the planner's view of the load
                                        {"deal", 22e-9},     // a subdomain of which greedy asks whether it should leave
                                        {"place", 290e-9},   // one that leaves
                                        {"news", 10e-9},     // a rank in the broker's view of the load
                                        {"search", 2.5e-9},  // a rank that is considered for work, or asked for some
                                        {"weigh", 150e-9},   // a planned move
                                        {"remap", 65e-9},    // a subdomain of parts that are assigned to ranks
                                        {"mend", 30e-9},     // a change of a plan that is considered
                                        {"border", 150e-9},  // a subdomain whose borders with other ranks are added up
                                        // By Zoltan, a subdomain and a level of bisection:
                                        {"rcb", 25e-9},
                                        {"rib", 33e-9},
                                        {"hsfc", 42e-9},
                                        {"graph", 3.1e-6},
                                        {"hypergraph", 3.7e-6}};

  [[nodiscard]] double seconds(const Efforts& efforts) const;
};

}  // namespace driftmesh::balancer
