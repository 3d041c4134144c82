#include "triangle/triangulate.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/key_error.hpp"
#include "base/mix.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/mesh.hpp"
#include "geometry/triangle_geometry.hpp"
#include "job/domain.hpp"
#include "job/here.hpp"
#include "job/make.hpp"
#include "job/record.hpp"
#include "mesh/mesh_edges.hpp"
#include "triangle/derived.hpp"
#include "triangle/old_mesh.hpp"
#include "verify/report_text.hpp"
#include "verify/verify.hpp"

namespace driftmesh::triangle {
namespace {

constexpr const char* kInput = "input";

class CallerWatch final : public job::Watch {
 public:
  explicit CallerWatch(const Caller& caller) : caller_(caller) {}
  void warned(const std::string& warning) override {
    if (caller_.warning) caller_.warning(warning);
  }
  void refining(std::int64_t /*triangles*/, double /*forecast*/) override {
    if (caller_.goes_on && !caller_.goes_on()) throw Cancelled("cancelled");
  }

 private:
  const Caller& caller_;
};

void require_length(std::size_t length, std::size_t wanted, const char* name, const char* of) {
  if (length != wanted)
    throw InputError({kInput},
                     "has " + std::to_string(length) + " " + name + " for " + std::to_string(wanted) + " " + of,
                     "give one for each, or none");
}

void require_length_or_none(std::size_t length, std::size_t wanted, const char* name, const char* of) {
  if (length > 0) require_length(length, wanted, name, of);
}

void check(const Tables& in, const Switches& switches) {
  const std::size_t points = in.points.size(), triangles = in.triangle_count();
  require_length(in.point_attributes.size(), points * in.attributes_per_point, "attributes", "points");
  require_length_or_none(in.point_markers.size(), points, "markers", "points");
  require_length_or_none(in.segment_markers.size(), in.segments.size(), "markers", "segments");
  if (switches.pslg)
    for (std::size_t s = 0; s < in.segments.size(); ++s)
      for (const std::int32_t v : in.segments[s])
        if (v < 0 || static_cast<std::size_t>(v) >= points)
          throw InputError({kInput}, "segment " + std::to_string(s) + " (from 0) has an end that is no point",
                           "correct it");
  if (!switches.refine) return;
  require_length(in.triangle_attributes.size(), triangles * in.attributes_per_triangle, "attributes", "triangles");
  if (switches.given_areas && in.triangle_areas.empty() && switches.max_area == 0)
    throw InputError({kInput}, "has no areas of triangles, which the switches r and a without a number ask for",
                     "give an area for each, or one for all after a");
  require_length_or_none(in.triangle_areas.size(), triangles, "areas", "triangles");
}

/// A mesh between its making and what is derived from it. Its markers are those of the input.
struct Made {
  Tables tables;
  std::vector<double> areas;  // the bound of each triangle that comes from a region or an older triangle; <= 0: none
};

// ---- To the job and back ----

Pslg domain_of(const Tables& in, const Switches& switches) {
  Pslg pslg;
  pslg.points = in.points;
  pslg.attributes = in.point_attributes;
  pslg.attributes_per_point = in.attributes_per_point;
  pslg.first_number = 0;
  if (!switches.pslg) return pslg;
  for (std::size_t s = 0; s < in.segments.size(); ++s)
    pslg.segments.push_back(
        {in.segments[s][0], in.segments[s][1], in.segment_markers.empty() ? 0 : in.segment_markers[s]});
  if (!switches.no_holes) pslg.holes = in.holes;
  pslg.regions = in.regions;
  for (std::size_t r = 0; r < pslg.regions.size(); ++r)  // the mesh tells regions by their number, from 1
    pslg.regions[r].attribute = static_cast<double>(r + 1);
  return pslg;
}

/// Rules that keep the triangulation as it is if no points are asked for.
InsertionRules rules_of(const Switches& switches) {
  InsertionRules rules = switches.rules;
  if (!switches.quality) rules.split = InsertionRules::Split::kNowhere;
  return rules;
}

job::Request request_of(const Switches& switches, const Caller& caller) {
  job::Request request;
  request.bounds.angle = switches.min_angle;
  request.bounds.area = switches.max_area;
  request.bounds.region_areas = switches.given_areas;
  request.input.hull = switches.hull && switches.pslg && !switches.refine;
  if (switches.unsuitable) request.sizing.expression = caller.size;
  if (caller.max_triangles > 0) request.limits.max_triangles = caller.max_triangles;
  if (rules_of(switches) != InsertionRules{}) request.decomposition.subdomains = 1;
  return request;
}

Mesh mesh_of(const Pslg& pslg, const SizeField* size, const Switches& switches, const Caller& caller) {
  job::Request request = request_of(switches, caller);
  if (size != nullptr) request.sizing.resolution = 1;  // what counts is at centroids
  const job::Given given{.input = &pslg, .size = size, .rules = rules_of(switches)};
  CallerWatch watch(caller);
  job::Here here(job::kOnePiece, job::threads_of(request));
  job::RunRecord record;
  const job::Asked asked{request, job::kLibrary, given, {.mesh = true, .whole = true}};
  const std::unique_ptr<job::Refined> made = job::make(asked, here, record, watch);
  if (given.rules.most_points == INT64_MAX)  // otherwise it ends early on purpose
    if (const KeyText why = made->shortfall(true); !why.empty()) throw Keyed<LimitError>(why);
  return made->take_piece(watch).mesh;
}

/// Finds points by their coordinates; the first of several.
class Places {
 public:
  void add(const Point& p, std::int32_t place) { places_.try_emplace(key(p), place); }
  [[nodiscard]] std::optional<std::int32_t> find(const Point& p) const {
    const auto found = places_.find(key(p));
    return found == places_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  using Key = std::pair<std::uint64_t, std::uint64_t>;
  struct Hash {
    std::size_t operator()(const Key& k) const { return mix(mix(k.first) ^ k.second); }
  };
  static Key key(const Point& p) {  // + 0: there are two zeros
    return {std::bit_cast<std::uint64_t>(p.x + 0), std::bit_cast<std::uint64_t>(p.y + 0)};
  }
  std::unordered_map<Key, std::int32_t, Hash> places_;
};

Places places_of(const Tables& in, bool refine) {
  Places places;
  if (refine)
    for (std::size_t t = 0; t < in.triangle_count(); ++t)
      for (std::int32_t i = 0; i < 3; ++i) {
        const std::int32_t v = in.triangles[t * in.corners + i];
        places.add(in.points[v], v);
      }
  for (std::size_t v = 0; v < in.points.size(); ++v) places.add(in.points[v], static_cast<std::int32_t>(v));
  return places;
}

/// The points of the input, then those that are new in the mesh. Returns the place of each point of the mesh.
std::vector<std::int32_t> take_points(const Tables& in, bool refine, const Mesh& mesh, Tables& out) {
  out.points = in.points;
  out.point_attributes = in.point_attributes;
  out.attributes_per_point = in.attributes_per_point;
  out.point_markers = in.point_markers;
  out.point_markers.resize(in.points.size(), 0);
  const Places places = places_of(in, refine);
  const std::ptrdiff_t width = in.attributes_per_point;
  std::vector<std::int32_t> place_of;
  place_of.reserve(mesh.points.size());
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const auto known = places.find(mesh.points[v]);
    place_of.push_back(known ? *known : static_cast<std::int32_t>(out.points.size()));
    if (known) continue;
    out.points.push_back(mesh.points[v]);
    out.point_markers.push_back(0);
    const auto values = mesh.attributes.begin() + static_cast<std::ptrdiff_t>(v) * width;
    out.point_attributes.insert(out.point_attributes.end(), values, values + width);
  }
  return place_of;
}

Made take_mesh(const Tables& in, bool refine, const Mesh& mesh) {
  Made made;
  Tables& out = made.tables;
  const std::vector<std::int32_t> place = take_points(in, refine, mesh, out);
  out.triangles.reserve(3 * mesh.triangles.size());
  for (const auto& corners : mesh.triangles)
    for (const std::int32_t v : corners) out.triangles.push_back(place[v]);
  for (const Mesh::Edge& edge : mesh.edges) {
    out.segments.push_back({place[edge.a], place[edge.b]});
    out.segment_markers.push_back(edge.marker);
  }
  out.holes = in.holes;
  out.regions = in.regions;
  return made;
}

Made make_new(const Tables& in, const Switches& switches, const Caller& caller) {
  const Mesh mesh = mesh_of(domain_of(in, switches), nullptr, switches, caller);
  Made made = take_mesh(in, false, mesh);
  const auto region_of = [&](std::size_t t) -> const Pslg::Region* {
    const double label = mesh.regions.empty() ? 0 : mesh.regions[t];
    return label > 0 ? &in.regions[static_cast<std::size_t>(label) - 1] : nullptr;
  };
  const bool attributes = switches.region_attributes && !in.regions.empty();
  made.tables.attributes_per_triangle = attributes ? 1 : 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Pslg::Region* const region = region_of(t);
    if (attributes) made.tables.triangle_attributes.push_back(region != nullptr ? region->attribute : 0);
    made.areas.push_back(region != nullptr && switches.given_areas ? region->max_area : 0);
  }
  return made;
}

std::array<Point, 3> points_at(const Tables& mesh, std::size_t t) {
  const auto at = [&](std::size_t i) { return mesh.points[mesh.triangles[t * mesh.corners + i]]; };
  return {at(0), at(1), at(2)};
}

/// The triangle of the old mesh in which one of the refined mesh lies.
std::int32_t origin_of(const OldMesh& old, const std::array<Point, 3>& corners) {
  const Point center = centroid(corners);
  const std::int32_t found = old.triangle_at(center);
  if (found >= 0) return found;
  for (const Point& corner : corners)  // rounding put the centroid of a sliver outside
    if (const std::int32_t near = old.triangle_at(corner); near >= 0) return near;
  return 0;
}

Made refine_old(const Tables& in, const Switches& switches, const Caller& caller) {
  const OldMesh old(in);
  std::vector<double> areas;
  if (switches.given_areas) areas = in.triangle_areas;
  const bool bounded = std::ranges::any_of(areas, [](double area) { return area > 0; });
  const AreaField field(old, areas);
  const Mesh mesh = mesh_of(old.domain(switches.pslg), bounded ? &field : nullptr, switches, caller);
  Made made = take_mesh(in, true, mesh);
  Tables& out = made.tables;
  const std::ptrdiff_t width = out.attributes_per_triangle = in.attributes_per_triangle;
  if (width == 0 && !bounded) return made;
  for (std::size_t t = 0; t < out.triangle_count(); ++t) {
    const std::int32_t origin = origin_of(old, points_at(out, t));
    const auto values = in.triangle_attributes.begin() + origin * width;
    out.triangle_attributes.insert(out.triangle_attributes.end(), values, values + width);
    if (bounded) made.areas.push_back(areas[origin]);
  }
  return made;
}

Made make_once(const Tables& in, const Switches& switches, const Caller& caller) {
  return switches.refine ? refine_old(in, switches, caller) : make_new(in, switches, caller);
}

// ---- Refining what the caller finds unsuitable ----

/// Bounds the area of each triangle that the caller finds unsuitable by what it is, so that it is split (see
/// AreaField). Whether there are any.
bool bound_unsuitable(const Caller& caller, Made& made) {
  const Tables& mesh = made.tables;
  made.areas.resize(mesh.triangle_count(), 0);
  bool any = false;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto [a, b, c] = points_at(mesh, t);
    const double area = signed_area(a, b, c);
    if (!caller.unsuitable(a, b, c, area)) continue;
    made.areas[t] = area;
    any = true;
  }
  return any;
}

