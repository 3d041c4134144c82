#include "sizing/background_function.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "base/formatted.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/id_vector.hpp"
#include "geometry/predicates.hpp"
#include "geometry/segment_geometry.hpp"

namespace driftmesh {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr double kOfRounding = 0x1p-44;  // relative
constexpr std::size_t kFewTriangles = 64;
constexpr std::size_t kFewestTriangles = 4;  // fewer are not worth another list
constexpr std::size_t kHowever = std::numeric_limits<std::size_t>::max();

void require_count(std::size_t values, const char* of_what, std::size_t expected) {
  if (values != expected)
    throw Error("background mesh: " + std::to_string(values) + " values for " + std::to_string(expected) + " " +
                of_what);
}

/// The cross product of ab and the vector from a to the center of a box, if that has the same sign in all of the box by
/// more than rounding; 0 otherwise.
double side_of(const Point& a, const Point& b, const Box& box) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double x = (box.low.x + box.high.x) / 2 - a.x, y = (box.low.y + box.high.y) / 2 - a.y;
  const double across = std::fabs(dx), along = std::fabs(dy);
  const double reach = (along * (box.high.x - box.low.x) + across * (box.high.y - box.low.y)) / 2;
  const double rounding =
      kOfRounding * (across * (std::fabs(y) + std::fabs(a.y)) + along * (std::fabs(x) + std::fabs(a.x)));
  const double cross = dx * y - dy * x;
  return std::fabs(cross) > reach * (1 + kOfRounding) + rounding ? cross : 0;
}

Interval rounded_out(double low, double high) {
  return {low * (1 - kOfRounding), high * (1 + kOfRounding)};
}

Box common(const Box& a, const Box& b) {
  return {{std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y)},
          {std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y)}};
}

}  // namespace

double edge_length_of_area(double area) {
  if (area <= 0) return kNoLimit;
  return std::sqrt(area * (4 / std::sqrt(3.0)));
}

std::vector<double> shortest_at_points(const BackgroundMesh& mesh, const std::vector<double>& lengths_of_triangles) {
  std::vector<double> shortest(mesh.points().size(), kNoLimit);
  for (std::size_t t = 0; t < lengths_of_triangles.size(); ++t)
    for (const std::int32_t corner : mesh.triangles()[t]) {
      double& at_corner = shortest[corner];
      at_corner = std::min(at_corner, lengths_of_triangles[t]);
    }
  return shortest;
}

// ---- Triangles and edges ----

std::array<double, 3> BackgroundFunction::All::at_corners(std::int32_t triangle) const {
  if (of_areas) return {lengths[triangle], lengths[triangle], lengths[triangle]};
  const auto& corners = mesh->triangles()[triangle];
  return {lengths[corners[0]], lengths[corners[1]], lengths[corners[2]]};
}

BackgroundFunction::Piece::Piece(const CornerPoints& triangle, const std::array<double, 3>& at_corners)
    : box(Box::of(triangle)),
      corners(triangle),
      lengths(at_corners),
      least(std::min({at_corners[0], at_corners[1], at_corners[2]})),
      most(std::max({at_corners[0], at_corners[1], at_corners[2]})),
      gradient{0, 0} {
  if (std::isinf(most) || least == most) return;
  const auto& [a, b, c] = corners;
  const double rise_b = lengths[1] - lengths[0], rise_c = lengths[2] - lengths[0];
  const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
  const double scale = 1 / (bx * cy - by * cx);
  gradient = {(rise_b * cy - rise_c * by) * scale, (rise_c * bx - rise_b * cx) * scale};
}

bool BackgroundFunction::Piece::touches(const Box& other) const {
  const auto& [a, b, c] = corners;
  return box.overlaps(other) && side_of(a, b, other) >= 0 && side_of(b, c, other) >= 0 && side_of(c, a, other) >= 0;
}

