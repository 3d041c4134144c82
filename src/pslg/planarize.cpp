#include "pslg/planarize.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <span>
#include <unordered_map>
#include <utility>

#include "base/narrow.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/id_vector.hpp"
#include "driftmesh/repair.hpp"
#include "geometry/box_tree.hpp"
#include "pslg/closeness.hpp"
#include "pslg/convex_hull.hpp"
#include "pslg/describe.hpp"
#include "pslg/free_branches.hpp"
#include "pslg/keep_points.hpp"
#include "pslg/near_segment.hpp"
#include "pslg/pair_key.hpp"
#include "pslg/point_welder.hpp"
#include "pslg/polygons.hpp"

namespace driftmesh {
namespace {

// The origin of a piece that does not come from a segment of the input.
constexpr std::int32_t kHullEdge = -1, kDropped = -2;

double extent(const Box& box) {
  return std::max({box.high.x - box.low.x, box.high.y - box.low.y, 0.0});
}

constexpr std::int32_t kAhead = 16;  // points that the welder looks ahead: as long as memory takes to answer

template <class Describe>
void note(RepairItem& item, Describe describe) {
  if (item.count++ < RepairItem::kMaxExamples) item.examples.push_back(describe());
}

double distance_to_line(const Point& p, const Point& a, const Point& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  return std::fabs(dx * (p.y - a.y) - dy * (p.x - a.x)) / std::hypot(dx, dy);
}

/// For each segment whether it is on a ring, or between rings: not on a line with a free end.
std::vector<bool> segments_on_rings(const Pslg& pslg) {
  PointWelder welder(pslg.points.size());
  std::vector<std::int32_t> welded;
  for (const Point& p : pslg.points) welded.push_back(welder.add(p));
  std::vector<Pslg::Segment> segments;
  for (const Pslg::Segment& s : pslg.segments) segments.push_back({welded[s.a], welded[s.b]});
  std::vector<bool> on_rings =
      free_branches(segments, welder.points().size(), std::vector<bool>(segments.size(), true));
  on_rings.flip();
  return on_rings;
}

/// Works in rounds. Each round finds, for segments and points that are new since the last one, which points lie on
/// which segments and which segments cross, then splits these. New points are rounded, so pieces may cross or touch
/// what the whole segment did not; the next round handles that. A round that finds nothing proves that the graph is
/// planar.
class Planarizer {
 public:
  Planarizer(Pslg& pslg, const std::string& file, const RepairOptions& options, RepairReport& report)
      : pslg_(pslg),
        file_(file),
        options_(options),
        report_(report),
        closeness_(Closeness::within(extent(Box::of(pslg.points)), options.snap)),
        welder_(pslg.points.size(), closeness_) {}

  void run() {
    weld_points();
    start_segments();
    make_planar();
    if (pieces_.empty() || options_.hull) {
      add_hull();
      make_planar();
    }
    if (options_.snap > 0) drop_collapsed();
    finish();
  }

 private:
  /// A segment being processed: a piece of segment `origin` of the input.
  struct Piece {
    Pslg::Segment segment;
    std::int32_t origin = 0;  // kHullEdge: an edge of the hull
    bool fresh = true;
    bool of_rings = false;  // whether all segments that it stands for were on rings
    bool merged = false;    // whether it stands for several
  };
  /// Segment `piece` passes through `vertex`, at this place along it.
  struct Split {
    std::int32_t piece = 0;
    std::int32_t vertex = 0;
    double along = 0;
  };

  const std::vector<Point>& points() const { return welder_.points(); }
  const Point& point(std::int32_t v) const { return points()[v]; }
  double margin(const Pslg::Segment& s) const { return closeness_(point(s.a), point(s.b)); }
  NearSegment near(const Pslg::Segment& s) const { return {point(s.a), point(s.b), margin(s)}; }
  OnSegment on_segment(const Point& p, const Pslg::Segment& s) const {
    return driftmesh::on_segment(p, point(s.a), point(s.b), margin(s));
  }

  void weld_points();
  void start_segments();
  void make_planar();
  void add_hull();
  void drop_collapsed();
  void keep_once(RepairItem& item);
  void erase_dropped();
  void find_splits();
  void note_finders();
  void index_loose_points();
  std::vector<Box> piece_boxes() const;
  void find_loose_points_on(std::int32_t piece);
  void find_meetings_of(std::int32_t piece, const BoxTree& tree);
  void find_segments_through(std::int32_t vertex, const BoxTree& tree);
  void test_point(std::int32_t vertex, std::int32_t piece);
  void test_pair(std::int32_t piece, std::int32_t other);
  void add_crossing(std::int32_t piece, std::int32_t other);
  void add_split(std::int32_t piece, std::int32_t vertex);
  void split_segments();
  void split_rings();
  void copy_point_data(std::int32_t index);
  void interpolate_point_data(const Piece& piece, const Point& p);
  std::vector<bool> bare_points() const;
  void finish();
  [[noreturn]] void fail_to_end() const;