/// In rounds, until the caller is content, or no more points can be added.
Made make(const Tables& in, const Switches& switches, const Caller& caller) {
  Made made = make_once(in, switches, caller);
  if (!switches.unsuitable || !caller.unsuitable) return made;
  Switches again = switches;
  again.refine = again.pslg = again.given_areas = true;
  while (bound_unsuitable(caller, made)) {
    Tables& mesh = made.tables;
    const std::size_t before = mesh.points.size();
    if (std::int64_t& most = again.rules.most_points; most != INT64_MAX)
      most = switches.rules.most_points - static_cast<std::int64_t>(before - in.points.size());
    if (again.rules.most_points <= 0) break;
    mesh.triangle_areas = std::move(made.areas);
    made = make_once(mesh, again, caller);
    if (made.tables.points.size() == before) break;
  }
  return made;
}

// ---- What is returned ----

void set_markers(Tables& mesh) {
  const auto give = [&](const std::vector<Pair>& edges, const std::vector<std::int32_t>& markers) {
    for (std::size_t e = 0; e < edges.size(); ++e)
      for (const std::int32_t v : edges[e])
        if (mesh.point_markers[v] == 0) mesh.point_markers[v] = markers[e];
  };
  give(mesh.segments, mesh.segment_markers);
  give(mesh.edges, mesh.edge_markers);
}

