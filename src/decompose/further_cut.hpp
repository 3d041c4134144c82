#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/bytes.hpp"
#include "decompose/decomposition.hpp"
#include "decompose/subdomain_mesh.hpp"
#include "dyadic/path.hpp"
#include "mesh/bounds.hpp"

namespace driftmesh {

/// A way to cut one subdomain of a decomposition into several. Its separators end at points of the decomposition, at
/// points that refinement has put on its roots, and on each other, so that the subdomains around it stay as they are.
struct FurtherCut {
  /// A point of the decomposition as it will be.
  struct End {
    GlobalPointId known = kNoPoint;  ///< it is there already
    GlobalRootId root = kNone;       ///< or it is the midpoint of this interval of a root; kNone: inside the subdomain
    dyadic::Path path = 0;
    Point at{};
  };
  /// An interval of a root as a root, with the parts on its sides; kNone where the subdomain is not.
  struct Interval {
    dyadic::Path path = dyadic::kWhole;
    std::int32_t left = kNone, right = kNone;
  };
  struct Separator {
    std::int32_t a = 0, b = 0;         ///< they count `ends`
    std::int32_t left = 0, right = 0;  ///< parts on its sides
    std::uint16_t left_region = 0, right_region = 0;
  };

  SubdomainId whole{};
  std::vector<Decomposition::Subdomain> parts;
  std::vector<End> ends;  ///< with a point on a root also those of the intervals that contain it
  std::vector<Separator> separators;
  std::vector<std::vector<Interval>> roots;  ///< for each root of the subdomain, in its direction
  std::vector<std::int32_t> inner_points;    ///< the part of each point inside; kNone: a separator ends there
};

/// Cuts subdomain `s`, whose present mesh is `part`, into this many parts of about equal work, or fewer if they cannot
/// be made; none if it cannot be cut at all. `bounds`: with a size field. `forecast`: triangles. Deterministic.
[[nodiscard]] std::optional<FurtherCut> cut_further(const Decomposition& decomposition, SubdomainId s,
                                                    const SubdomainMesh& part, const QualityBounds& bounds,
                                                    double forecast, std::int32_t parts);

[[nodiscard]] Bytes to_bytes(const FurtherCut& cut);
[[nodiscard]] FurtherCut further_cut_from(ByteReader& reader);

}  // namespace driftmesh
