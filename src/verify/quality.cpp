#include "verify/quality.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <deque>
#include <limits>
#include <numbers>
#include <optional>

#include "base/in_parts.hpp"
#include "driftmesh/id_vector.hpp"
#include "verify/extended.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t kMostSuspects = 10'000;  // per piece: some megabyte
constexpr double kSlack = 1e-9;                // relative, for rounding
// Where products are so small against the area that is their difference, rounding changes it by less than 2e-15 of it.
constexpr double kSharp = 4;
constexpr long double kDegrees = 180 / std::numbers::pi_v<long double>;

/// One triangle in double precision: its area and the cotangents of its angles, which fall from 0 to 180 degrees.
struct Shape {
  double twice_area;
  double products;  ///< the sum of the magnitudes of those that its area is the difference of
  std::array<double, 3> cotangent;

  [[nodiscard]] Extremes extremes() const {
    const auto& [a, b, c] = cotangent;
    return {std::max(std::max(a, b), c), std::min(std::min(a, b), c), twice_area, twice_area};
  }
};

Shape shape_of(const Point& a, const Point& b, const Point& c) {
  const double abx = b.x - a.x, aby = b.y - a.y, bcx = c.x - b.x, bcy = c.y - b.y, cax = a.x - c.x, cay = a.y - c.y;
  const double l = abx * -cay, r = aby * -cax;
  const double twice_area = l - r;
  const double scale = -1 / twice_area;
  return {twice_area,
          std::fabs(l) + std::fabs(r),
          {(abx * cax + aby * cay) * scale, (abx * bcx + aby * bcy) * scale, (bcx * cax + bcy * cay) * scale}};
}

/// The largest triangle that plain bounds allow, wherever it is.
double largest_area(const PlainBounds& bounds) {
  return bounds.area > 0 ? bounds.area : std::numeric_limits<double>::infinity();
}

/// Bins of one degree by cotangent.
class DegreeBins {
 public:
  DegreeBins() {
    for (std::size_t d = 1; d < 180; ++d)
      limits_[d - 1] = d == 90 ? 0 : static_cast<double>(1 / std::tan(static_cast<long double>(d) / kDegrees));
    limits_.back() = std::numeric_limits<double>::quiet_NaN();
    std::size_t above = limits_.size() - 1;
    for (std::size_t cell = 0; cell < kCells; ++cell) {
      while (above > 0 && cell_of(limits_[above - 1]) <= cell) --above;
      above_[cell] = static_cast<std::uint8_t>(above);
    }
  }
  /// The whole degrees of the angle.
  [[nodiscard]] std::size_t bin(double cotangent) const {
    const std::size_t above = above_[cell_of(cotangent)];
    return above + (limits_[above] >= cotangent ? 1 : 0);
  }

 private:
  // Cells are told apart by the exponent and the six leading bits of the mantissa from 2^-7 to 2^6: cotangents of whole
  // degrees are farther apart, so that no cell holds two limits.
  static constexpr int kDropped = 46;  // bits
  static constexpr std::int64_t kLowest = std::bit_cast<std::int64_t>(0x1p-7) >> kDropped;
  static constexpr std::int64_t kHalf = (std::bit_cast<std::int64_t>(0x1p6) >> kDropped) - kLowest;
  static constexpr std::size_t kCells = 2 * kHalf;

  /// Rises with the cotangent; that of a triangle without area, which is not a number, counts as the largest.
  static std::size_t cell_of(double cotangent) {
    const std::int64_t leading = std::bit_cast<std::int64_t>(std::fabs(cotangent)) >> kDropped;
    const std::int64_t size = std::clamp<std::int64_t>(leading - kLowest, 0, kHalf - 1);
    return static_cast<std::size_t>(cotangent < 0 ? kHalf - 1 - size : kHalf + size);
  }

  std::array<double, 180> limits_{};          // falling; the last is none, so that nothing passes it
  std::array<std::uint8_t, kCells> above_{};  // for each cell the number of limits in higher ones
};