/// Segments on the boundary are marked like its edges.
void mark_boundary_segments(Tables& tables) {
  Mesh mesh;
  mesh.points = tables.points;
  for (std::size_t e = 0; e < tables.edges.size(); ++e)
    mesh.edges.push_back({tables.edges[e][0], tables.edges[e][1], tables.edge_markers[e]});
  const ConstrainedEdgeIndex edges(mesh);
  for (std::size_t s = 0; s < tables.segments.size(); ++s)
    if (const std::int32_t edge = edges.find(tables.segments[s][0], tables.segments[s][1]); edge >= 0)
      tables.segment_markers[s] = mesh.edges[edge].marker;
}

void verify_made(Tables tables) {
  jettison_points(tables);  // several of them may have one place
  Mesh mesh;
  mesh.points = tables.points;
  for (std::size_t t = 0; t < tables.triangle_count(); ++t)
    mesh.triangles.push_back({tables.triangles[3 * t], tables.triangles[3 * t + 1], tables.triangles[3 * t + 2]});
  for (std::size_t s = 0; s < tables.segments.size(); ++s)
    mesh.edges.push_back({tables.segments[s][0], tables.segments[s][1], tables.segment_markers[s]});
  const VerifyOptions asked;
  const VerifyReport report = verify(mesh, asked);
  if (!report.accepted())
    throw Error("switch C finds a flaw of the mesh, which is a bug of driftmesh: " + verdict_text(report, asked));
}