Interval BackgroundFunction::Piece::over(const Box& other) const {
  if (std::isinf(most)) {  // finite at corners and on the edge between them
    double least_here = kNoLimit;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t next = (i + 1) % 3;
      const Rim edge{0, corners[i], corners[next], lengths[i], lengths[next]};
      if (lengths[i] < kNoLimit && other.contains(corners[i])) least_here = std::min(least_here, lengths[i]);
      if (edge.at_a < kNoLimit && edge.at_b < kNoLimit && edge.touches(other))
        least_here = std::min(least_here, edge.over(other).low);
    }
    return {least_here, kNoLimit};
  }
  const Box inside = common(other, box);
  const double x = (inside.low.x + inside.high.x) / 2 - corners[0].x,
               y = (inside.low.y + inside.high.y) / 2 - corners[0].y;
  const double middle = lengths[0] + gradient.x * x + gradient.y * y;
  const double change = (std::fabs(gradient.x) * (inside.high.x - inside.low.x) +
                         std::fabs(gradient.y) * (inside.high.y - inside.low.y)) /
                        2;
  const double rounding = 0x1p-30 * most;  // slopes of slivers are rounded that much
  const double low = std::max(least, middle - change - rounding);
  const double high = std::min(most, middle + change + rounding);
  return low <= high ? rounded_out(low, high) : rounded_out(least, most);
}

/// Not less than that of its box, so that no rounding error makes the least depend on the order of a search.
double BackgroundFunction::Rim::squared_distance(const Point& p) const {
  return std::max(squared_distance_to_segment(p, a, b), Box::around(a, b).squared_distance(p));
}

bool BackgroundFunction::Rim::touches(const Box& box) const {
  return Box::around(a, b).overlaps(box) && side_of(a, b, box) == 0;
}

double BackgroundFunction::Rim::at(const Point& p) const {
  const double t = nearest_on_segment(p, a, b);
  if (t == 0 || at_a == at_b) return at_a;
  return t == 1 ? at_b : std::clamp((1 - t) * at_a + t * at_b, std::min(at_a, at_b), std::max(at_a, at_b));
}

/// At the points of the edge that are nearest to points of the box.
Interval BackgroundFunction::Rim::over(const Box& box) const {
  if (at_a == at_b) return {at_a, at_b};
  if (std::isinf(at_a) || std::isinf(at_b)) return {std::min(at_a, at_b), kNoLimit};
  const std::array<Point, 4> corners = NearestInSquare::corners_of(box);
  double from = 1, to = 0;
  for (const Point& p : corners) {
    const double t = nearest_on_segment(p, a, b);
    from = std::min(from, t);
    to = std::max(to, t);
  }
  const auto [low, high] = std::minmax({at_a + from * (at_b - at_a), at_a + to * (at_b - at_a)});
  return rounded_out(std::max(low, std::min(at_a, at_b)), std::min(high, std::max(at_a, at_b)));
}

// ---- The function ----

BackgroundFunction::BackgroundFunction(std::shared_ptr<const All> all, Part part)
    : all_(std::move(all)), part_(std::move(part)) {}

std::shared_ptr<const BackgroundFunction> BackgroundFunction::of_points(std::shared_ptr<const BackgroundMesh> mesh,
                                                                        std::vector<double> lengths) {
  require_count(lengths.size(), "points", mesh->points().size());
  for (std::size_t i = 0; i < lengths.size(); ++i)
    if (!(lengths[i] > 0))
      throw Error(formatted("background mesh: the edge length at point {} (counted from 0) is {}, not positive", i,
                            lengths[i]));
  const auto [least, most] = std::minmax_element(lengths.begin(), lengths.end());
  return std::shared_ptr<const BackgroundFunction>(new BackgroundFunction(
      std::make_shared<const All>(All{std::move(mesh), std::move(lengths), false, *least, *most}),
      Part{{}, {}, false}));
}

std::shared_ptr<const BackgroundFunction> BackgroundFunction::of_areas(std::shared_ptr<const BackgroundMesh> mesh,
                                                                       const std::vector<double>& area_bounds) {
  require_count(area_bounds.size(), "triangles", mesh->triangles().size());
  std::vector<double> lengths(area_bounds.size(), kNoLimit);
  for (std::size_t t = 0; t < lengths.size(); ++t) {
    if (std::isnan(area_bounds[t]))
      throw Error("background mesh: the area bound of triangle " + std::to_string(t) +
                  " (counted from 0) is not a number");
    if (mesh->has_area(static_cast<std::int32_t>(t))) lengths[t] = edge_length_of_area(area_bounds[t]);
  }
  const auto [least, most] = std::minmax_element(lengths.begin(), lengths.end());
  return std::shared_ptr<const BackgroundFunction>(new BackgroundFunction(
      std::make_shared<const All>(All{std::move(mesh), std::move(lengths), true, *least, *most}), Part{{}, {}, false}));
}