/// Measures the triangles of one mesh.
class Measurement {
 public:
  Measurement(const NamedMesh& mesh, const CheckedBounds& bounds)
      : names_(mesh),
        mesh_(mesh.mesh()),
        bounds_(bounds),
        take_([this](const Suspect& s) { measures_.add(s); }),
        area_everywhere_(largest_area(bounds.plain)) {
    max_ratio_ = largest_ratio(bounds.min_angle);
    if (bounds.min_angle > 0)
      sure_cotangent_ = static_cast<double>(1 / std::tan(static_cast<long double>(bounds.min_angle) / kDegrees));
  }

  Measurement(const Measurement&) = delete;
  Measurement& operator=(const Measurement&) = delete;

  /// Gives suspects away instead of keeping them.
  void give_to(const std::function<void(const Suspect&)>& take) { take_ = take; }

  /// Sums of areas are those of the same blocks whichever thread takes them.
  static constexpr std::size_t kBlock = 256;
  [[nodiscard]] static std::size_t blocks(const Mesh& mesh) { return (mesh.triangles.size() + kBlock - 1) / kBlock; }

  void take_block(std::size_t block) {
    const std::size_t begin = block * kBlock, end = std::min(begin + kBlock, mesh_.triangles.size());
    Extremes all;
    long double twice_area = 0;
    double products = 0;
    for (std::size_t t = begin; t < end; ++t) {
      const Shape shape = shape_of(t);
      for (std::size_t k = 0; k < 3; ++k) ++angles_[k][bins_.bin(shape.cotangent[k])];
      all.add(shape.extremes());
      twice_area += shape.twice_area;
      products += shape.products;
    }
    measures_.twice_area.add(products <= kSharp * std::fabs(twice_area) ? twice_area : exact_area(begin, end));
    if (!is_ordinary(all))
      for (std::size_t t = begin; t < end; ++t) look_at(t);
  }

  Measures finish() {
    Quality& quality = measures_.shapes;
    for (const auto& of_corner : angles_)
      for (std::size_t d = 0; d < of_corner.size(); ++d) quality.angles[d] += of_corner[d];
    // Triangles without area may have the one and not the other.
    if (quality.smallest_angle_triangle >= 0)
      quality.smallest_angle = angles_of(quality.smallest_angle_triangle).front();
    if (quality.largest_angle_triangle >= 0) quality.largest_angle = angles_of(quality.largest_angle_triangle).back();
    return std::move(measures_);
  }

 private:
  [[nodiscard]] std::array<Point, 3> corners(std::size_t t) const {
    const auto& [a, b, c] = mesh_.triangles[t];
    return {mesh_.points[a], mesh_.points[b], mesh_.points[c]};
  }

  /// Sorted, in degrees.
  [[nodiscard]] std::array<double, 3> angles_of(std::int32_t triangle) const {
    const auto [a, b, c] = corners(triangle);
    std::array<double, 3> angles{degrees_at(a, b, c), degrees_at(b, c, a), degrees_at(c, a, b)};
    std::sort(angles.begin(), angles.end());
    return angles;
  }

  [[nodiscard]] Shape shape_of(std::size_t t) const {
    const auto [a, b, c] = corners(t);
    return driftmesh::shape_of(a, b, c);
  }

  /// Whether there is nothing to find among triangles with these extremes: neither a new extreme nor a suspect.
  [[nodiscard]] bool is_ordinary(const Extremes& all) const {
    const Extremes& known = measures_.extremes;
    return all.smallest_twice_area > 0 && all.largest_cotangent <= std::min(known.largest_cotangent, sure_cotangent_) &&
           all.smallest_cotangent >= known.smallest_cotangent && all.smallest_twice_area >= known.smallest_twice_area &&
           all.largest_twice_area <= known.largest_twice_area && all.largest_twice_area <= 2 * area_everywhere_ &&
           !bounds_.region_area && bounds_.size == nullptr;
  }

