#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "driftmesh/repair.hpp"
#include "pslg/poly_file.hpp"
#include "support/made_mesh.hpp"
#include "verify/verify.hpp"

using namespace driftmesh;

// Each file in regression/mesh is an input on which the mesher once failed; its first line says how.
TEST_CASE("inputs that once failed") {
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(DRIFTMESH_SOURCE_DIR "/tests/regression/mesh")) {
    ++files;
    CAPTURE(entry.path().string());
    const Pslg pslg = read_poly(entry.path().string());
    Pslg repaired = pslg;
    repair(repaired);
    for (const double angle : {20.0, 25.0, 28.0, 33.0})
      for (const double area : {0.0, 0.5}) {
        CAPTURE(angle);
        CAPTURE(area);
        // Some have slits of 1e-10.
        const testing::Made made = testing::made(pslg, testing::bounded(angle, area, 60'000));
        VerifyOptions options;
        if (made.record.complete) {
          options.min_angle = angle;
          options.plain.area = area;
        }
        const VerifyReport report = verify(made.mesh, repaired, options);
        CHECK(report.findings.count(Flaw::kNotDelaunay) == 0);
        CHECK(report.accepted());
      }
  }
  CHECK(files >= 1);
}
