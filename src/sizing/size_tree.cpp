#include "sizing/size_tree.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

#include "base/formatted.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

constexpr int kDigits = 53;  // bits of a place in the finest grid
constexpr int kDirectoryLevel = 9;
constexpr double kRoughTolerance = 0.16;  // in squares up to twice as wide as the lengths in them
constexpr double kSlack = 1 + 0x1p-20;    // for rounding

/// Toward 0.
float rounded_down(double value) {
  const auto rounded = static_cast<float>(value);
  return rounded > value ? std::nextafter(rounded, 0.0F) : rounded;
}

/// Whether all of the box lies to the right of ab.
bool right_of(const Point& a, const Point& b, const Box& box) {
  // The corner that is farthest to the left.
  const Point p{b.y > a.y ? box.low.x : box.high.x, b.x > a.x ? box.high.y : box.low.y};
  return rounded_cross(a, b, p) < 0;
}

bool meet(const CornerPoints& t, const Box& bounds, const Box& box) {
  return bounds.overlaps(box) && !right_of(t[0], t[1], box) && !right_of(t[1], t[2], box) && !right_of(t[2], t[0], box);
}

double power_of_two(int exponent) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

[[noreturn]] void throw_outside(const Point& p) {
  throw Error(formatted("compiled sizes are asked for near ({}, {}), outside of the domain that they were compiled for",
                        p.x, p.y));
}

/// The least power of two above a length.
double power_above(double length) {
  return std::ldexp(1, std::ilogb(length) + 1);
}

}  // namespace

/// `state`: 0 until it is compiled; then odd for a leaf, with its kind and level, or the address of its quarters.
struct SizeTree::Node {
  std::atomic<std::uintptr_t> state{0};
  std::array<float, 4> corners{};  // lengths, 0 where there is none: lower left, lower right, upper left, upper right
  float least = 0;                 // no length in the square is less
  float error = 0;                 // most that the bilinear lengths are off by

  [[nodiscard]] static bool is_leaf(std::uintptr_t state) { return (state & 1U) != 0; }
  [[nodiscard]] static Kind kind(std::uintptr_t state) { return static_cast<Kind>(state >> 1U & 3U); }
  [[nodiscard]] static int level(std::uintptr_t state) { return static_cast<int>(state >> 3U); }
  [[nodiscard]] static std::uintptr_t leaf(Kind kind, int level) {
    return static_cast<std::uintptr_t>(level) << 3U | static_cast<std::uintptr_t>(kind) << 1U | 1U;
  }
  [[nodiscard]] static Quarters* quarters(std::uintptr_t state) { return std::bit_cast<Quarters*>(state); }

  [[nodiscard]] double at(double u, double v) const {
    const double low = corners[0] + u * (static_cast<double>(corners[1]) - corners[0]);
    const double high = corners[2] + u * (static_cast<double>(corners[3]) - corners[2]);
    return low + v * (high - low);
  }
};

/// What quarters are compiled from, as long as one of them is not.
struct SizeTree::Source {
  std::shared_ptr<const PlaneFunction> function;  // within the divided square
  int left = 4;                                   // quarters to compile
};

struct SizeTree::Quarters {
  std::array<Node, 4> nodes;
  std::unique_ptr<Source> source;
};

/// Quarters of one part of the plane, next to each other in the order in which they are compiled, so that those around
/// a place share lines of the cache.
struct SizeTree::Shelf {
  static constexpr std::size_t kBlock = 64;
  std::mutex lock;
  std::vector<std::unique_ptr<std::array<Quarters, kBlock>>> blocks;
  std::size_t used = kBlock;  // in the last block

  Quarters& next() {
    if (used == kBlock) {
      blocks.push_back(std::make_unique<std::array<Quarters, kBlock>>());
      used = 0;
    }
    return (*blocks.back())[used++];
  }
};