void leave_out(const Switches& switches, Tables& mesh) {
  if (!switches.neighbors) mesh.neighbors.clear();
  if (!switches.edges) mesh.edges.clear(), mesh.edge_markers.clear();
  const bool segments = switches.pslg || (switches.hull && !switches.refine);
  if (!segments || switches.no_segments) mesh.segments.clear(), mesh.segment_markers.clear();
  if (!switches.pslg) mesh.holes.clear(), mesh.regions.clear();
  if (switches.no_markers) mesh.point_markers.clear(), mesh.segment_markers.clear(), mesh.edge_markers.clear();
  if (switches.no_points) mesh.points.clear(), mesh.point_attributes.clear(), mesh.point_markers.clear();
  if (switches.no_triangles) mesh.triangles.clear(), mesh.triangle_attributes.clear();
}

/// What messages call a key.
std::string words_of_switches(const std::string& key) {
  if (key == "bounds.angle") return "switch q";
  if (key == "bounds.area") return "switch a";
  if (key.starts_with("sizing")) return "switch u";
  if (key == "limits.max-triangles") return "triangles";
  if (key == "limits.max-memory") return "memory";
  return key;
}

}  // namespace

Result triangulate(const Tables& input, const Switches& switches, const Caller& caller) {
  if (switches.unsuitable && !caller.unsuitable && caller.size.empty())
    throw Error(
        "switch u asks for a function that says which triangles are too large, and there is none; give one, or "
        "sizes, or remove it");
  check(input, switches);
  try {
    Result result;
    Tables& mesh = result.mesh = make(input, switches, caller).tables;
    if (switches.check) verify_made(mesh);
    if (switches.jettison) jettison_points(mesh);
    add_edges(mesh);
    set_markers(mesh);
    mark_boundary_segments(mesh);
    if (switches.voronoi) result.voronoi = voronoi_of(mesh);
    if (switches.second_order) add_midpoints(mesh);
    leave_out(switches, mesh);
    return result;
  } catch (const NamesKeys& error) {
    error.throw_in(words_of_switches);
    throw;  // not reached
  }
}

std::string statistics(const Tables& input, const Tables& mesh) {
  double least_area = std::numeric_limits<double>::infinity(), most_area = 0;
  double least_angle = std::numbers::pi, most_angle = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto [a, b, c] = points_at(mesh, t);
    const double area = signed_area(a, b, c);
    least_area = std::min(least_area, area);
    most_area = std::max(most_area, area);
    for (const double angle : {angle_at(b, a, c), angle_at(a, b, c), angle_at(a, c, b)}) {
      least_angle = std::min(least_angle, angle);
      most_angle = std::max(most_angle, angle);
    }
  }
  constexpr double kDegrees = 180 / std::numbers::pi;
  const auto line = [](const char* what, std::size_t count) { return what + std::to_string(count) + "\n"; };
  std::string text = line("Input vertices: ", input.points.size()) + line("Input segments: ", input.segments.size()) +
                     line("Input holes: ", input.holes.size()) + "\n" + line("Mesh vertices: ", mesh.points.size()) +
                     line("Mesh triangles: ", mesh.triangle_count()) + line("Mesh subsegments: ", mesh.segments.size());
  if (mesh.triangle_count() == 0) return text;
  char shapes[200];
  std::snprintf(shapes, sizeof shapes,
                "\nSmallest area: %.5g   Largest area: %.5g\nSmallest angle: %.5g   Largest angle: %.5g\n", least_area,
                most_area, least_angle * kDegrees, most_angle * kDegrees);
  return text + shapes;
}

}  // namespace driftmesh::triangle
