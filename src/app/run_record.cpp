#include "app/run_record.hpp"

namespace driftmesh::app {

void record_mesh(RunRecord& run, const MeshResult& result) {
  run.complete = result.complete;
  run.acute_corners = result.acute_corners;
  add_part(run, result.mesh, result.bounds, result.complete);
  add_counters(run, result.counters);
}

}  // namespace driftmesh::app
