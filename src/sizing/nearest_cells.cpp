#include "sizing/nearest_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "geometry/segment_geometry.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t kFew = 6;    // segments of a square that is not divided
constexpr std::size_t kMany = 48;  // a square keeps no more
/// Questions before a square is improved, which takes about as long as they did: where the tree answers, and where
/// there are segments to look at.
constexpr std::uint32_t kOftenInTree = 8, kOften = 4;
constexpr int kDeepest = 24;
constexpr std::size_t kSquaresPerSegment = 6, kMoreSquares = 10'000;
/// Relative to coordinates. What rounding does to distances and to the place of a point is a tenth of it.
constexpr double kMargin = 0x1p-43;
/// Squares of smaller and larger coordinates underflow and overflow.
constexpr double kSmallest = 0x1p-300, kLargest = 0x1p300;

std::vector<Box> boxes_of(const std::vector<NearestCells::Ends>& segments) {
  std::vector<Box> boxes(segments.size());
  std::ranges::transform(segments, boxes.begin(), [](const auto& s) { return Box::around(s.a, s.b); });
  return boxes;
}

/// A number and so many items, in one piece of memory.
std::unique_ptr<const std::int32_t[]> packed(const std::vector<std::int32_t>& items) {
  auto all = std::make_unique<std::int32_t[]>(items.size() + 1);
  all[0] = static_cast<std::int32_t>(items.size());
  std::ranges::copy(items, &all[1]);
  return all;
}

template <class Value, class Owner>
void publish(std::atomic<Value*>& place, Owner made) {
  Value* expected = nullptr;  // another thread may have made the same meanwhile
  if (place.compare_exchange_strong(expected, made.get(), std::memory_order_acq_rel)) static_cast<void>(made.release());
}

}  // namespace

/// Without items and quarters the tree answers. Items stay when there are quarters: others may be reading them.
struct NearestCells::Node {
  std::atomic<std::uint32_t> asked{0};
  std::atomic<const std::int32_t*> near{nullptr};  // packed, not empty
  std::atomic<Quarters*> quarters{nullptr};

  Node() = default;
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;
  ~Node();

  [[nodiscard]] Items items() const {
    const std::int32_t* packed = near.load(std::memory_order_acquire);
    return packed == nullptr ? Items{} : Items{packed + 1, static_cast<std::size_t>(*packed)};
  }
};

struct NearestCells::Quarters {
  std::array<Node, 4> nodes;
};

NearestCells::Node::~Node() {
  delete[] near.load();
  delete quarters.load();
}

/// A square and a rival, a segment near it. What is farther than the rival at all points of the square is not needed.
class NearestCells::Square {
 public:
  Square(const Point& center, double half, const Ends& rival, double margin) : center_(center), half_(half) {
    for (std::size_t k = 0; k < 4; ++k) {
      const Point corner{center.x + (k % 2 == 0 ? -half : half), center.y + (k < 2 ? -half : half)};
      rival_[k] = std::sqrt(NearestCells::squared_distance(corner, rival)) + margin;
    }
  }

  [[nodiscard]] bool needs(const Ends& s) const {
    const double t = s.a == s.b ? 1 : nearest_on_segment(center_, s.a, s.b);
    return needs({s.a.x + t * (s.b.x - s.a.x), s.a.y + t * (s.b.y - s.a.y)},
                 [&](const Point& direction) { return std::min(along(direction, s.a), along(direction, s.b)); });
  }

  [[nodiscard]] bool needs(const Box& box) const {
    const Point nearest{std::clamp(center_.x, box.low.x, box.high.x), std::clamp(center_.y, box.low.y, box.high.y)};
    return needs(nearest, [&](const Point& direction) { return along(direction, nearest); });
  }

 private:
  /// How far the center is from s in a direction.
  [[nodiscard]] double along(const Point& direction, const Point& s) const {
    return direction.x * (center_.x - s.x) + direction.y * (center_.y - s.y);
  }

  /// For a convex set with this point nearest to the center. The distance to it is at least that in any one direction,
  /// a linear function, here in the direction of the center; the distance to the rival is convex, so it exceeds that
  /// function in a corner if anywhere.
  template <class Least>
  [[nodiscard]] bool needs(const Point& nearest, Least&& least_along) const {
    const double dx = center_.x - nearest.x, dy = center_.y - nearest.y;
    const double distance = std::sqrt(dx * dx + dy * dy);
    if (!(distance > 0)) return true;
    const double scale = 1 / distance;
    const Point direction{scale * dx, scale * dy};
    const double at_center = least_along(direction), x = half_ * direction.x, y = half_ * direction.y;
    return rival_[0] >= at_center - x - y || rival_[1] >= at_center + x - y || rival_[2] >= at_center - x + y ||
           rival_[3] >= at_center + x + y;
  }

  Point center_;
  double half_;
  std::array<double, 4> rival_;  // how far it is from the corners
};