  void look_at(std::size_t t) {
    const Shape shape = shape_of(t);
    const Extremes before = measures_.extremes;
    Extremes& now = measures_.extremes;
    now.add(shape.extremes());
    const auto number = static_cast<std::int32_t>(t);
    if (now.largest_cotangent > before.largest_cotangent) measures_.shapes.smallest_angle_triangle = number;
    if (now.smallest_cotangent < before.smallest_cotangent) measures_.shapes.largest_angle_triangle = number;
    if (now.largest_twice_area > before.largest_twice_area) measures_.shapes.largest_area_triangle = number;
    if (max_ratio_ > 0 && !(shape.twice_area > 0 && shape.extremes().largest_cotangent <= sure_cotangent_))
      check_small_angle(t);
    check_area(t, shape.twice_area);
  }

  [[nodiscard]] long double exact_area(std::size_t begin, std::size_t end) const {
    CompensatedSum twice_area;
    for (std::size_t t = begin; t < end; ++t) {
      const auto [a, b, c] = corners(t);
      twice_area.add(cross_extended(a, b, c));
    }
    return twice_area.value();
  }

  void check_area(std::size_t t, double twice_area) {
    const double bound = area_bound(t);
    if (twice_area > 2 * bound)
      check_large_area(t, bound);
    else if (bounds_.size != nullptr)
      check_size(t, twice_area / 2);
  }

  [[nodiscard]] double area_bound(std::size_t t) const {
    double bound = area_everywhere_;
    if (bounds_.region_area)
      if (const double own = bounds_.region_area(t); own > 0) bound = std::min(bound, own);
    if (bounds_.size != nullptr) bound = std::min(bound, area_of_edge(bounds_.size->at_corners(corners(t))));
    return bound;
  }

  // The area of the equilateral triangle.
  [[nodiscard]] static double area_of_edge(double h) { return std::numbers::sqrt3 / 4 * h * h; }

  void check_size(std::size_t t, double area) {
    if (const std::optional<SizeCheck::Miss> miss = bounds_.size->find_miss(corners(t), area))
      suspect(t, Suspect::Miss::kSize, miss->length, miss->at);
  }

  void check_large_area(std::size_t t, double bound) {
    const auto [a, b, c] = corners(t);
    if (cross_extended(a, b, c) / 2 > bound * (1 + static_cast<long double>(kSlack)))
      suspect(t, Suspect::Miss::kArea, bound, {});
  }

  void check_small_angle(std::size_t t) {
    const auto [a, b, c] = corners(t);
    const ShortestEdge edge = shortest_edge({a, b, c});
    if (!(edge.ratio <= max_ratio_ && edge.ratio > 0)) suspect(t, Suspect::Miss::kAngle, 0, {});
  }

  void suspect(std::size_t t, Suspect::Miss miss, double bound, const Point& at) {
    take_({names_.place(t), names_.numbers(t), corners(t), miss, bound, at});
  }

  NamedMesh names_;
  const Mesh& mesh_;
  const CheckedBounds& bounds_;
  std::function<void(const Suspect&)> take_;
  const DegreeBins bins_;
  std::array<std::array<std::uint64_t, 180>, 3> angles_{};  // by corner, so that counts seldom wait for each other
  Measures measures_;
  double area_everywhere_;
  long double max_ratio_ = 0;  // of circumradius to shortest edge; 0: any
  double sure_cotangent_ = std::numeric_limits<double>::infinity();
};

}  // namespace

void Measures::add(const Measures& later) {
  const Quality& other = later.shapes;
  twice_area.add(later.twice_area);
  for (std::size_t d = 0; d < shapes.angles.size(); ++d) shapes.angles[d] += other.angles[d];
  if (later.extremes.largest_cotangent > extremes.largest_cotangent) {
    shapes.smallest_angle = other.smallest_angle;
    shapes.smallest_angle_triangle = other.smallest_angle_triangle;
  }
  if (later.extremes.smallest_cotangent < extremes.smallest_cotangent) {
    shapes.largest_angle = other.largest_angle;
    shapes.largest_angle_triangle = other.largest_angle_triangle;
  }
  if (later.extremes.largest_twice_area > extremes.largest_twice_area)
    shapes.largest_area_triangle = other.largest_area_triangle;
  extremes.add(later.extremes);
  all_suspects = all_suspects && later.all_suspects;
  for (const Suspect& suspect : later.suspects) add(suspect);
  if (!all_suspects) suspects = {};
}

