#pragma once

#include <string>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "report/packed_frames.hpp"

namespace driftmesh {

/// A run as its files describe it.
struct ReportedRun {
  std::string name;
  std::string record;    ///< JSON
  std::string timeline;  ///< JSON: {busy, plans, load}; empty if there is none
};

struct ReportedMesh {
  std::string name;
  Mesh mesh;
  std::vector<float> sizes;  ///< the length of edges asked for in the middle of each triangle; empty if it is not known
};

/// Whether this program was built with the page (it is put together by npm).
[[nodiscard]] bool has_report_page();

/// A page of HTML that shows runs, a mesh unless it has no triangles, and frames unless null, in a browser, without a
/// network: scripts, styles and data are in it. Throws Error without has_report_page().
[[nodiscard]] std::string report_page(const std::vector<ReportedRun>& runs, const ReportedMesh& mesh,
                                      const PackedFrames* frames = nullptr);

}  // namespace driftmesh
