#include "verify/quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "base/in_parts.hpp"
#include "driftmesh/id_vector.hpp"
#include "verify/extended.hpp"
#include "verify/room.hpp"
#include "verify/size_check.hpp"
#include "verify/words.hpp"

namespace driftmesh {
namespace {

constexpr double kSlack = 1e-9;         // relative, for rounding
constexpr double kSameDistance = 1e-3;  // relative: two vertices count as equally far from their apex
// In a wedge narrower than this, in degrees, distances count as equal up to a fraction of the wedge's width: where
// segments hardly diverge and end almost side by side, no points are needed to separate their ends.
constexpr double kNarrowWedge = 1;
constexpr double kShareOfWidth = 0.3;
constexpr long double kDegrees = 180 / std::numbers::pi_v<long double>;

/// One triangle in double precision: its area and the cotangents of its angles, which fall from 0 to 180 degrees.
struct Shape {
  double twice_area;
  std::array<double, 3> cotangent;
};

Shape shape_of(const Point& a, const Point& b, const Point& c) {
  const double abx = b.x - a.x, aby = b.y - a.y, bcx = c.x - b.x, bcy = c.y - b.y, cax = a.x - c.x, cay = a.y - c.y;
  const double twice_area = abx * -cay - aby * -cax;
  const double scale = -1 / twice_area;
  return {twice_area,
          {(abx * cax + aby * cay) * scale, (abx * bcx + aby * bcy) * scale, (bcx * cax + bcy * cay) * scale}};
}

/// The angle at o between oa and ob in degrees, in extended precision.
double angle_at(const Point& o, const Point& a, const Point& b) {
  return static_cast<double>(std::atan2(std::fabs(cross_extended(o, a, b)), dot_extended(o, a, b)) * kDegrees);
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
  static constexpr std::size_t kCells = 1024;  // so many that none holds two limits

  /// Rises with the cotangent; that of a triangle without area, which is not a number, counts as the largest.
  static std::size_t cell_of(double cotangent) {
    const double bounded = cotangent < 1e6 ? std::max(cotangent, -1e6) : 1e6;
    return static_cast<std::size_t>((1 + bounded / (1 + std::fabs(bounded))) * (kCells / 2.0));
  }

  std::array<double, 180> limits_{};          // falling; the last is none, so that nothing passes it
  std::array<std::uint8_t, kCells> above_{};  // for each cell the number of limits in higher ones
};

class QualityCheck {
 public:
  QualityCheck(const Mesh& mesh, const Chains& chains, const CheckedBounds& bounds, std::size_t max_listed)
      : mesh_(mesh), chains_(chains), bounds_(bounds), findings_(max_listed) {
    if (bounds.size != nullptr) size_.emplace(mesh, *bounds.size, bounds.size_spacing);
    const long double theta = static_cast<long double>(bounds.min_angle) / kDegrees;
    max_ratio_ = bounds.min_angle > 0 ? (1 + kSlack) / (2 * std::sin(theta)) : 0;
    sure_cotangent_ =
        bounds.min_angle > 0 ? static_cast<double>(1 / std::tan(theta)) : std::numeric_limits<double>::infinity();
  }

  void take(std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) take(t);
  }

  /// Adds what was taken of later triangles.
  void append(const QualityCheck& later) {
    const Quality& other = later.quality_;
    area_sum_.add(later.area_sum_);
    for (std::size_t d = 0; d < quality_.angles.size(); ++d) quality_.angles[d] += other.angles[d];
    if (later.largest_cotangent_ > largest_cotangent_) {
      largest_cotangent_ = later.largest_cotangent_;
      quality_.smallest_angle_triangle = other.smallest_angle_triangle;
    }
    if (later.smallest_cotangent_ < smallest_cotangent_) {
      smallest_cotangent_ = later.smallest_cotangent_;
      quality_.largest_angle_triangle = other.largest_angle_triangle;
    }
    smallest_twice_area_ = std::min(smallest_twice_area_, later.smallest_twice_area_);
    if (later.largest_twice_area_ > largest_twice_area_) {
      largest_twice_area_ = later.largest_twice_area_;
      quality_.largest_area_triangle = other.largest_area_triangle;
    }
    for (std::size_t k = 0; k < kExceptionReasonCount; ++k) {
      Quality::Exceptions& list = quality_.exceptions[static_cast<ExceptionReason>(k)];
      const Quality::Exceptions& more = other.exceptions[static_cast<ExceptionReason>(k)];
      list.count += more.count;
      for (const std::string& message : more.messages)
        if (list.messages.size() < bounds_.max_listed) list.messages.push_back(message);
    }
    findings_.append(later.findings_);
  }

  [[nodiscard]] const Findings& findings() const { return findings_; }

