#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "decompose/decomposition.hpp"
#include "decompose/presplit.hpp"
#include "decompose/subdomain_mesh.hpp"
#include "driftmesh/ids.hpp"
#include "mesh/bounds.hpp"
#include "mesh/refine_counters.hpp"
#include "migration/beginning.hpp"
#include "migration/packed_form.hpp"
#include "migration/stored_bulk.hpp"
#include "migration/work.hpp"

namespace driftmesh {

class Subdomain;

/// Shared by all subdomains of a run, equal on every rank but for the file and the observer. Not owned; must outlive
/// them.
struct SubdomainContext {
  const Decomposition* decomposition = nullptr;
  QualityBounds bounds;
  bool presplit = false;  ///< cut interfaces to the bounds' size before refinement (see decompose/presplit.hpp)
  ScratchFile* scratch = nullptr;                 ///< where those that sleep keep most of their bytes; null: in memory
  const PresplitPaths* presplit_paths = nullptr;  ///< those to take; null: those of the bounds
  const IdVector<SubdomainId, Beginning>* beginnings = nullptr;  ///< one for each; null: all begin with their outlines
  bool sleep = false;                                            ///< whether subdomains that rest() fall asleep
  /// Called before that, by whichever thread has worked on the subdomain; may be empty.
  std::function<void(const Subdomain&)> finished{};
};

/// One subdomain: it refines itself, reports the points it inserts on shared edges, and inserts those of its neighbors.
/// Its mesh is made in its first slice of work; until then it is only a number and a queue of received points.
///
/// A split point from a neighbor is queued and inserted in the next slice, with its ancestors, in any order of arrival
/// and any number of times: the points on a shared edge are a set that only grows (docs/protocol.md). When it has
/// nothing to do it can be put to sleep: it then takes a third of the memory, or less, and wakes by itself when it
/// receives a point that it does not have.
///
/// Sleep, moves and pauses change no bit of the mesh: once its bounds are met, a subdomain refines on in an order that
/// does not depend on how its mesh is stored (see refiner.hpp).
class Subdomain final : public Work {
 public:
  Subdomain(SubdomainId id, const SubdomainContext& context);
  Subdomain(Subdomain&&) noexcept;
  Subdomain& operator=(Subdomain&&) noexcept;
  ~Subdomain() override;

  [[nodiscard]] WorkState state() const override;
  /// Whether there is something to do: bounds not met yet, or points to insert.
  [[nodiscard]] bool active() const { return !refined_ || !pending_.empty(); }
  /// Whether it has met all bounds once. Points received later may make more work.
  [[nodiscard]] bool refined() const { return refined_; }
  /// Received points not yet inserted.
  [[nodiscard]] std::size_t backlog() const { return pending_.size(); }
  /// A forecast of its triangles when all bounds are met: the decomposition's until it has started, then its own.
  [[nodiscard]] double forecast() const;
  /// A forecast of the triangles still to be made; 0 when it is not active.
  [[nodiscard]] double remaining() const;
  /// The current number of triangles.
  [[nodiscard]] std::int64_t triangles() const;

  /// Estimated size of pack(), in bytes.
  [[nodiscard]] std::uint64_t packed_bytes() const;

  /// A neighbor has inserted a point on a shared edge.
  void tell(const SplitPoint<GlobalRootId>& split) {
    if (!has(split)) pending_.push_back(split);
  }
  void tell(std::span<const SplitPoint<GlobalRootId>> splits) override {
    for (const SplitPoint<GlobalRootId>& split : splits) tell(split);
  }

  /// Works for about this many insertions. Points inserted on shared edges are appended to `said`, each after its
  /// ancestors. Throws Error if a shared edge cannot be split where the neighbor has split it, LimitError at the
  /// capacity of handles.
  SliceWork work(std::int64_t insertions, std::vector<SplitPoint<GlobalRootId>>& said) override;

  /// Does with a subdomain that has nothing to do what the context says.
  std::int64_t rest() override;

  /// Shrinks to the dormant form (see dormant_mesh.hpp), if it has worked and has nothing to do; with a scratch file
  /// most of it goes there. Refinement after waking, if any, is bit for bit that without sleep.
  void sleep();
  void wake();
  [[nodiscard]] bool dormant() const { return dormant_ != nullptr; }
  /// The mesh as it would be awake. Only while dormant().
  [[nodiscard]] SubdomainMesh woken() const;
  /// The dormant mesh, read from the scratch file if it is there. Only while dormant().
  [[nodiscard]] DormantMesh dormant_mesh() const { return whole_dormant().mesh; }

  /// Everything as bytes (see packed_form.hpp), very few before the first work(); the subdomain that unpack makes of
  /// them continues exactly as this one would.
  [[nodiscard]] Bytes pack() const override;
  /// The same in the fewest bytes: what has nothing to do is packed asleep, though it stays awake.
  [[nodiscard]] Bytes pack_small() const;
  /// Throws Error, naming the subdomain, for bytes that are not the packed form of a subdomain of this context.
  [[nodiscard]] static Subdomain unpack(std::span<const std::byte> bytes, const SubdomainContext& context,
                                        Source source = Source::kUnknown);

  /// The current mesh. Only after the first work(), and while awake.
  [[nodiscard]] const SubdomainMesh& mesh() const;
  [[nodiscard]] bool started() const { return body_ != nullptr || dormant_ != nullptr; }
  /// Gives its mesh away, awake. Only after the first work(); the object can only be destroyed then.
  [[nodiscard]] SubdomainMesh take_mesh();
  /// The length that the size field asks for at each vertex; empty without one. While mesh() is there.
  [[nodiscard]] const GrowingArray<double, VertexId>& lengths() const;
  [[nodiscard]] const RefineCounters& counters() const;

 private:
  struct Body;  // the mesh and its refiner

  [[nodiscard]] const Beginning* beginning() const;
  [[nodiscard]] QualityBounds bounds() const;
  void make_body();
  [[nodiscard]] std::vector<dyadic::Path> presplit_of(GlobalRootId root) const;
  [[nodiscard]] DormantBody whole_dormant() const;
  [[nodiscard]] DormantBody asleep() const;
  void fall_asleep(DormantBody&& dormant);
  [[nodiscard]] bool has(const SplitPoint<GlobalRootId>& split) const;
  void take_in(const SplitPoint<GlobalRootId>& split);
  void say_new_points(std::vector<SplitPoint<GlobalRootId>>& said);

  const SubdomainContext* context_;
  bool refined_ = false;
  std::vector<SplitPoint<GlobalRootId>> pending_;
  std::unique_ptr<Body> body_;  // at most one of the two
  std::unique_ptr<DormantBody> dormant_;
  std::optional<StoredBulk> stored_;  // what dormant_ lacks
};

}  // namespace driftmesh