BackgroundFunction::Piece BackgroundFunction::piece(std::int32_t triangle) const {
  return {all_->mesh->corners(triangle), all_->at_corners(triangle)};
}

BackgroundFunction::Rim BackgroundFunction::rim(std::int32_t edge) const {
  const BackgroundMesh::Edge& e = all_->mesh->boundary()[edge];
  const CornerPoints corners = all_->mesh->corners(e.triangle);
  const std::array<double, 3> lengths = all_->at_corners(e.triangle);
  const std::size_t from = e.corner, to = (from + 1) % 3;
  return {edge, corners[from], corners[to], lengths[from], lengths[to]};
}

BackgroundFunction::Rim BackgroundFunction::nearest_rim(const Point& p) const {
  if (!part_.is_few || part_.rims.empty()) {
    const auto distance = [&](std::int32_t edge) { return rim(edge).squared_distance(p); };
    return rim(all_->mesh->boundary_tree().nearest(p, distance));
  }
  return *std::ranges::min_element(part_.rims, {}, [&](const Rim& r) { return r.squared_distance(p); });
}

double BackgroundFunction::at(const Point& p) const {
  const double none = all_->of_areas ? 0 : kNoLimit;
  double found = none;
  bool is_inside = false;
  const auto look = [&](const Piece& piece) {
    if (!piece.box.contains(p)) return;
    const auto& [a, b, c] = piece.corners;
    const std::array<double, 3> opposite{orient2d(b, c, p), orient2d(c, a, p), orient2d(a, b, p)};
    const double total = opposite[0] + opposite[1] + opposite[2];
    // The signs are exact. All of them are 0 on the line of a triangle without area.
    if (!(opposite[0] >= 0 && opposite[1] >= 0 && opposite[2] >= 0 && total > 0)) return;
    is_inside = true;
    double length = 0, least = kNoLimit, most = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if (opposite[i] == 0) continue;  // not 0 * infinity
      length += opposite[i] / total * piece.lengths[i];
      least = std::min(least, piece.lengths[i]);
      most = std::max(most, piece.lengths[i]);
    }
    length = std::clamp(length, least, most);
    found = all_->of_areas ? std::max(found, length) : std::min(found, length);
  };
  if (part_.is_few)
    for (const Piece& piece : part_.pieces) look(piece);
  else
    all_->mesh->triangle_tree().visit_containing(p, [&](std::int32_t t) { look(piece(t)); });
  return is_inside ? found : nearest_rim(p).at(p);
}

void BackgroundFunction::visit_marks(const std::function<void(const Point&)>& visit) const {
  if (!all_->of_areas)
    for (const Point& p : mesh()->points()) visit(p);
  else
    for (std::size_t t = 0; t < all_->lengths.size(); ++t)
      visit(centroid(mesh()->corners(static_cast<std::int32_t>(t))));
}

// ---- In boxes ----

/// Not few if there are more than `most`.
BackgroundFunction::Part BackgroundFunction::part_in(const Box& box, std::size_t most) const {
  Part found{{}, {}, false};
  const auto take = [&](const Piece& piece) {
    if (piece.touches(box)) found.pieces.push_back(piece);
  };
  const BackgroundMesh& mesh = *all_->mesh;
  if (part_.is_few) {
    for (const Piece& piece : part_.pieces) take(piece);
  } else {
    std::vector<std::int32_t> candidates;
    mesh.triangle_tree().search([&](const Box& around) { return candidates.size() <= most && around.overlaps(box); },
                                [&](std::int32_t t) { candidates.push_back(t); });
    if (candidates.size() > most) return found;
    for (const std::int32_t t : candidates)
      if (mesh.has_area(t)) take(piece(t));
  }
  bool has_outside = found.pieces.empty();
  if (!has_outside && part_.is_few)
    has_outside = std::ranges::any_of(part_.rims, [&](const Rim& r) { return r.touches(box); });
  else if (!has_outside)
    mesh.boundary_tree().search([&](const Box& around) { return !has_outside && around.overlaps(box); },
                                [&](std::int32_t e) { has_outside = has_outside || rim(e).touches(box); });
  if (has_outside) found.rims = rims_near(box, most);
  found.is_few = found.rims.size() <= most;
  return found;
}