SizeTree::SizeTree(std::shared_ptr<const SizeField> field, std::shared_ptr<const PlaneFunction> function,
                   const Box& domain, double finest, const Rules& rules)
    : field_(std::move(field)),
      function_(std::move(function)),
      finest_(finest),
      rules_(rules),
      top_(std::make_unique<Quarters>()),
      shelves_(std::make_unique<std::array<Shelf, kShelves * kShelves>>()),
      directory_(std::size_t{1} << (2 * kDirectoryLevel)) {
  const double side = std::max({domain.high.x - domain.low.x, domain.high.y - domain.low.y, 0.0});
  // Squares of a grid through the origin, of which two by two cover the domain.
  const bool has_points = domain.low.x <= domain.high.x && domain.low.y <= domain.high.y;
  const double most = has_points ? std::max({std::fabs(domain.low.x), std::fabs(domain.low.y), std::fabs(domain.high.x),
                                             std::fabs(domain.high.y)})
                                 : 0;
  const double half = power_above(std::max({side, std::ldexp(most, -40), 1e-300}));
  if (has_points) low_ = {std::floor(domain.low.x / half) * half, std::floor(domain.low.y / half) * half};
  width_ = 2 * half;
  if (most > 0)
    deepest_ = std::clamp(std::ilogb(width_ / most) + 48, 1, kDeepest);  // squares of some units in the last place
  to_index_ = std::ldexp(1, kDigits) / width_;
  const Variation all = function_->over(domain);
  least_ = all.value.undefined ? 0 : std::max(all.value.low, 0.0);
  steepest_ = all.steepest();
  top_->source = std::make_unique<Source>(Source{function_});
  const Box root = box_of({});
  top_->nodes[0].corners = {length_at(*function_, root.low), length_at(*function_, {root.high.x, root.low.y}),
                            length_at(*function_, {root.low.x, root.high.y}), length_at(*function_, root.high)};
}

/// Without squares.
SizeTree::SizeTree()
    : top_(std::make_unique<Quarters>()),
      shelves_(std::make_unique<std::array<Shelf, kShelves * kShelves>>()),
      directory_(std::size_t{1} << (2 * kDirectoryLevel)) {}

SizeTree::~SizeTree() = default;

/// Relative to the width of the root, as all lengths in nodes; 0 for what is no length.
float SizeTree::length_at(const PlaneFunction& function, const Point& p) const {
  const double length = function.at(p) / width_;
  return length > 0 ? rounded_down(length) : 0;
}

bool SizeTree::find_index(const Point& p, std::uint64_t& i, std::uint64_t& j) const {
  constexpr double kSide = 0x1p53;
  const double x = (p.x - low_.x) * to_index_, y = (p.y - low_.y) * to_index_;
  if (!(x >= 0 && x < kSide && y >= 0 && y < kSide)) return false;
  i = static_cast<std::uint64_t>(x);
  j = static_cast<std::uint64_t>(y);
  return true;
}

Box SizeTree::box_of(const Place& place) const {
  const double w = width_ * power_of_two(-place.level);
  const auto at = [w](double low, std::uint64_t i) { return low + static_cast<double>(i) * w; };
  return {{at(low_.x, place.i), at(low_.y, place.j)}, {at(low_.x, place.i + 1), at(low_.y, place.j + 1)}};
}

// ---- Compiling ----

inline std::uintptr_t SizeTree::compiled(Node& node, const Place& place, Quarters& around) const {
  const std::uintptr_t state = node.state.load(std::memory_order_acquire);
  return state != 0 ? state : compile(node, place, around);
}

/// The same for all quarters of a square. Parts of the plane take turns in a pattern: places near each other share a
/// shelf, and threads that work far apart seldom wait for one.
SizeTree::Shelf& SizeTree::shelf_of(const Place& place) const {
  constexpr int kLevel = 6;
  const int finer = std::max(place.level - kLevel, 1);
  return (*shelves_)[(place.j >> finer) % kShelves * kShelves + (place.i >> finer) % kShelves];
}