  void note_move(double distance) { report_.largest_move = std::max(report_.largest_move, distance); }
  std::string name(std::int32_t vertex) const;
  std::string name(const Piece& piece) const;

  Pslg& pslg_;
  const std::string& file_;
  const RepairOptions& options_;
  RepairReport& report_;
  Closeness closeness_;
  PointWelder welder_;
  std::vector<std::int32_t> welded_;  // for each point of the input its index in points()
  std::vector<std::int32_t> markers_;
  std::vector<double> attributes_;
  std::vector<Piece> pieces_;
  std::vector<Split> splits_;
  std::vector<std::int32_t> loose_;   // points that are not ends of segments
  BoxTree loose_tree_;                // holds loose_
  std::vector<std::int32_t> finder_;  // for each other point, a piece that ends there
  std::size_t points_seen_ = 0;       // points that earlier rounds have seen
  std::int64_t split_count_ = 0;
  bool fresh_exists_ = false;
};

std::string Planarizer::name(std::int32_t vertex) const {
  return vertex_name(pslg_, report_.original_point[vertex], point(vertex));
}

std::string Planarizer::name(const Piece& piece) const {
  return piece.origin == kHullEdge ? "an edge of the hull" : segment_name(pslg_, piece.origin);
}

void Planarizer::weld_points() {
  const auto count = narrow<std::int32_t>(pslg_.points.size(), "vertices");
  welded_.reserve(pslg_.points.size());
  report_.original_point.reserve(pslg_.points.size());
  for (std::int32_t i = 0; i < count; ++i) {
    const Point& p = pslg_.points[i];
    if (i + kAhead < count) welder_.prefetch(pslg_.points[i + kAhead]);
    const std::int32_t kept = welder_.add(p);
    welded_.push_back(kept);
    if (std::cmp_equal(kept, report_.original_point.size())) {
      report_.original_point.push_back(i);
      copy_point_data(i);
      continue;
    }
    if (!markers_.empty() && markers_[kept] == 0) markers_[kept] = pslg_.point_markers[i];
    note_move(std::hypot(p.x - point(kept).x, p.y - point(kept).y));
    note(point(kept) == p ? report_.duplicate_points : report_.close_points,
         [&] { return vertex_name(pslg_, i, p) + " merged into " + name(kept); });
  }
  for (Pslg::Polygon& polygon : pslg_.polygons)
    for (Pslg::Ring& ring : polygon.rings) {
      for (std::int32_t& corner : ring) corner = welded_[corner];
      drop_repetitions(ring);
    }
}

void Planarizer::copy_point_data(std::int32_t index) {
  if (!pslg_.point_markers.empty()) markers_.push_back(pslg_.point_markers[index]);
  const std::size_t stride = pslg_.attributes_per_point;
  for (std::size_t k = 0; k < stride; ++k) attributes_.push_back(pslg_.attributes[index * stride + k]);
}

void Planarizer::interpolate_point_data(const Piece& piece, const Point& p) {
  report_.original_point.push_back(-1);
  if (!pslg_.point_markers.empty()) markers_.push_back(piece.segment.marker);
  const Point &a = point(piece.segment.a), &b = point(piece.segment.b);
  const double t = std::hypot(p.x - a.x, p.y - a.y) / std::hypot(b.x - a.x, b.y - a.y);
  const std::size_t stride = pslg_.attributes_per_point;
  for (std::size_t k = 0; k < stride; ++k) {
    const double at_a = attributes_[piece.segment.a * stride + k];
    const double at_b = attributes_[piece.segment.b * stride + k];
    attributes_.push_back((1 - t) * at_a + t * at_b);
  }
}

void Planarizer::start_segments() {
  pieces_.reserve(pslg_.segments.size());
  const std::vector<bool> on_rings = options_.snap > 0 ? segments_on_rings(pslg_) : std::vector<bool>{};
  std::int32_t origin = 0;
  for (const Pslg::Segment& s : pslg_.segments) {
    const bool of_rings = !on_rings.empty() && on_rings[to_index(origin)];
    const Piece piece{{welded_[s.a], welded_[s.b], s.marker}, origin++, true, of_rings};
    if (piece.segment.a != piece.segment.b)
      pieces_.push_back(piece);
    else
      note(report_.zero_length_segments, [&] { return name(piece) + " begins and ends at " + name(piece.segment.a); });
  }
  keep_once(report_.duplicate_segments);
  fresh_exists_ = !pieces_.empty();
}

void Planarizer::make_planar() {
  for (int round = 0; fresh_exists_; ++round) {
    if (round == kMaxRounds) fail_to_end();
    find_splits();
    split_segments();
  }
}

// Like any segment, an edge of the hull may pass close to other points.
void Planarizer::add_hull() {
  const auto ends = [](const Pslg::Segment& s) { return std::minmax(s.a, s.b); };
  std::set<std::pair<std::int32_t, std::int32_t>> present;
  for (const Piece& piece : pieces_) present.insert(ends(piece.segment));
  for (const Pslg::Segment& s : convex_hull(points())) {
    if (present.contains(ends(s))) continue;
    pieces_.push_back({s, kHullEdge, true});
    fresh_exists_ = true;
  }
}

// Keeps the first of several pieces between the same two points.
void Planarizer::keep_once(RepairItem& item) {
  struct Key {
    std::int32_t low, high, piece;
    auto operator<=>(const Key&) const = default;
  };
  std::vector<Key> keys;
  keys.reserve(pieces_.size());
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const auto [low, high] = std::minmax(pieces_[i].segment.a, pieces_[i].segment.b);
    keys.push_back({low, high, static_cast<std::int32_t>(i)});
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::int32_t> dropped;
  std::int32_t kept = -1;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const bool repeats = i > 0 && keys[i].low == keys[i - 1].low && keys[i].high == keys[i - 1].high;
    if (!repeats) {
      kept = keys[i].piece;
      continue;
    }
    const Piece& other = pieces_[keys[i].piece];
    Pslg::Segment& first = pieces_[kept].segment;
    dropped.push_back(keys[i].piece);
    note(item, [&] { return name(other) + " repeats " + name(pieces_[kept]); });
    pieces_[kept].merged = true;
    pieces_[kept].of_rings = pieces_[kept].of_rings && other.of_rings;
    if (first.marker == 0) first.marker = other.segment.marker;
    if (other.segment.marker != 0 && other.segment.marker != first.marker)
      note(report_.marker_conflicts, [&] { return name(other) + " and " + name(pieces_[kept]); });
  }
  if (dropped.empty()) return;
  for (const std::int32_t i : dropped) pieces_[i].origin = kDropped;
  erase_dropped();
}

void Planarizer::erase_dropped() {
  std::erase_if(pieces_, [](const Piece& piece) { return piece.origin == kDropped; });
}

// Points that are ends are found where their pieces are; each is looked at once, with one of its pieces.
void Planarizer::note_finders() {
  finder_.assign(points().size(), kNone);
  for (std::size_t i = 0; i < pieces_.size(); ++i)
    for (const std::int32_t end : {pieces_[i].segment.a, pieces_[i].segment.b})
      if (finder_[end] == kNone) finder_[end] = static_cast<std::int32_t>(i);
  for (const std::int32_t v : loose_) finder_[v] = kNone;
}

// Once, since all points that are added later are ends.
void Planarizer::index_loose_points() {
  loose_.reserve(static_cast<std::size_t>(std::count(finder_.begin(), finder_.end(), std::int32_t{kNone})));
  for (const std::int32_t v : first_ids<std::int32_t>(points().size()))
    if (finder_[v] == kNone) loose_.push_back(v);
  std::vector<Box> boxes;
  boxes.reserve(loose_.size());
  for (const std::int32_t v : loose_) boxes.push_back(Box::around(point(v), point(v)));
  loose_tree_ = BoxTree(boxes);
}

std::vector<Box> Planarizer::piece_boxes() const {
  std::vector<Box> boxes;
  boxes.reserve(pieces_.size());
  for (const Piece& piece : pieces_) {
    const Point &a = point(piece.segment.a), &b = point(piece.segment.b);
    boxes.push_back(Box::around(a, b, closeness_(a, b)));
  }
  return boxes;
}

void Planarizer::find_splits() {
  note_finders();
  if (points_seen_ == 0) index_loose_points();
  const std::size_t first_new = points_seen_ == 0 ? points().size() : points_seen_;
  points_seen_ = points().size();
  const BoxTree piece_tree(piece_boxes());
  const auto piece_count = narrow<std::int32_t>(pieces_.size(), "segments");
  splits_.clear();
  for (std::int32_t i = 0; i < piece_count; ++i) {
    if (!pieces_[i].fresh) continue;
    find_loose_points_on(i);
    find_meetings_of(i, piece_tree);
  }
  for (std::size_t v = first_new; v < points().size(); ++v)
    find_segments_through(static_cast<std::int32_t>(v), piece_tree);
}

void Planarizer::find_loose_points_on(std::int32_t piece) {
  const Pslg::Segment s = pieces_[piece].segment;
  loose_tree_.search(near(s), [&](std::int32_t i) { test_point(loose_[i], piece); });
}

void Planarizer::find_segments_through(std::int32_t vertex, const BoxTree& tree) {
  tree.visit_containing(point(vertex), [&](std::int32_t piece) {
    if (!pieces_[piece].fresh) test_point(vertex, piece);
  });
}

void Planarizer::find_meetings_of(std::int32_t piece, const BoxTree& tree) {
  const Pslg::Segment s = pieces_[piece].segment;
  tree.search(near(s), [&](std::int32_t other) {
    for (const std::int32_t end : {pieces_[other].segment.a, pieces_[other].segment.b})
      if (finder_[end] == other) test_point(end, piece);
    if (other > piece || !pieces_[other].fresh) test_pair(piece, other);
  });
}

void Planarizer::test_point(std::int32_t vertex, std::int32_t piece) {
  const Piece& p = pieces_[piece];
  if (vertex == p.segment.a || vertex == p.segment.b) return;
  const OnSegment where = on_segment(point(vertex), p.segment);
  if (where == OnSegment::kNo) return;
  add_split(piece, vertex);
  note_move(distance_to_line(point(vertex), point(p.segment.a), point(p.segment.b)));
  note(where == OnSegment::kExactly ? report_.points_on_segments : report_.points_close_segments,
       [&] { return name(vertex) + " on " + name(p); });
}

// If an end of one lies on the other, that vertex splits it, and no new vertex is needed.
void Planarizer::test_pair(std::int32_t piece, std::int32_t other) {
  const Pslg::Segment s = pieces_[piece].segment, t = pieces_[other].segment;
  if (s.a == t.a || s.a == t.b || s.b == t.a || s.b == t.b) return;
  const Point &a = point(s.a), &b = point(s.b), &c = point(t.a), &d = point(t.b);
  if (!cross_properly(a, b, c, d)) return;
  const auto touches = [&](const Point& p, const Pslg::Segment& on) { return on_segment(p, on) != OnSegment::kNo; };
  if (touches(a, t) || touches(b, t) || touches(c, s) || touches(d, s)) return;
  add_crossing(piece, other);
}

void Planarizer::add_crossing(std::int32_t piece, std::int32_t other) {
  const Piece &s = pieces_[piece], &t = pieces_[other];
  const Point p = crossing_point(point(s.segment.a), point(s.segment.b), point(t.segment.a), point(t.segment.b));
  const std::int32_t vertex = welder_.add(p);
  if (std::cmp_equal(vertex, report_.original_point.size())) interpolate_point_data(s, p);
  add_split(piece, vertex);
  add_split(other, vertex);
  note(report_.crossings, [&] { return name(s) + " and " + name(t) + " cross at " + coordinates(p); });
}

void Planarizer::add_split(std::int32_t piece, std::int32_t vertex) {
  const Pslg::Segment s = pieces_[piece].segment;
  if (vertex == s.a || vertex == s.b) return;
  if (++split_count_ > kMaxSplits)
    throw InputError({file_, 0}, "the segments cross or overlap more than " + std::to_string(kMaxSplits) + " times",
                     "their vertex numbers are probably wrong");
  const Point &a = point(s.a), &b = point(s.b), &p = point(vertex);
  splits_.push_back({piece, vertex, (p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y)});
}

void Planarizer::split_segments() {
  std::sort(splits_.begin(), splits_.end(), [](const Split& l, const Split& r) {
    if (l.piece != r.piece) return l.piece < r.piece;
    return l.along != r.along ? l.along < r.along : l.vertex < r.vertex;
  });
  split_rings();
  std::vector<Piece> next;
  next.reserve(pieces_.size() + splits_.size());
  auto split = splits_.begin();
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(pieces_.size()); ++i) {
    Piece piece = pieces_[i];
    piece.fresh = split != splits_.end() && split->piece == i;
    const std::int32_t end = piece.segment.b;
    for (; split != splits_.end() && split->piece == i; ++split) {
      if (split->vertex == piece.segment.a) continue;  // two crossings rounded to one point
      piece.segment.b = split->vertex;
      next.push_back(piece);
      piece.segment.a = split->vertex;
    }
    piece.segment.b = end;
    next.push_back(piece);
  }
  pieces_ = std::move(next);
  fresh_exists_ = !splits_.empty();
  if (fresh_exists_) keep_once(report_.overlaps);
}

