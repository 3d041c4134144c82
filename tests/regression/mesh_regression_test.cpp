#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "driftmesh/repair.hpp"
#include "mesh/mesher.hpp"
#include "mesh/to_piece.hpp"
#include "pslg/poly_file.hpp"
#include "verify/verify.hpp"

using namespace driftmesh;

// Each file in regression/mesh is an input on which the mesher once failed; its first line says how.
TEST_CASE("inputs that once failed") {
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(DRIFTMESH_SOURCE_DIR "/tests/regression/mesh")) {
    ++files;
    CAPTURE(entry.path().string());
    Pslg pslg = read_poly(entry.path().string());
    repair(pslg);
    for (const double angle : {20.0, 25.0, 28.0, 33.0})
      for (const double area : {0.0, 0.5}) {
        CAPTURE(angle);
        CAPTURE(area);
        MeshRequest request;
        request.min_angle = angle;
        request.max_area = area;
        request.max_triangles = 60'000;  // some have slits of 1e-10
        const MeshResult result = mesh_domain(pslg, request);
        VerifyOptions options;
        if (result.complete) {
          options.min_angle = angle;
          options.max_area = area;
        }
        const VerifyReport report = verify(to_piece(result.mesh, pslg), pslg, options);
        CHECK(report.findings.count(Flaw::kNotDelaunay) == 0);
        CHECK(report.accepted());
      }
  }
  CHECK(files >= 1);
}
