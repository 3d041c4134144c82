#pragma once

#include <cstdint>
#include <memory>

#include "decompose/decomposition.hpp"
#include "driftmesh/mesh.hpp"
#include "driftmesh/pslg.hpp"
#include "job/check.hpp"
#include "job/here.hpp"
#include "job/make.hpp"

// Meshes as users make them: by the one maker, in this process, in few words.
namespace driftmesh::testing {

struct Made {
  Mesh mesh;
  job::RunRecord record;
  Decomposition decomposition;  ///< empty in one piece
};

/// A request for a mesh in one piece with these bounds; 0: none. At `most` triangles refinement stops, and the mesh is
/// kept.
[[nodiscard]] inline job::Request bounded(double angle, double area = 0,
                                          std::int64_t most = job::Request{}.limits.max_triangles) {
  job::Request request;
  request.bounds.angle = angle;
  request.bounds.area = area;
  request.decomposition.subdomains = 1;
  request.limits.max_triangles = most;
  request.limits.keep_incomplete = true;
  return request;
}

/// Makes the mesh of an input as its author has it, not yet repaired, as `driftmesh mesh` does: in subdomains if the
/// request has several. `size`: a function of the caller, or null. Throws what make throws.
[[nodiscard]] inline std::unique_ptr<job::Refined> refined_here(const Pslg& input, const job::Request& request,
                                                                const SizeField* size, job::RunRecord& record,
                                                                job::Watch& watch) {
  job::Here here(job::place_of(request, job::kMesh, false), 1);
  const job::Given given{.input = &input, .size = size};
  auto refined = job::make({request, job::kMesh, given, {.mesh = true, .whole = true}}, here, record, watch);
  record.stages = watch.take_stages();
  refined->report(record);
  return refined;
}

/// The same, to the end.
[[nodiscard]] inline Made made(const Pslg& input, const job::Request& request, const SizeField* size = nullptr) {
  Made made;
  job::Watch watch;
  const std::unique_ptr<job::Refined> refined = refined_here(input, request, size, made.record, watch);
  if (refined->plan() != nullptr) made.decomposition = refined->plan()->decomposition;
  made.mesh = refined->take_piece(watch).mesh;
  made.record.warnings = watch.take_warnings();
  return made;
}

}  // namespace driftmesh::testing
