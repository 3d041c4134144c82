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

/// The state of a refiner at rest, in addition to a dormant mesh.
struct DormantBody {
  DormantMesh mesh;
  std::vector<SubsegmentId> unsplittable;  ///< subsegments in the restored mesh, ascending
  std::int64_t max_triangles = 0;
  RefineCounters counters;
  double forecast = 0;  ///< triangles, as it was
};

/// A subdomain without the data shared by all subdomains of a run.
struct SubdomainState {
  SubdomainId id{};
  bool refined = false;                           ///< it has met all bounds once
  std::vector<SplitPoint<GlobalRootId>> pending;  ///< received points not yet inserted
  struct Body {
    SubdomainMesh part;
    RefinerState refiner;
    double forecast = 0;  ///< triangles when all bounds are met
  };
  std::optional<Body> body;  ///< absent before its first slice of work, and while it is dormant
  std::optional<DormantBody> dormant;
};

/// A view of the same, for packing without copying.
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

/// The packed form: the bytes that migrate (layout in docs/file-formats.md). For ranks running the same version of the
/// program on machines of the same kind. The same state gives the same bytes. `room_behind`: for bytes that
/// will follow.
[[nodiscard]] Bytes pack(const SubdomainView& subdomain, std::size_t room_behind = 0);
/// The number of these bytes, without the time and memory that they take.
[[nodiscard]] std::uint64_t packed_size(const SubdomainView& subdomain);

/// The origin of packed bytes.
enum class Source {
  kUnknown,  ///< a file, or any other untrusted source
  kThisRun,  ///< just packed by a rank of this run: if the checksum is right, so is the content
};

/// Unpacks a subdomain. A refiner made from the result continues exactly as the packed one would have. Nothing is
/// trusted before it is checked: the length; each array's length against the available bytes, before memory is
/// allocated; the checksum, before anything is used; then that the mesh is a triangulation (triangulation_fault) with
/// valid roots and points. For bytes of this run the checksum is the last of these, except in builds with assertions:
/// the rest takes twice as long as packing and unpacking. Throws Error that says what is wrong with "the packed form of
/// subdomain N". That the refiner's state fits the mesh and the bounds is for its constructor to check.
[[nodiscard]] SubdomainState unpack(std::span<const std::byte> bytes, Source source = Source::kUnknown);

}  // namespace driftmesh