NearestCells::NearestCells(std::vector<Ends> segments) : segments_(std::move(segments)), tree_(boxes_of(segments_)) {
  for (const Ends& s : segments_) box_.extend(Box::around(s.a, s.b));
  const double side = std::max(box_.high.x - box_.low.x, box_.high.y - box_.low.y);
  const Point center = box_.center();
  const double largest = std::max(std::fabs(center.x), std::fabs(center.y)) + side;
  if (!(side > kSmallest && largest < kLargest)) return;
  low_ = {center.x - side, center.y - side};  // twice as wide: bounds are asked for around the segments, too
  width_ = std::ldexp(2 * side, -kDeepest);
  margin_ = kMargin * largest;
  root_ = std::make_unique<Node>();
}

NearestCells::~NearestCells() = default;

double NearestCells::squared_distance(const Point& p, const Ends& segment) {
  return std::max(squared_distance_to_segment(p, segment.a, segment.b),
                  Box::around(segment.a, segment.b).squared_distance(p));
}

double NearestCells::by_tree(const Point& p) const {
  const auto distance = [&](std::int32_t segment) { return squared_distance(p, segments_[segment]); };
  return distance(tree_.nearest(p, distance));
}

double NearestCells::least(const Point& p, Items items) const {
  double least = std::numeric_limits<double>::infinity();
  for (const std::int32_t item : items) least = std::min(least, squared_distance(p, segments_[item]));
  return least;
}

double NearestCells::squared_distance(const Point& p) const {
  constexpr double kSide = std::uint32_t{1} << kDeepest;
  const double x = (p.x - low_.x) / width_, y = (p.y - low_.y) / width_;
  if (!(x >= 0 && x < kSide && y >= 0 && y < kSide)) return by_tree(p);
  Place place{static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0};
  Node* node = root_.get();
  while (Quarters* quarters = node->quarters.load(std::memory_order_acquire)) {
    const int shift = kDeepest - ++place.depth;
    node = &quarters->nodes[(place.i >> shift & 1) + 2 * (place.j >> shift & 1)];
  }
  const Items near = node->items();
  if (near.empty() || near.size() > kFew) note_question(*node, near, place);
  return near.empty() ? by_tree(p) : least(p, near);
}

/// Threads may count less than there were, which does no harm.
void NearestCells::note_question(Node& node, Items near, const Place& place) const {
  const std::uint32_t often = near.empty() ? kOftenInTree : kOften;
  const std::uint32_t asked = node.asked.load(std::memory_order_relaxed) + 1;
  if (asked > often) return;
  node.asked.store(asked, std::memory_order_relaxed);
  if (asked < often || place.depth == kDeepest) return;
  if (near.empty())
    find_near(node, place);
  else if (take_room())
    divide(node, near, place);
}

bool NearestCells::take_room() const {
  if (size() + 4 > kSquaresPerSegment * segments_.size() + kMoreSquares) return false;
  size_.fetch_add(4, std::memory_order_relaxed);
  return true;
}

/// By the tree; if there are too many, in quarters.
void NearestCells::find_near(Node& node, const Place& place) const {
  const Square here = square(place, {});
  std::vector<std::int32_t> found;
  tree_.search([&](const Box& box) { return found.size() <= kMany && here.needs(box); },
               [&](std::int32_t item) {
                 if (here.needs(segments_[item])) found.push_back(item);
               });
  if (found.size() <= kMany) {
    node.asked.store(0, std::memory_order_relaxed);
    publish(node.near, packed(found));
  } else if (take_room()) {
    publish(node.quarters, std::make_unique<Quarters>());
  }
}

void NearestCells::divide(Node& node, Items near, const Place& place) const {
  auto quarters = std::make_unique<Quarters>();
  const int shift = kDeepest - place.depth - 1;
  std::vector<std::int32_t> kept;
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t i = (place.i >> (shift + 1) << 1) + k % 2, j = (place.j >> (shift + 1) << 1) + k / 2;
    const Square quarter = square({i << shift, j << shift, place.depth + 1}, near);
    kept.clear();
    std::ranges::copy_if(near, std::back_inserter(kept),
                         [&](std::int32_t item) { return quarter.needs(segments_[item]); });
    quarters->nodes[k].near = packed(kept).release();
  }
  publish(node.quarters, std::move(quarters));
}

/// Its rival is the segment nearest to the center: among these, or of all.
NearestCells::Square NearestCells::square(const Place& place, Items among) const {
  const int shift = kDeepest - place.depth;
  const double half = std::ldexp(width_, shift - 1);
  const auto middle = [&](std::uint32_t i) { return (static_cast<double>(i >> shift) + 0.5) * (2 * half); };
  const Point center{low_.x + middle(place.i), low_.y + middle(place.j)};
  const auto distance = [&](std::int32_t item) { return squared_distance(center, segments_[item]); };
  if (among.empty()) return {center, half, segments_[tree_.nearest(center, distance)], margin_};
  std::int32_t rival = among.front();
  double least = distance(rival);
  for (const std::int32_t item : among.subspan(1))
    if (const double here = distance(item); here < least) {
      least = here;
      rival = item;
    }
  return {center, half, segments_[rival], margin_};
}

}  // namespace driftmesh