// Each edge of a ring is a piece, before and after.
void Planarizer::split_rings() {
  if (pslg_.polygons.empty() || splits_.empty()) return;
  std::unordered_map<std::uint64_t, std::span<const Split>> splits_of;
  for (auto split = splits_.begin(); split != splits_.end();) {
    const auto end = std::find_if(split, splits_.end(), [&](const Split& s) { return s.piece != split->piece; });
    const Pslg::Segment s = pieces_[split->piece].segment;
    splits_of[pair_key(s.a, s.b)] = std::span(split, end);
    split = end;
  }
  for (Pslg::Polygon& polygon : pslg_.polygons)
    for (Pslg::Ring& ring : polygon.rings) {
      Pslg::Ring next;
      next.reserve(ring.size());
      for (std::size_t i = 0; i < ring.size(); ++i) {
        next.push_back(ring[i]);
        const auto found = splits_of.find(pair_key(ring[i], ring[i + 1 == ring.size() ? 0 : i + 1]));
        if (found == splits_of.end()) continue;
        const auto& splits = found->second;
        const std::size_t old = next.size();
        for (const Split& split : splits) next.push_back(split.vertex);
        if (pieces_[splits.front().piece].segment.a != ring[i])
          std::reverse(next.begin() + static_cast<std::ptrdiff_t>(old), next.end());
      }
      drop_repetitions(next);
      ring = std::move(next);
    }
}

