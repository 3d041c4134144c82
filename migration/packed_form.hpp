#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/bytes.hpp"
#include "decompose/subdomain_mesh.hpp"
#include "driftmesh/ids.hpp"
#include "mesh/refiner_state.hpp"
#include "migration/dormant_mesh.hpp"
#include "protocol/messages.hpp"

namespace driftmesh {

/// What a refiner at rest leaves beside a dormant mesh.
struct DormantBody {
  DormantMesh mesh;
  std::vector<SubsegmentId> unsplittable;  ///< of the mesh that wakes, ascending
  std::int64_t max_triangles = 0;
  RefineCounters counters;
  double forecast = 0;  ///< of triangles, as it was
};

/// A subdomain without what all subdomains of a run share.
struct SubdomainState {
  SubdomainId id{};
  bool refined = false;                           ///< it has met all bounds once
  std::vector<SplitPoint<GlobalRootId>> pending;  ///< points that it was told of and has not taken in
  struct Body {
    SubdomainMesh part;
    RefinerState refiner;
    double forecast = 0;  ///< of triangles, when all bounds are met
  };
  std::optional<Body> body;  ///< absent until it first works, and while it is dormant
  std::optional<DormantBody> dormant;
};

/// A view of the same, to pack without copying.
struct SubdomainView {
  SubdomainId id;
  bool refined;
  const std::vector<SplitPoint<GlobalRootId>>& pending;
  struct Body {
    const SubdomainMesh& part;
    const RefinerState& refiner;
    double forecast;
  };
  std::optional<Body> body;
  const DormantBody* dormant = nullptr;
};

/// The packed form: the bytes that migrate, and that a checkpoint holds (layout in docs/file-formats.md). For ranks of
/// one version of the program on machines of one kind. The same state gives the same bytes.
[[nodiscard]] Bytes pack(const SubdomainView& subdomain);

/// What is known of where bytes come from.
enum class Source {
  kUnknown,  ///< a file, or anything else that may not be what it says
  kThisRun,  ///< a rank of this run has just packed them: if the checksum is right, so is what it was made of
};

/// The subdomain that was packed. A refiner made from what comes out goes on exactly as the one packed would have.
///
/// Nothing is believed before it is checked: the length; each array's length against the bytes that are there, before
/// memory is asked for; the checksum, before anything that was read is used; then that the mesh is a triangulation
/// (triangulation_fault) with roots and points as they must be. For bytes of this run the checksum is the last of
/// these, except in builds with assertions: the rest takes twice as long as packing and unpacking. Throws Error
/// that says what is wrong with "the packed form of subdomain N". That the refiner's state fits the mesh and the bounds
/// is for its constructor to check.
[[nodiscard]] SubdomainState unpack(std::span<const std::byte> bytes, Source source = Source::kUnknown);

}  // namespace driftmesh