/// `around`: with the node.
std::uintptr_t SizeTree::compile(Node& node, const Place& place, Quarters& around) const {
  Shelf& shelf = shelf_of(place);
  const std::lock_guard lock(shelf.lock);
  if (const std::uintptr_t state = node.state.load(std::memory_order_relaxed); state != 0) return state;
  const Box box = box_of(place);
  if (around.source == nullptr) throw_outside(box.center());
  const double width = power_of_two(-place.level);
  const PlaneFunction& function = *around.source->function;
  const Variation found = function.over(box);
  const double low = found.value.low / width_, high = found.value.high / width_;
  const bool undefined = found.value.undefined;
  const auto [least_corner, most_corner] = std::minmax_element(node.corners.begin(), node.corners.end());
  // By linear interpolation along one axis, then along the other: what rises by its greatest slope and falls by its
  // least is off by a quarter of their difference.
  const double by_slopes = kSlack * width * (found.in_x.high - found.in_x.low + found.in_y.high - found.in_y.low) / 4;
  const double error = by_slopes <= high - low ? by_slopes : kSlack * (high - low);
  double least = undefined ? 0 : std::max(low, 0.0);
  if (!undefined && *least_corner > 0 && error < *least_corner) least = std::max(least, *least_corner - error);
  const bool is_constant = least == high;
  const double tolerance = width <= 2 * least ? kRoughTolerance : rules_.tolerance;
  const bool is_gentle = !undefined && least > 0 && found.steepest() <= rules_.steepest;
  const bool is_smooth =
      std::isfinite(rules_.steepest) ? is_gentle : *least_corner > 0 && (error <= tolerance * least || is_constant);
  const bool is_deepest = place.level == deepest_;
  std::uintptr_t state = 0;
  if (is_smooth) {
    node.least = rounded_down(least);
    node.error = is_constant ? 0 : static_cast<float>(kSlack * error + 0x1p-22 * *most_corner);
    state = Node::leaf(kSmooth, place.level);
  } else if (least > 0 && (width <= rules_.narrow * least || is_deepest)) {
    node.least = rounded_down(least);
    if (std::isinf(rules_.steepest)) node.corners.fill(node.least);
    state = Node::leaf(kSteep, place.level);
  } else if (!(least > 0) && (width * width_ <= finest_ || is_deepest)) {
    float known = std::numeric_limits<float>::infinity();
    for (const float length : node.corners)
      if (length > 0) known = std::min(known, length);
    if (const float middle = length_at(function, box.center()); middle > 0) known = std::min(known, middle);
    node.least = known;
    state = Node::leaf(kUnknown, place.level);
  }
  if (state != 0) {
    leaves_.fetch_add(1, std::memory_order_relaxed);
    node.state.store(state, std::memory_order_release);
  } else {
    node.least = rounded_down(least);
    std::shared_ptr<const PlaneFunction> within = function.within(box);
    divide(node, place, within != nullptr ? std::move(within) : around.source->function, shelf.next());
    state = node.state.load(std::memory_order_relaxed);
  }
  if (--around.source->left == 0) around.source.reset();
  return state;
}

void SizeTree::divide(Node& node, const Place& place, std::shared_ptr<const PlaneFunction> function,
                      Quarters& quarters) const {
  const Box box = box_of(place);
  const Point middle = box.center();
  const auto at = [&](double x, double y) { return length_at(*function, {x, y}); };
  const float south = at(middle.x, box.low.y), west = at(box.low.x, middle.y), center = at(middle.x, middle.y),
              east = at(box.high.x, middle.y), north = at(middle.x, box.high.y);
  const auto& c = node.corners;
  quarters.nodes[0].corners = {c[0], south, west, center};
  quarters.nodes[1].corners = {south, c[1], center, east};
  quarters.nodes[2].corners = {west, center, c[2], north};
  quarters.nodes[3].corners = {center, east, north, c[3]};
  quarters.source = std::make_unique<Source>(Source{std::move(function)});
  node.state.store(reinterpret_cast<std::uintptr_t>(&quarters), std::memory_order_release);
}

// ---- As numbers ----

void SizeTree::pack(std::span<const CornerPoints> triangles, ByteWriter& writer) const {
  Node& root = top_->nodes[0];
  for (const CornerPoints& t : triangles) compile_in(t, root, {}, *top_);
  for (const double number : {low_.x, low_.y, width_, least_, steepest_, rules_.tolerance}) writer.number(number);
  writer.number(static_cast<std::int32_t>(deepest_));
  pack(root, writer);
}

