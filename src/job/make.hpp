#pragma once

#include <functional>
#include <memory>

#include "decompose/decomposition.hpp"
#include "job/domain.hpp"
#include "job/key.hpp"
#include "job/place.hpp"
#include "job/record.hpp"
#include "job/request.hpp"
#include "job/triangulated.hpp"
#include "job/watch.hpp"

namespace driftmesh::job {

/// What becomes of a mesh, as far as that takes memory.
struct Wanted {
  bool mesh = false;      ///< it is written, drawn or returned
  bool whole = false;     ///< in one piece
  bool gathered = false;  ///< on rank 0, if there are others
};
[[nodiscard]] Wanted wanted_of(const Request::Output& output);

/// A request as an entry point makes it. References outlive the work.
struct Asked {
  const Request& request;
  EntryPoint by = kMesh;
  const Given& given;
  Wanted wanted{};
  std::function<void()> before{};  ///< called on rank 0 once the settings are checked, before anything is read
};

/// Makes a mesh: the one order of stages, for every entry point and place. Checks the request; reads, repairs and
/// triangulates the domain; finds limits, and refuses what exceeds them by far; cuts it and maps the parts to ranks,
/// unless it stays in one piece; refines. Where memory is short, finished subdomains sleep. What is known goes into
/// `record`, what happens to `watch`. With many ranks collective, and what fails on one fails on all. Throws KeyError
/// for settings, InputError and FileError for files, LimitError, Cancelled, and what callables of the caller throw.
[[nodiscard]] std::unique_ptr<Refined> make(const Asked& asked, Place& place, RunRecord& record, Watch& watch);

/// The part of a rank that knows of no request: does what rank 0 asks all ranks of `place` for.
[[nodiscard]] std::unique_ptr<Refined> follow(Place& place, Watch& watch);

/// A domain with sizes, triangulated.
struct TriangulatedDomain {
  Domain domain;
  Triangulated triangulated;
};

/// The same up to the triangulation.
[[nodiscard]] TriangulatedDomain make_triangulated(const Asked& asked, Watch& watch);

/// A domain, cut.
struct CutDomain {
  Domain domain;
  Decomposition decomposition;
  double seconds = 0;  ///< time that the cut took
};

/// The same up to the cut, for this number of ranks.
[[nodiscard]] CutDomain make_cut(const Asked& asked, std::int32_t ranks, Watch& watch);

}  // namespace driftmesh::job