  Quality finish() {
    quality_.total_area = area_sum_.value() / 2;
    quality_.smallest_area = mesh_.triangles.empty() ? 0 : smallest_twice_area_ / 2;
    quality_.largest_area = mesh_.triangles.empty() ? 0 : largest_twice_area_ / 2;
    if (quality_.smallest_angle_triangle >= 0) {
      quality_.smallest_angle = angles_of(quality_.smallest_angle_triangle).front();
      quality_.largest_angle = angles_of(quality_.largest_angle_triangle).back();
    }
    return std::move(quality_);
  }

 private:
  [[nodiscard]] const Point& corner(std::size_t t, std::size_t k) const { return mesh_.points[mesh_.triangles[t][k]]; }

  /// Sorted, in degrees.
  [[nodiscard]] std::array<double, 3> angles_of(std::int32_t triangle) const {
    const Point &a = corner(triangle, 0), &b = corner(triangle, 1), &c = corner(triangle, 2);
    std::array<double, 3> angles{angle_at(a, b, c), angle_at(b, c, a), angle_at(c, a, b)};
    std::sort(angles.begin(), angles.end());
    return angles;
  }

  void take(std::size_t t) {
    const Point &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
    area_sum_.add(cross_extended(a, b, c));
    const Shape shape = shape_of(a, b, c);
    take_angles(t, shape);
    take_area(t, shape.twice_area);
  }

  void take_angles(std::size_t t, const Shape& shape) {
    for (const double cotangent : shape.cotangent) ++quality_.angles[bins_.bin(cotangent)];
    const auto [least, most] = std::minmax({shape.cotangent[0], shape.cotangent[1], shape.cotangent[2]});
    if (most > largest_cotangent_) {
      largest_cotangent_ = most;
      quality_.smallest_angle_triangle = static_cast<std::int32_t>(t);
    }
    if (least < smallest_cotangent_) {
      smallest_cotangent_ = least;
      quality_.largest_angle_triangle = static_cast<std::int32_t>(t);
    }
    if (!(most <= sure_cotangent_)) check_small_angle(t);
  }

  void take_area(std::size_t t, double twice_area) {
    smallest_twice_area_ = std::min(smallest_twice_area_, twice_area);
    if (twice_area > largest_twice_area_) {
      largest_twice_area_ = twice_area;
      quality_.largest_area_triangle = static_cast<std::int32_t>(t);
    }
    const double bound = area_bound(t);
    if (twice_area > 2 * bound)
      check_large_area(t, bound);
    else if (size_)
      check_size(t, twice_area / 2);
  }

  [[nodiscard]] double area_bound(std::size_t t) const {
    double bound = bounds_.max_area > 0 ? bounds_.max_area : std::numeric_limits<double>::infinity();
    if (bounds_.region_area)
      if (const double own = bounds_.region_area(t); own > 0) bound = std::min(bound, own);
    if (size_) bound = std::min(bound, area_of_edge(size_->at_corners(t)));
    return bound;
  }

  // Of the equilateral triangle.
  [[nodiscard]] static double area_of_edge(double h) { return std::numbers::sqrt3 / 4 * h * h; }

  void check_size(std::size_t t, double area) {
    const std::optional<SizeCheck::Miss> miss = size_->find_miss(t, area);
    if (!miss) return;
    miss_bound(t, [&, this] {
      return triangle_words(mesh_, t) + fmt::format(" has area {:.9g}, but an edge of {:.9g} is asked for at {}", area,
                                                    miss->length, place_words(miss->at));
    });
  }

  template <class Describe>
  void miss_bound(std::size_t t, const Describe& describe) {
    if (room().none_for_area(t))
      except(ExceptionReason::no_room, describe);
    else
      findings_.add(Flaw::large_area, describe);
  }

  void check_large_area(std::size_t t, double bound) {
    const long double area = cross_extended(corner(t, 0), corner(t, 1), corner(t, 2)) / 2;
    if (area <= bound * (1 + static_cast<long double>(kSlack))) return;
    miss_bound(t, [&, this] {
      return triangle_words(mesh_, t) +
             fmt::format(" has area {:.9g}, at most {:.9g} is allowed", static_cast<double>(area), bound);
    });
  }