/// With a margin around the triangle, for rounding.
void SizeTree::compile_in(const CornerPoints& triangle, Node& node, const Place& place, Quarters& around) const {
  constexpr double kMargin = 0x1p-20, kLeastMargin = 0x1p-44;
  const Box box = box_of(place);
  const double margin = kMargin * (box.high.x - box.low.x) + kLeastMargin * width_;
  if (!meet(triangle, Box::of(triangle), Box::around(box.low, box.high, margin))) return;
  const std::uintptr_t state = compiled(node, place, around);
  if (Node::is_leaf(state)) {
    if (Node::kind(state) != kUnknown) return;
    const Point p = box.center();
    throw Error(formatted("sizes near ({}, {}) are known at points alone", p.x, p.y));
  }
  Quarters& quarters = *Node::quarters(state);
  for (std::uint64_t k = 0; k < 4; ++k)
    compile_in(triangle, quarters.nodes[k], {2 * place.i + k % 2, 2 * place.j + k / 2, place.level + 1}, quarters);
}

/// For each node a byte: 0 if it is not compiled, 1 if it is divided, and otherwise 2 and the kind of the leaf. Then
/// its least length, and the lengths at the corners and the error of leaves; then the quarters.
void SizeTree::pack(const Node& node, ByteWriter& writer) const {
  const std::uintptr_t state = node.state.load(std::memory_order_acquire);
  const bool is_leaf = Node::is_leaf(state);
  writer.number(static_cast<std::uint8_t>(state == 0 ? 0 : is_leaf ? 2 + Node::kind(state) : 1));
  if (state == 0) return;
  writer.number(node.least);
  if (is_leaf) {
    for (const float length : node.corners) writer.number(length);
    writer.number(node.error);
    return;
  }
  for (const Node& quarter : Node::quarters(state)->nodes) pack(quarter, writer);
}

std::unique_ptr<SizeTree> SizeTree::unpacked(ByteReader& reader) {
  std::unique_ptr<SizeTree> tree(new SizeTree);
  for (double* number :
       {&tree->low_.x, &tree->low_.y, &tree->width_, &tree->least_, &tree->steepest_, &tree->rules_.tolerance})
    *number = reader.number<double>();
  tree->deepest_ = reader.number<std::int32_t>();
  if (!(tree->width_ > 0 && std::isfinite(tree->width_)) || tree->deepest_ < 1 || tree->deepest_ > kDeepest)
    throw Error("it is no size tree");
  tree->to_index_ = std::ldexp(1, kDigits) / tree->width_;
  tree->unpack(tree->top_->nodes[0], {}, reader);
  return tree;
}

void SizeTree::unpack(Node& node, const Place& place, ByteReader& reader) {
  const auto tag = reader.number<std::uint8_t>();
  if (tag == 0) return;
  node.least = reader.number<float>();
  if (tag > 1) {
    if (tag > 2 + kSteep) throw Error("it is no size tree");
    for (float& length : node.corners) length = reader.number<float>();
    node.error = reader.number<float>();
    leaves_.fetch_add(1, std::memory_order_relaxed);
    node.state.store(Node::leaf(static_cast<Kind>(tag - 2), place.level), std::memory_order_release);
    return;
  }
  if (place.level == deepest_) throw Error("it is no size tree");
  Quarters& quarters = shelf_of(place).next();
  for (std::uint64_t k = 0; k < 4; ++k)
    unpack(quarters.nodes[k], {2 * place.i + k % 2, 2 * place.j + k / 2, place.level + 1}, reader);
  node.state.store(reinterpret_cast<std::uintptr_t>(&quarters), std::memory_order_release);
}

// ---- Squares ----

SizeTree::Square SizeTree::square_of(Node& node, const Place& place, const Box& box, std::uintptr_t state) const {
  const bool is_leaf = Node::is_leaf(state);
  return {box,
          width_ * node.least,
          !is_leaf,
          is_leaf && Node::kind(state) != kSmooth,
          {&node, place.i, place.j, place.level}};
}

SizeTree::Square SizeTree::root() const {
  Node& node = top_->nodes[0];
  return square_of(node, {}, box_of({}), compiled(node, {}, *top_));
}

SizeTree::Square SizeTree::square_at(const Spot& spot) const {
  Node& node = *static_cast<Node*>(spot.node);
  const Place place{spot.i, spot.j, spot.level};
  return square_of(node, place, box_of(place), node.state.load(std::memory_order_acquire));
}

