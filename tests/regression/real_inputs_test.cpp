#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "driftmesh/repair.hpp"
#include "pslg/poly_file.hpp"
#include "support/made_mesh.hpp"
#include "verify/report_text.hpp"
#include "verify/verify.hpp"

using namespace driftmesh;

namespace {

struct RealInput {
  const char* file;
  double area;  ///< as published with the file, rounded; 0: not published
  bool small_angles;
};

constexpr RealInput kRealInputs[] = {{"pipe.poly", 187530.34, false},
                                     {"cylinder_flow.poly", 1399.60745, false},
                                     {"chesapeake.poly", 36722004389.78, true},
                                     {"key.poly", 0, false},
                                     {"A.poly", 0, true}};

}  // namespace

TEST_CASE("real inputs are meshed and verified against themselves") {
  const std::filesystem::path folder = DRIFTMESH_SOURCE_DIR "/../shared/data";
  if (!std::filesystem::exists(folder)) {
    MESSAGE("skipped: " << folder.string() << " does not exist");
    return;
  }
  for (const RealInput& real : kRealInputs) {
    CAPTURE(real.file);
    const Pslg given = read_poly((folder / real.file).string());
    Pslg input = given;
    repair(input);
    for (const double angle : {0.0, 20.0, 30.0}) {
      CAPTURE(angle);
      VerifyOptions options;
      options.min_angle = angle;
      if (angle == 20 && real.area > 0) options.plain.area = real.area / 5000;
      const Mesh mesh = testing::made(given, testing::bounded(angle, options.plain.area)).mesh;
      const VerifyReport report = verify(mesh, input, options);
      INFO(report_text(report, options));
      CHECK(report.accepted());
      if (real.area > 0) CHECK(report.area == doctest::Approx(real.area).epsilon(1e-7));
      if (!real.small_angles) CHECK(report.quality.exception_count() == 0);
    }
  }
}