// Where both sides of a ring have fallen together, they bound no area, and go from their free ends on. Lines that were
// open before stay.
void Planarizer::drop_collapsed() {
  std::vector<Pslg::Segment> segments;
  std::vector<bool> may_go;
  for (const Piece& piece : pieces_) {
    segments.push_back(piece.segment);
    may_go.push_back(piece.merged && piece.of_rings);
  }
  const std::vector<bool> free = free_branches(segments, points().size(), may_go);
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    if (!free[i]) continue;
    note(report_.collapsed,
         [&] { return name(pieces_[i]) + " from " + name(segments[i].a) + " to " + name(segments[i].b); });
    pieces_[i].origin = kDropped;
  }
  erase_dropped();
}

// Points whose segments snapping has taken, to the last, go as well. With the free end of a piece, rings that walked
// the piece there and back turn before it.
std::vector<bool> Planarizer::bare_points() const {
  std::vector<bool> bare(points().size(), false);
  if (options_.snap == 0) return bare;
  for (std::size_t v = 0; v < bare.size(); ++v) bare[v] = report_.original_point[v] < 0;  // crossings
  for (const Pslg::Segment& s : pslg_.segments)
    for (const std::int32_t end : {s.a, s.b}) bare[to_index(welded_[end])] = true;
  for (const Piece& piece : pieces_)
    for (const std::int32_t end : {piece.segment.a, piece.segment.b}) bare[to_index(end)] = false;
  return bare;
}