SizeTree::Steep SizeTree::steep_quarters(const Square& square) const {
  const Spot& spot = square.spot;
  Quarters& parts = *Node::quarters(static_cast<Node*>(spot.node)->state.load(std::memory_order_acquire));
  const Point middle = square.box.center();  // exact: of squares of a grid
  Steep found;
  for (std::size_t k = 0; k < 4; ++k) {
    Node& node = parts.nodes[k];
    const Place place{2 * spot.i + k % 2, 2 * spot.j + k / 2, spot.level + 1};
    const std::uintptr_t state = compiled(node, place, parts);
    if (Node::is_leaf(state) && Node::kind(state) == kSmooth) continue;
    const Box& all = square.box;
    const Box box{{k % 2 == 0 ? all.low.x : middle.x, k / 2 == 0 ? all.low.y : middle.y},
                  {k % 2 == 0 ? middle.x : all.high.x, k / 2 == 0 ? middle.y : all.high.y}};
    found.squares[found.count++] = square_of(node, place, box, state);
  }
  return found;
}

// ---- At a point ----

/// The leaf at an index of the finest grid, or the node of the deepest level.
inline SizeTree::Found SizeTree::leaf_at(std::uint64_t i, std::uint64_t j, int deepest) const {
  const auto place_at = [&](int level) { return Place{i >> (kDigits - level), j >> (kDigits - level), level}; };
  constexpr int kShift = kDigits - kDirectoryLevel;
  std::atomic<Node*>& entry = directory_[(j >> kShift << kDirectoryLevel) + (i >> kShift)];
  Node* node = deepest >= kDirectoryLevel ? entry.load(std::memory_order_acquire) : nullptr;
  const bool is_known = node != nullptr;
  int level = is_known ? kDirectoryLevel : 0;
  if (!is_known) node = &top_->nodes[0];
  Quarters* around = top_.get();
  for (;;) {
    const std::uintptr_t state = is_known && level == kDirectoryLevel ? node->state.load(std::memory_order_acquire)
                                                                      : compiled(*node, place_at(level), *around);
    const bool is_leaf = Node::is_leaf(state);
    if (is_leaf) level = Node::level(state);
    if (!is_known && (level == kDirectoryLevel || (is_leaf && level < kDirectoryLevel)))
      entry.store(node, std::memory_order_release);
    if (is_leaf || level == deepest) return {node, place_at(level)};
    around = Node::quarters(state);
    ++level;
    const int shift = kDigits - level;
    node = &around->nodes[(i >> shift & 1U) + 2 * (j >> shift & 1U)];
  }
}

double SizeTree::edge_length(const Point& p) const {
  std::uint64_t i = 0, j = 0;
  const auto by_itself = [&] {
    if (function_ == nullptr) throw_outside(p);
    const double length = function_->at(p);
    return length > 0 || field_ == nullptr ? length : field_->edge_length(p);
  };
  if (!find_index(p, i, j)) return by_itself();
  const Found leaf = leaf_at(i, j, deepest_);
  if (Node::kind(leaf.node->state.load(std::memory_order_relaxed)) == kUnknown) return by_itself();
  const int shift = kDigits - leaf.place.level;
  const auto part = [shift](std::uint64_t index) {
    return static_cast<double>(index & ((std::uint64_t{1} << shift) - 1)) * power_of_two(-shift);
  };
  if (std::isinf(leaf.node->least)) return leaf.node->least;
  return width_ * leaf.node->at(part(i), part(j));
}

// ---- In a triangle ----

