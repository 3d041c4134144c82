#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "mesh/mesher.hpp"
#include "mesh/to_piece.hpp"
#include "pslg/poly_file.hpp"
#include "pslg/repair.hpp"
#include "verify/verify.hpp"

using namespace driftmesh;

// Each file in regression/mesh is an input that the mesher once failed on; its first line says how.
TEST_CASE("inputs that once failed") {
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(DRIFTMESH_SOURCE_DIR "/tests/regression/mesh")) {
    ++files;
    CAPTURE(entry.path().string());
    Pslg pslg = read_poly(entry.path().string());
    repair(pslg);
    for (const double angle : {20.0, 33.0}) {
      MeshRequest request;
      request.min_angle = angle;
      const MeshResult result = mesh_domain(pslg, request);
      VerifyOptions options;
      options.min_angle = angle;
      const VerifyReport report = verify(to_piece(result.mesh, pslg), pslg, options);
      CHECK(report.accepted());
    }
  }
  CHECK(files >= 1);
}
