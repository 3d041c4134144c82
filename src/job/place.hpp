#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "balancer/policy_interface/policy_list.hpp"
#include "base/growing_array.hpp"
#include "base/key_text.hpp"
#include "base/staged_files.hpp"
#include "cluster/cluster_run.hpp"
#include "decompose/subdomain_mesh.hpp"
#include "driftmesh/distributed_piece.hpp"
#include "job/key.hpp"
#include "job/limits.hpp"
#include "job/order.hpp"
#include "job/record.hpp"
#include "job/triangulated.hpp"
#include "job/watch.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::job {

/// Draws a whole mesh. Empty: nothing is drawn.
using Draw = std::function<void(const Mesh&)>;

/// A mesh in subdomains that are to be refined further.
struct LiveMesh {
  RunPlan plan;  ///< without the size field
  Pslg pslg;     ///< repaired
  Rasters rasters;
  Limits limits;
  std::map<SubdomainId, SubdomainMesh> parts;
  /// The length that the size field asks for at each of their vertices; empty without one.
  std::map<SubdomainId, GrowingArray<double, VertexId>> lengths;
};

/// A mesh as refinement left it at its place. With many ranks each has one, and all calls are collective, in the same
/// order on all of them.
class Refined {
 public:
  virtual ~Refined() = default;
  Refined(const Refined&) = delete;
  Refined& operator=(const Refined&) = delete;

  /// Adds to the record of rank 0 what is known of the mesh and of those who made it. Once.
  virtual void report(RunRecord& record) = 0;
  /// What ranks did when, if the place records it; after report().
  [[nodiscard]] virtual ClusterRun history() { return {}; }
  /// By which subdomains were given out; null in one piece.
  [[nodiscard]] virtual const RunPlan* plan() const = 0;

  /// If a limit stopped the work, what is to be said of it; empty if the mesh meets its bounds. `kept`: the mesh is
  /// used nevertheless. Frees the mesh.
  [[nodiscard]] virtual KeyText shortfall(bool /*kept*/) { return {}; }

  /// Writes the files, and draws if `draw` is given. Frees the mesh. Throws FileError, on all ranks; Error at a place
  /// that keeps no mesh.
  virtual void write(const Request::Output& files, const Draw& draw, Watch& watch);
  /// This rank's piece of the mesh, which is all of it where there is one process. Frees the rest. Throws Error at a
  /// place that keeps no mesh.
  [[nodiscard]] virtual DistributedPiece take_piece(Watch& watch);
  /// The subdomains of this process, for more generations, which have the bounds of the request. Frees the rest. Throws
  /// Error at a place that keeps none.
  [[nodiscard]] virtual LiveMesh take_live(const Request& request);
  /// Saves the same as an adaptive mesh that nobody has adapted yet (adapt/saved.hpp), in the file that the request
  /// names, and frees nothing. Throws FileError, on all ranks; Error at a place that keeps no mesh.
  virtual void save(const Request& request, Watch& watch);

 protected:
  Refined() = default;
};

/// Where a mesh is made: what make() asks of it is all that differs between one process, ranks of MPI and simulated
/// ones.
class Place {
 public:
  virtual ~Place() = default;
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

  /// Decides which settings have a meaning here.
  [[nodiscard]] virtual PlaceKind kind() const = 0;
  /// Who shares the work: threads, ranks, simulated ranks.
  [[nodiscard]] virtual std::int32_t ranks() const = 0;
  /// Whether these are processes that tell each other of themselves, even if there is only one.
  [[nodiscard]] virtual bool is_team() const { return false; }
  /// Who shares the memory of the machine.
  [[nodiscard]] virtual Processes processes() const { return {}; }
  /// Whether the domain is cut.
  [[nodiscard]] virtual Cut cut(const Request& /*request*/) const { return Cut::kAlways; }
  /// Speeds of the ranks; on real ones, only their ratios.
  [[nodiscard]] virtual IdVector<Rank, double> speeds(const Request& request) const = 0;

  /// The number of pieces that a file in pieces has.
  [[nodiscard]] virtual std::int32_t pieces(const Decomposition& /*decomposition*/) const { return ranks(); }

  [[nodiscard]] virtual bool leads() const { return true; }
  /// Has rank 0 make an order and hands it to all. What it throws is thrown on all.
  [[nodiscard]] virtual Order share(const std::function<Order()>& make) { return make(); }
  /// Does what the order says, within limits. `size`: replaces the size field that the order describes, unless null.
  /// Throws what the work throws, LimitError at a limit; on all ranks alike.
  [[nodiscard]] virtual std::unique_ptr<Refined> refine(Order&& order, const Limits& limits, const SizeField* size,
                                                        Watch& watch) = 0;

  /// Each rank does its part, and all throw alike if one of them fails.
  virtual void agree(const std::function<void()>& work) { work(); }
  /// What all have staged, on rank 0.
  [[nodiscard]] virtual std::vector<StagedFiles::Listed> staged(const StagedFiles& files) { return files.files(); }
  /// All that is staged appears, or nothing.
  virtual void commit(StagedFiles& files) { files.commit(); }

 protected:
  Place() = default;
};

}  // namespace driftmesh::job
