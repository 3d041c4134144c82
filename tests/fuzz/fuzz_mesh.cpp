#include <cstdio>
#include <cstdlib>

#include "oracles/meshing.hpp"

// Any bytes -> a small input -> repair -> mesh -> verify. Aborts if the mesh is wrong, or if refinement reaches the cap
// without tiny features as a reason; an Error is a valid outcome.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace driftmesh::oracles;
  const MeshingCase c = case_from_bytes({data, size});
  const MeshingOutcome outcome = repair_mesh_and_verify(c.input, c.request);
  const bool endless = !outcome.complete && c.coarse && c.request.bounds.angle <= 25;
  if (outcome.failure.empty() && !endless) return 0;
  std::fprintf(stderr, "angle %g, area %g: %s\n%s", c.request.bounds.angle, c.request.bounds.area,
               endless ? "refinement does not end" : outcome.failure.c_str(), poly_text(c.input).c_str());
  std::abort();
}
