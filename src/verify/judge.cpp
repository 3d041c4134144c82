#include "verify/judge.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/formatted.hpp"
#include "driftmesh/id_vector.hpp"
#include "verify/extended.hpp"
#include "verify/words.hpp"

namespace driftmesh {
namespace {

constexpr double kSameDistance = 1e-3;  // relative: two vertices count as equally far from their apex
// In a wedge narrower than this, in degrees, distances count as equal up to a fraction of the wedge's width: where
// segments hardly diverge and end almost side by side, no points are needed to separate their ends.
constexpr double kNarrowWedge = 1;
constexpr double kShareOfWidth = 0.3;

std::string area_words(const Suspect& suspect) {
  const auto& [a, b, c] = suspect.corners;
  const auto area = static_cast<double>(cross_extended(a, b, c) / 2);
  const std::string triangle = triangle_words(suspect.place, suspect.numbers);
  if (suspect.miss == Suspect::Miss::kArea)
    return triangle + formatted(" has area {:.9g}, at most {:.9g} is allowed", area, suspect.bound);
  return triangle + formatted(" has area {:.9g}, but an edge of {:.9g} is asked for at {}", area, suspect.bound,
                              place_words(suspect.at));
}

std::string angle_words(const Suspect& suspect, const ShortestEdge& edge, double min_angle) {
  const auto& p = suspect.corners;
  const std::size_t k = edge.apex;
  const double angle =
      std::min({degrees_at(p[0], p[1], p[2]), degrees_at(p[1], p[2], p[0]), degrees_at(p[2], p[0], p[1])});
  return triangle_words(suspect.place, suspect.numbers) +
         formatted(" has an angle of {:.6f} degrees at {}, circumradius / shortest edge {:.6f} (at most {:.6f})", angle,
                   point_words(suspect.numbers[k], p[k]), static_cast<double>(edge.ratio),
                   static_cast<double>(largest_ratio(min_angle)));
}

}  // namespace

void Judge::judge(const Suspect& suspect, Quality& quality, Findings& findings) {
  if (suspect.miss == Suspect::Miss::kAngle) return judge_angle(suspect, quality, findings);
  if (step_ != nullptr && step_->spares(suspect.corners)) return;
  const auto describe = [&] { return area_words(suspect); };
  if (room().none_for_area(suspect.corners))
    except(ExceptionReason::kNoRoom, quality, describe);
  else
    findings.add(Flaw::kLargeArea, describe);
}

void Judge::judge_angle(const Suspect& suspect, Quality& quality, Findings& findings) {
  const ShortestEdge edge = shortest_edge(suspect.corners);
  const auto corner = [&](std::size_t k) { return vertex_of(suspect.numbers[(edge.apex + k) % 3]); };
  const std::int32_t v = corner(0), p = corner(1), q = corner(2);
  const auto describe = [&] { return angle_words(suspect, edge, min_angle_); };
  if (is_subsegment(v, p) && is_subsegment(v, q))
    except(ExceptionReason::kInputAngle, quality, describe);
  else if (is_seditious(p, q))
    except(ExceptionReason::kSmallWedge, quality, describe);
  else if (room().none_for_angle(suspect.corners, min_angle_))
    except(ExceptionReason::kNoRoom, quality, describe);
  else
    findings.add(Flaw::kSmallAngle, describe);
}

std::int32_t Judge::vertex_of(std::int64_t number) const {
  const auto found = std::ranges::lower_bound(mesh_.numbers, number);
  const bool known = found != mesh_.numbers.end() && *found == number;
  return known ? static_cast<std::int32_t>(found - mesh_.numbers.begin()) : kNone;
}

bool Judge::is_subsegment(std::int32_t u, std::int32_t v) const {
  return u != kNone && v != kNone && chains_.subsegments().find(u, v) != kNone;
}

// Whether p and q lie inside two chains that meet at less than 60 degrees, equally far from their common end.
bool Judge::is_seditious(std::int32_t p, std::int32_t q) const {
  if (p == kNone || q == kNone) return false;
  const std::int32_t cp = chains_.through(p), cq = chains_.through(q);
  if (cp == kNone || cq == kNone || cp == cq) return false;
  const auto &first = chains_.all()[cp].vertices, &second = chains_.all()[cq].vertices;
  for (const std::int32_t apex : {first.front(), first.back()}) {
    if (apex != second.front() && apex != second.back()) continue;
    const Point &o = mesh_.points[apex], &at_p = mesh_.points[p], &at_q = mesh_.points[q];
    const long double op = std::sqrt(dot_extended(o, at_p, at_p)), oq = std::sqrt(dot_extended(o, at_q, at_q));
    const long double rounding =
        64 * 0x1p-52L * std::max({std::fabs(o.x), std::fabs(o.y), std::fabs(at_p.x), std::fabs(at_p.y)});
    const double angle = degrees_at(o, at_p, at_q);
    const long double same =
        angle < kNarrowWedge ? kShareOfWidth * std::sqrt(dot_extended(at_p, at_q, at_q)) : kSameDistance * op;
    if (angle < 60 && std::fabs(op - oq) <= same + rounding) return true;
  }
  return false;
}

/// Made on demand: most meshes never need it.
const Room& Judge::room() {
  if (!room_) room_.emplace(mesh_, chains_);
  return *room_;
}

template <class Describe>
void Judge::except(ExceptionReason reason, Quality& quality, const Describe& describe) const {
  Quality::Exceptions& list = quality.exceptions[reason];
  if (list.count++ < max_listed_) list.messages.push_back(describe());
}

}  // namespace driftmesh
