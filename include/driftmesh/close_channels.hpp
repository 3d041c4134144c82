#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// What close_channels() filled. Areas are in squared units of the coordinates.
struct ClosedChannels {
  std::int64_t channels = 0;  ///< places that were filled
  double area = 0;            ///< of the domain that is gone
  std::int64_t parts = 0;     ///< that the domain consists of then, if anything was filled
  /// For each point of the result, its index before; -1 for a new one.
  std::vector<std::int32_t> original_point;
};

/// Closes the channels of a domain that are narrower than a width: fills creeks, straits and gaps, so that islands
/// beside them become part of the land. Afterward no disk in the domain touches its outline at two places that are less
/// than `width` apart, unless the way between them along the outline is at most twice as long.
/// - So corners of more than 60 degrees stay, and so do bays that are less than half as deep as wide; between two
///   islands, or an island and the shore, no line through the domain is shorter than `width`.
/// - That is measured between points on the outline an eighth of `width` apart or nearer. Property tests hold it to 3
///   percent of the width and 10 percent of the way.
/// - A channel is cut off straight across where it gets that narrow. Where the domain is too narrow at a single place,
///   between two headlands, the land between them is half as wide as the gap was, or less.
/// - Between three banks each two of which are that near nothing remains, though a wider disk may fit there.
/// - All parts that remain and into which a disk of that width fits are the domain. What is cut off from all of them
///   goes.
/// - New segments get the marker that most of the filled banks had. Other segments stay as they were, to the last bit;
///   where a channel leaves a long one, it ends there. Constraints end at new segments, points and segments in what was
///   filled go, and regions that are cut apart are one region still.
///
/// The result is described by polygons, is as repair() leaves it, and does not change if this is done again. If there
/// is nothing to close, `pslg` does not change at all.
///
/// `pslg` is as repair() leaves it. Throws Error for a width that is not positive and finite, or if `pslg` encloses
/// nothing, and InputError, naming `file`, if nothing would be left of the domain.
///
/// \code
/// driftmesh::Pslg bay = driftmesh::generate("bay");  // lengths in meters
/// driftmesh::repair(bay);
/// const driftmesh::ClosedChannels closed = driftmesh::close_channels(bay, 300);
/// std::cout << closed.channels << " channels closed, " << closed.area / 1e6 << " square kilometers\n";
/// assert(driftmesh::close_channels(bay, 300).channels == 0);
/// \endcode
ClosedChannels close_channels(Pslg& pslg, double width, const std::string& file = "input");

}  // namespace driftmesh
