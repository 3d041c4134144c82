#include "oracles/meshing.hpp"

#include <cmath>
#include <sstream>

#include "driftmesh/error.hpp"
#include "driftmesh/repair.hpp"
#include "support/made_mesh.hpp"
#include "verify/report_text.hpp"
#include "verify/verify.hpp"

namespace driftmesh::oracles {
namespace {

/// Takes values from a string of bytes; zeros after its end.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  [[nodiscard]] bool empty() const { return bytes_.empty(); }
  std::uint8_t take() {
    if (bytes_.empty()) return 0;
    const std::uint8_t byte = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return byte;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

struct Grid {
  double step = 1;
  double offset = 0;
};

/// Two nibbles choose a place on a 16 x 16 grid; a third byte occasionally moves it off the grid.
Point take_point(ByteReader& bytes, const Grid& grid, bool nudged) {
  const std::uint8_t place = bytes.take();
  Point p{grid.offset + grid.step * (place & 15), grid.offset + grid.step * (place >> 4)};
  if (!nudged) return p;
  const std::uint8_t nudge = bytes.take();
  const auto shift = [&](double& x, int code) {
    if (code == 1) x = std::nextafter(x, HUGE_VAL);
    if (code == 2) x = std::nextafter(x, -HUGE_VAL);
    if (code >= 3) x += grid.step * std::ldexp(code % 2 == 0 ? 1.0 : -1.0, -3 * (code - 2));
  };
  shift(p.x, nudge & 15);
  shift(p.y, nudge >> 4);
  return p;
}

}  // namespace

MeshingOutcome repair_mesh_and_verify(Pslg input, const job::Request& request) {
  MeshingOutcome outcome;
  try {
    const testing::Made made = testing::made(input, request);
    repair(input);
    VerifyOptions options;
    options.min_angle = made.record.complete ? request.bounds.angle : 0;
    options.plain.area = made.record.complete ? request.bounds.area : 0;
    options.plain.region_areas = made.record.complete && request.bounds.region_areas;
    const VerifyReport report = verify(made.mesh, input, options);
    outcome.complete = made.record.complete;
    outcome.triangles = made.mesh.triangles.size();
    outcome.exceptions = report.quality.exception_count();
    if (!report.accepted()) outcome.failure = verdict_text(report, options) + "\n" + report_text(report, options);
  } catch (const Error& error) {
    outcome.refusal = error.what();
  }
  return outcome;
}

MeshingCase case_from_bytes(std::span<const std::uint8_t> data) {
  ByteReader bytes(data);
  MeshingCase result;
  Pslg& input = result.input;
  const std::uint8_t form = bytes.take(), bounds = bytes.take(), counts = bytes.take();
  const bool nudged = (form & 1) != 0;
  result.coarse = (form & 3) == 0;
  const Grid grid{(form & 2) != 0 ? 0.1 : 1.0, (form & 4) != 0 ? 1e6 : 0.0};
  constexpr double kAngles[] = {0, 10, 20, 20.7, 25, 28, 30, 20};
  constexpr double kAreas[] = {0, 0, 30, 3, 0.5, 0};
  result.request = testing::bounded(kAngles[bounds & 7], kAreas[(bounds >> 3) % 6] * grid.step * grid.step,
                                    result.coarse ? 60000 : 10000);

  const int points = 3 + (counts & 15), holes = counts >> 4 & 3, regions = counts >> 6 & 3;
  for (int i = 0; i < points; ++i) input.points.push_back(take_point(bytes, grid, nudged));
  for (int i = 0; i < holes; ++i) input.holes.push_back(take_point(bytes, grid, true));
  for (int i = 0; i < regions; ++i) {
    const Point at = take_point(bytes, grid, true);
    input.regions.push_back({at, i + 1.0, (i % 2) * grid.step * grid.step});
  }
  if ((form & 8) != 0)  // a ring around everything, so that most cases enclose something
    for (const auto& [x, y] : {std::pair(-1, -1), {16, -1}, {16, 16}, {-1, 16}}) {
      const auto a = static_cast<std::int32_t>(input.points.size());
      input.points.push_back({grid.offset + grid.step * x, grid.offset + grid.step * y});
      input.segments.push_back({a, x == -1 && y == 16 ? a - 3 : a + 1, 9});
    }
  const auto total = static_cast<std::uint8_t>(input.points.size());
  while (!bytes.empty() && input.segments.size() < 40) {
    const std::uint8_t a = bytes.take(), b = bytes.take();
    input.segments.push_back({a % total, b % total, (a + b) % 5});
  }
  return result;
}

std::string poly_text(const Pslg& input) {
  std::ostringstream out;
  out.precision(17);
  out << input.points.size() << " 2 0 0\n";
  for (std::size_t i = 0; i < input.points.size(); ++i)
    out << i << ' ' << input.points[i].x << ' ' << input.points[i].y << '\n';
  out << input.segments.size() << " 1\n";
  for (std::size_t i = 0; i < input.segments.size(); ++i)
    out << i << ' ' << input.segments[i].a << ' ' << input.segments[i].b << ' ' << input.segments[i].marker << '\n';
  out << input.holes.size() << '\n';
  for (std::size_t i = 0; i < input.holes.size(); ++i)
    out << i << ' ' << input.holes[i].x << ' ' << input.holes[i].y << '\n';
  out << input.regions.size() << '\n';
  for (std::size_t i = 0; i < input.regions.size(); ++i)
    out << i << ' ' << input.regions[i].at.x << ' ' << input.regions[i].at.y << ' ' << input.regions[i].attribute << ' '
        << input.regions[i].max_area << '\n';
  return out.str();
}

}  // namespace driftmesh::oracles