void Planarizer::finish() {
  std::vector<Pslg::Segment> segments;
  segments.reserve(pieces_.size());
  for (const Piece& piece : pieces_) segments.push_back(piece.segment);
  const std::vector<bool> bare = bare_points();
  pslg_.segments = std::move(segments);
  pslg_.points = points();
  pslg_.point_markers = std::move(markers_);
  pslg_.attributes = std::move(attributes_);
  if (std::ranges::count(bare, true) == 0) return;
  std::vector<std::int32_t> original;
  for (const std::int32_t kept : keep_points(pslg_, bare)) original.push_back(report_.original_point[to_index(kept)]);
  report_.original_point = std::move(original);
}

void Planarizer::fail_to_end() const {
  const Split& last = splits_.front();
  throw InputError({file_, 0},
                   "segments near " + coordinates(point(last.vertex)) + " still cross after " +
                       std::to_string(kMaxRounds) + " rounds of repair, because rounding moves them each time",
                   options_.snap > 0 ? "snap by another length, or simplify the input there"
                                     : "simplify the input there or give it coordinates with fewer digits");
}

}  // namespace

void planarize(Pslg& pslg, const std::string& file, const RepairOptions& options, RepairReport& report) {
  Planarizer(pslg, file, options, report).run();
}

}  // namespace driftmesh
