#include <string>

#include "base/atomic_file.hpp"
#include "base/line_writer.hpp"
#include "driftmesh/files.hpp"
#include "driftmesh/repair.hpp"
#include "mesh/with_seeds.hpp"

namespace driftmesh {
namespace {

void write_points(const Pslg& pslg, LineWriter& line) {
  const std::size_t attributes = pslg.attributes_per_point;
  const bool has_markers = !pslg.point_markers.empty();
  line.field(pslg.points.size()).field(2).field(attributes).field(has_markers ? 1 : 0).end();
  for (std::size_t i = 0; i < pslg.points.size(); ++i) {
    line.field(static_cast<std::int64_t>(i) + pslg.first_number).field(pslg.points[i].x).field(pslg.points[i].y);
    for (std::size_t k = 0; k < attributes; ++k) line.field(pslg.attributes[i * attributes + k]);
    if (has_markers) line.field(pslg.point_markers[i]);
    line.end();
  }
}

void write_segments(const Pslg& pslg, LineWriter& line) {
  line.field(pslg.segments.size()).field(1).end();
  std::int64_t number = pslg.first_number;
  for (const Pslg::Segment& s : pslg.segments)
    line.field(number++).field(s.a + pslg.first_number).field(s.b + pslg.first_number).field(s.marker).end();
}

void write_seeds(const Pslg& pslg, LineWriter& line) {
  std::int64_t number = 1;
  line.field(pslg.holes.size()).end();
  for (const Point& hole : pslg.holes) line.field(number++).field(hole.x).field(hole.y).end();
  if (pslg.regions.empty()) return;
  number = 1;
  line.field(pslg.regions.size()).end();
  for (const Pslg::Region& r : pslg.regions)
    line.field(number++).field(r.at.x).field(r.at.y).field(r.attribute).field(r.max_area).end();
}

/// The format has seeds only.
Pslg without_polygons(Pslg pslg) {
  static_cast<void>(repair(pslg));
  return with_seeds(pslg);
}

void write_seeded(const Pslg& pslg, const std::string& path) {
  AtomicFile file(path);
  LineWriter line(file);
  write_points(pslg, line);
  write_segments(pslg, line);
  write_seeds(pslg, line);
  file.commit();
}

}  // namespace

void write_poly(const Pslg& pslg, const std::string& path) {
  if (pslg.polygons.empty())
    write_seeded(pslg, path);
  else
    write_seeded(without_polygons(pslg), path);
}

}  // namespace driftmesh
