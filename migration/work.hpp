#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "driftmesh/ids.hpp"
#include "protocol/messages.hpp"

namespace driftmesh {

/// What a slice of work did.
struct SliceWork {
  std::int64_t points = 0;     ///< inserted
  std::int64_t triangles = 0;  ///< more than before
  bool begun = false;          ///< whether it was the first slice
  std::int64_t prepared = 0;   ///< triangles of the initial triangulation, if it was made in this slice
  std::int64_t woken = 0;      ///< triangles of the dormant mesh, if it was woken in this slice
  std::int64_t asleep = 0;     ///< triangles that have fallen asleep at its end
  double seconds = 0;          ///< on the reference machine, besides what the above costs: work that is only counted
};

/// How far some work has come.
struct WorkState {
  bool active = false;             ///< there is something to do, for now
  bool started = false;            ///< it has been worked on
  bool refined = false;            ///< it has met all bounds once; what it is told later may make more work
  std::size_t backlog = 0;         ///< points it was told of that it has not taken in yet
  std::int64_t triangles = 0;      ///< now
  double predicted = 0;            ///< triangles in the end, as forecast before it was started
  double forecast = 0;             ///< the same as forecast now
  double remaining = 0;            ///< triangles still to be made, as forecast; 0 when it is not active
  std::uint64_t packed_bytes = 0;  ///< estimated size of pack()
};

/// What a rank works on, slice by slice, and can hand over to another rank between two slices: a subdomain, or work
/// that is only counted. A rank's loop calls it once a slice and once a message, never inside a slice.
class Work {
 public:
  explicit Work(SubdomainId id) : id_(id) {}
  virtual ~Work() = default;

  [[nodiscard]] SubdomainId id() const { return id_; }
  [[nodiscard]] virtual WorkState state() const = 0;
  /// Neighbors have put these points on common borders.
  virtual void tell(std::span<const SplitPoint<GlobalRootId>> splits) = 0;
  /// Works for about this many insertions, and appends to `said` the points that it put on borders. What it throws ends
  /// the run.
  virtual SliceWork work(std::int64_t insertions, std::vector<SplitPoint<GlobalRootId>>& said) = 0;
  /// It has nothing to do, for now, and may sleep. Returns the triangles that have fallen asleep.
  virtual std::int64_t rest() { return 0; }
  /// Everything as bytes, of which Holding::unpack makes work that continues exactly as this one would.
  [[nodiscard]] virtual Bytes pack() const = 0;

 protected:
  Work(const Work&) = default;
  Work(Work&&) = default;
  Work& operator=(const Work&) = default;
  Work& operator=(Work&&) = default;

 private:
  SubdomainId id_;
};

/// The work that one rank holds, all of one kind, which only this class knows.
class Holding {
 public:
  virtual ~Holding() = default;

  /// Null for work that is not here.
  [[nodiscard]] virtual Work* find(SubdomainId id) = 0;
  /// Visits all work here in the order of numbers.
  virtual void each(const std::function<void(const Work&)>& visit) const = 0;
  /// Adds what another rank has packed. Throws Error for bytes that are no work of this kind and run.
  virtual Work& unpack(std::span<const std::byte> packed) = 0;
  /// Forgets work that is here.
  virtual void drop(SubdomainId id) = 0;

 protected:
  Holding() = default;
  Holding(const Holding&) = default;
  Holding(Holding&&) = default;
  Holding& operator=(const Holding&) = default;
  Holding& operator=(Holding&&) = default;
};

/// Holds work of the class Kind.
template <class Kind>
class HoldingOf : public Holding {
 public:
  [[nodiscard]] Work* find(SubdomainId id) final {
    const auto place = all_.find(id);
    return place == all_.end() ? nullptr : &place->second;
  }
  void each(const std::function<void(const Work&)>& visit) const final {
    for (const auto& [id, work] : all_) visit(work);
  }
  void drop(SubdomainId id) final { all_.erase(id); }

  Kind& put(Kind&& work) { return all_.insert_or_assign(work.id(), std::move(work)).first->second; }
  [[nodiscard]] const std::map<SubdomainId, Kind>& all() const { return all_; }
  [[nodiscard]] std::map<SubdomainId, Kind> take() { return std::move(all_); }

 private:
  std::map<SubdomainId, Kind> all_;
};

}  // namespace driftmesh