/// Those that may be nearest to a point of the box, by number; more than `most` need not be all.
std::vector<BackgroundFunction::Rim> BackgroundFunction::rims_near(const Box& box, std::size_t most) const {
  std::vector<Rim> found;
  const Rim rival = nearest_rim(box.center());
  const auto square = NearestInSquare::against(
      box, [&](const Point& p) { return std::sqrt(rival.squared_distance(p)); },
      margin_in(box) + margin_in(Box::around(rival.a, rival.b)));
  const auto take = [&](const Rim& r) {
    const Point nearest = nearest_point_on_segment(square.center(), r.a, r.b);
    if (found.size() <= most && square.needs(nearest, r.a, r.b)) found.push_back(r);
  };
  if (part_.is_few && !part_.rims.empty())
    for (const Rim& r : part_.rims) take(r);
  else
    all_->mesh->boundary_tree().search(
        [&](const Box& around) { return found.size() <= most && square.needs(0, around); },
        [&](std::int32_t e) { take(rim(e)); });
  std::ranges::sort(found, {}, &Rim::number);
  return found;
}

std::shared_ptr<const PlaneFunction> BackgroundFunction::within(const Box& box) const {
  if (part_.is_few && part_.pieces.size() <= kFewestTriangles && part_.rims.size() <= kFewestTriangles) return nullptr;
  Part part = part_in(box, kFewTriangles);
  if (!part.is_few) return nullptr;
  return std::shared_ptr<const PlaneFunction>(new BackgroundFunction(all_, std::move(part)));
}

/// Where too many triangles are known, they are looked at only if the box is so small, compared with the lengths, that
/// the answer matters.
Variation BackgroundFunction::over(const Box& box) const {
  const double width = box.high.x - box.low.x, height = box.high.y - box.low.y;
  if (all_->least == all_->most) return {rounded_out(all_->least, all_->most), {0, 0}, {0, 0}, {0, 0}};
  if (part_.is_few) return over_few(box);
  const bool is_small = width >= 0 && height >= 0 && std::max(width, height) <= 2 * all_->least;
  if (is_small) return BackgroundFunction(all_, part_in(box, kHowever)).over_few(box);
  return {rounded_out(all_->least, all_->most), intervals::kAll, intervals::kAll, intervals::kAll};
}

/// From the triangles and edges that are known.
Variation BackgroundFunction::over_few(const Box& box) const {
  Interval value{kNoLimit, -kNoLimit}, in_x{kNoLimit, -kNoLimit}, in_y{kNoLimit, -kNoLimit};
  std::size_t touching = 0;
  for (const Piece& piece : part_.pieces) {
    if (!piece.touches(box)) continue;
    ++touching;
    value = intervals::hull(value, piece.over(box));
    in_x = intervals::hull(in_x, {piece.gradient.x, piece.gradient.x});
    in_y = intervals::hull(in_y, {piece.gradient.y, piece.gradient.y});
  }
  const bool has_outside =
      touching == 0 || std::ranges::any_of(part_.rims, [&](const Rim& rim) { return rim.touches(box); });
  if (has_outside)
    for (const Rim& rim : rims_near(box, kHowever)) value = intervals::hull(value, rim.over(box));
  if (value.low == value.high) return {value, {0, 0}, {0, 0}, {0, 0}};
  const bool is_continuous = !has_outside && value.high < kNoLimit && (!all_->of_areas || touching == 1);
  if (!is_continuous) return {value, intervals::kAll, intervals::kAll, intervals::kAll};
  const auto most = [](const Interval& a) { return std::max(std::fabs(a.low), std::fabs(a.high)); };
  const double steepest = std::hypot(most(in_x), most(in_y)), slack = 0x1p-30 * steepest;
  const auto wider = [slack](const Interval& a) { return Interval{a.low - slack, a.high + slack}; };
  return {value, wider(in_x), wider(in_y), {-steepest - slack, steepest + slack}};
}

}  // namespace driftmesh