double SizeTree::least_between(const std::array<Point, 3>& t, double at_corners) const {
  // No point is farther from the nearest corner than the longest edge over the root of 3.
  const double longest =
      std::max({squared_distance(t[0], t[1]), squared_distance(t[1], t[2]), squared_distance(t[2], t[0])});
  const double room = at_corners / (1 + rules_.tolerance) - kTolerated * at_corners;
  if (steepest_ * steepest_ * longest <= 3 * room * room) return at_corners;
  const Box box = Box::of(t);
  std::uint64_t i = 0, j = 0, right = 0, top = 0;
  if (!find_index(box.low, i, j) || !find_index(box.high, right, top)) return 0;
  const int common = std::countl_zero((i ^ right) | (j ^ top)) - (64 - kDigits);
  const auto [node, place] = leaf_at(i, j, std::clamp(common, 0, deepest_));
  const double enough = kTolerated * at_corners / width_;
  if (node->least >= enough) return at_corners;
  const std::uintptr_t state = node->state.load(std::memory_order_relaxed);
  if (!Node::is_leaf(state) || Node::kind(state) != kSmooth) return 0;
  // Bilinear lengths are linear but for a product, which is off by a quarter of the box at most.
  const auto& c = node->corners;
  const double scale = power_of_two(place.level) / width_;
  const double twist = std::fabs(static_cast<double>(c[0]) - c[1] - c[2] + c[3]);
  const double bend = twist * (box.high.x - box.low.x) * scale * ((box.high.y - box.low.y) * scale) / 4;
  return at_corners / width_ - bend - node->error >= enough ? at_corners : 0;
}

struct SizeTree::Question {
  const CornerPoints& triangle;
  Box bounds;
  double enough;  // relative to the width of the root
  double finest;  // width of parts of leaves
};

bool SizeTree::falls_below(const std::array<Point, 3>& triangle, double length) const {
  if (least_ >= kTolerated * length) return false;
  const Box box = Box::of(triangle);
  constexpr double kFinest = 1.0 / 32;
  const Question question{triangle, box, kTolerated * length / width_,
                          kFinest * std::max(box.high.x - box.low.x, box.high.y - box.low.y)};
  std::uint64_t i = 0, j = 0, right = 0, top = 0;
  if (!find_index(box.low, i, j) || !find_index(box.high, right, top)) return false;
  const int common = std::countl_zero((i ^ right) | (j ^ top)) - (64 - kDigits);
  const auto [node, place] = leaf_at(i, j, std::clamp(common, 0, deepest_));
  return is_below(question, *node, place, node->state.load(std::memory_order_relaxed));
}

bool SizeTree::is_below(const Question& question, const Node& node, const Place& place, std::uintptr_t state) const {
  if (node.least >= question.enough) return false;
  const Box box = box_of(place);
  if (!meet(question.triangle, question.bounds, box)) return false;
  if (Node::is_leaf(state)) return Node::kind(state) != kSmooth || is_below_in_leaf(question, node, box, box);
  Quarters& quarters = *Node::quarters(state);
  for (std::uint64_t k = 0; k < 4; ++k) {
    const Place quarter{2 * place.i + k % 2, 2 * place.j + k / 2, place.level + 1};
    Node& part = quarters.nodes[k];
    if (!question.bounds.overlaps(box_of(quarter))) continue;
    if (is_below(question, part, quarter, compiled(part, quarter, quarters))) return true;
  }
  return false;
}

/// Bilinear lengths are least at a corner of a part.
bool SizeTree::is_below_in_leaf(const Question& question, const Node& node, const Box& leaf, const Box& part) const {
  if (!meet(question.triangle, question.bounds, part)) return false;
  const double scale = 1 / (leaf.high.x - leaf.low.x);
  const auto at = [&](double x, double y) { return node.at((x - leaf.low.x) * scale, (y - leaf.low.y) * scale); };
  const Box inside{{std::max(part.low.x, question.bounds.low.x), std::max(part.low.y, question.bounds.low.y)},
                   {std::min(part.high.x, question.bounds.high.x), std::min(part.high.y, question.bounds.high.y)}};
  const auto [least, most] = std::minmax({at(inside.low.x, inside.low.y), at(inside.high.x, inside.low.y),
                                          at(inside.low.x, inside.high.y), at(inside.high.x, inside.high.y)});
  if (least - node.error >= question.enough) return false;
  if (most - node.error < question.enough || inside.high.x - inside.low.x <= question.finest) return true;
  const Point m = part.center();
  const auto in = [&](const Box& quarter) { return is_below_in_leaf(question, node, leaf, quarter); };
  return in({part.low, m}) || in({{m.x, part.low.y}, {part.high.x, m.y}}) ||
         in({{part.low.x, m.y}, {m.x, part.high.y}}) || in({m, part.high});
}

}  // namespace driftmesh