void Measures::add(const Suspect& suspect) {
  if (suspects.size() == kMostSuspects) all_suspects = false;
  if (all_suspects)
    suspects.push_back(suspect);
  else
    suspects = {};
}

Quality Measures::quality() const {
  Quality quality = shapes;
  const bool any = extremes.smallest_twice_area <= extremes.largest_twice_area;
  quality.total_area = twice_area.value() / 2;
  quality.smallest_area = any ? extremes.smallest_twice_area / 2 : 0;
  quality.largest_area = any ? extremes.largest_twice_area / 2 : 0;
  return quality;
}

Measures measure(const NamedMesh& mesh, const CheckedBounds& bounds, std::size_t threads) {
  std::vector<Measures> measures(threads);
  in_parts(Measurement::blocks(mesh.mesh()), threads, [&](std::size_t part, std::size_t begin, std::size_t end) {
    Measurement measurement(mesh, bounds);
    for (std::size_t block = begin; block < end; ++block) measurement.take_block(block);
    measures[part] = measurement.finish();
  });
  for (std::size_t part = 1; part < threads; ++part) measures[0].add(measures[part]);
  return std::move(measures[0]);
}

void find_suspects(const NamedMesh& mesh, const CheckedBounds& bounds,
                   const std::function<void(const Suspect&)>& take) {
  Measurement measurement(mesh, bounds);
  measurement.give_to(take);
  for (std::size_t block = 0; block < Measurement::blocks(mesh.mesh()); ++block) measurement.take_block(block);
}

double degrees_at(const Point& o, const Point& a, const Point& b) {
  return static_cast<double>(std::atan2(std::fabs(cross_extended(o, a, b)), dot_extended(o, a, b)) * kDegrees);
}

long double largest_ratio(double min_angle) {
  return min_angle > 0 ? (1 + kSlack) / (2 * std::sin(static_cast<long double>(min_angle) / kDegrees)) : 0;
}

// Circumradius / shortest edge = 1 / (2 sin of the smallest angle); R = abc / (4 area).
ShortestEdge shortest_edge(const std::array<Point, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  const std::array<long double, 3> opposite{std::sqrt(dot_extended(b, c, c)), std::sqrt(dot_extended(c, a, a)),
                                            std::sqrt(dot_extended(a, b, b))};
  const std::size_t apex = std::min_element(opposite.begin(), opposite.end()) - opposite.begin();
  const long double others = opposite[(apex + 1) % 3] * opposite[(apex + 2) % 3];
  return {apex, others / (2 * cross_extended(a, b, c))};
}

const char* reason_name(ExceptionReason reason) {
  switch (reason) {
    case ExceptionReason::kInputAngle:
      return "small angle of the input";
    case ExceptionReason::kSmallWedge:
      return "wedge between input segments";
    default:
      return "no room between coordinates";
  }
}

std::array<std::uint64_t, 18> Quality::angles_by_ten() const {
  std::array<std::uint64_t, 18> tens{};
  for (std::size_t d = 0; d < angles.size(); ++d) tens[d / 10] += angles[d];
  return tens;
}

void Quality::add_exceptions(const Quality& later, std::size_t max_listed) {
  for (const ExceptionReason reason : ids_of(exceptions)) {
    Exceptions& list = exceptions[reason];
    list.count += later.exceptions[reason].count;
    for (const std::string& message : later.exceptions[reason].messages)
      if (list.messages.size() < max_listed) list.messages.push_back(message);
  }
}

std::uint64_t Quality::exception_count() const {
  std::uint64_t sum = 0;
  for (const Exceptions& list : exceptions) sum += list.count;
  return sum;
}

}  // namespace driftmesh