  // Circumradius / shortest edge = 1 / (2 sin of the smallest angle); R = abc / (4 area).
  void check_small_angle(std::size_t t) {
    const Point &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
    const std::array<long double, 3> opposite{std::sqrt(dot_extended(b, c, c)), std::sqrt(dot_extended(c, a, a)),
                                              std::sqrt(dot_extended(a, b, b))};
    const std::size_t apex = std::min_element(opposite.begin(), opposite.end()) - opposite.begin();
    const long double others = opposite[(apex + 1) % 3] * opposite[(apex + 2) % 3];
    const long double ratio = others / (2 * cross_extended(a, b, c));
    if (ratio <= max_ratio_ && ratio > 0) return;

    const double angle = angles_of(static_cast<std::int32_t>(t)).front();
    const std::int32_t v = mesh_.triangles[t][apex], p = mesh_.triangles[t][(apex + 1) % 3],
                       q = mesh_.triangles[t][(apex + 2) % 3];
    const auto describe = [&] {
      return triangle_words(mesh_, t) + fmt::format(
                                            " has an angle of {:.6f} degrees at {}, circumradius / shortest edge "
                                            "{:.6f} (at most {:.6f})",
                                            angle, point_words(mesh_, v), static_cast<double>(ratio),
                                            static_cast<double>(max_ratio_));
    };
    if (is_subsegment(v, p) && is_subsegment(v, q))
      except(ExceptionReason::input_angle, describe);
    else if (is_seditious(p, q))
      except(ExceptionReason::small_wedge, describe);
    else if (room().none_for_angle(t, bounds_.min_angle))
      except(ExceptionReason::no_room, describe);
    else
      findings_.add(Flaw::small_angle, describe);
  }

  [[nodiscard]] bool is_subsegment(std::int32_t u, std::int32_t v) const {
    return chains_.subsegments().find(u, v) != kNone;
  }

  // Whether p and q lie inside two chains that meet at less than 60 degrees, equally far from their common end.
  [[nodiscard]] bool is_seditious(std::int32_t p, std::int32_t q) const {
    const std::int32_t cp = chains_.through(p), cq = chains_.through(q);
    if (cp == kNone || cq == kNone || cp == cq) return false;
    const auto &first = chains_.all()[cp].vertices, &second = chains_.all()[cq].vertices;
    for (const std::int32_t apex : {first.front(), first.back()}) {
      if (apex != second.front() && apex != second.back()) continue;
      const Point &o = mesh_.points[apex], &at_p = mesh_.points[p], &at_q = mesh_.points[q];
      const long double op = std::sqrt(dot_extended(o, at_p, at_p)), oq = std::sqrt(dot_extended(o, at_q, at_q));
      const long double rounding =
          64 * 0x1p-52L * std::max({std::fabs(o.x), std::fabs(o.y), std::fabs(at_p.x), std::fabs(at_p.y)});
      const double angle = angle_at(o, at_p, at_q);
      const long double same =
          angle < kNarrowWedge ? kShareOfWidth * std::sqrt(dot_extended(at_p, at_q, at_q)) : kSameDistance * op;
      if (angle < 60 && std::fabs(op - oq) <= same + rounding) return true;
    }
    return false;
  }

  /// Made on demand: most meshes never need it.
  const Room& room() {
    if (!room_) room_.emplace(mesh_, chains_);
    return *room_;
  }

  template <class Describe>
  void except(ExceptionReason reason, const Describe& describe) {
    Quality::Exceptions& list = quality_.exceptions[reason];
    if (list.count++ < bounds_.max_listed) list.messages.push_back(describe());
  }

  const Mesh& mesh_;
  const Chains& chains_;
  const CheckedBounds& bounds_;
  Findings findings_;
  std::optional<SizeCheck> size_;
  std::optional<Room> room_;
  const DegreeBins bins_;
  Quality quality_;
  CompensatedSum area_sum_;
  long double max_ratio_ = 0;
  double sure_cotangent_ = 0;
  double largest_cotangent_ = -std::numeric_limits<double>::infinity();
  double smallest_cotangent_ = std::numeric_limits<double>::infinity();
  double smallest_twice_area_ = std::numeric_limits<double>::infinity();
  double largest_twice_area_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

const char* reason_name(ExceptionReason reason) {
  switch (reason) {
    case ExceptionReason::input_angle:
      return "small angle of the input";
    case ExceptionReason::small_wedge:
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

std::uint64_t Quality::exception_count() const {
  std::uint64_t sum = 0;
  for (const Exceptions& list : exceptions) sum += list.count;
  return sum;
}

Quality check_quality(const Mesh& mesh, const Chains& chains, const CheckedBounds& bounds, Findings& findings) {
  // Neither size fields nor the search for a region are for several threads.
  const bool alone = bounds.size != nullptr || bounds.region_area;
  const std::size_t threads = alone ? 1 : std::max<std::size_t>(bounds.threads, 1);
  std::deque<QualityCheck> checks;
  for (std::size_t part = 0; part < threads; ++part)
    checks.emplace_back(mesh, chains, bounds, findings.listed_per_kind());
  in_parts(mesh.triangles.size(), threads,
           [&](std::size_t part, std::size_t begin, std::size_t end) { checks[part].take(begin, end); });
  for (std::size_t part = 1; part < threads; ++part) checks[0].append(checks[part]);
  findings.append(checks[0].findings());
  return checks[0].finish();
}

}  // namespace driftmesh
