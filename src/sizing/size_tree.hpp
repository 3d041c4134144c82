#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "base/bytes.hpp"
#include "driftmesh/size_field.hpp"
#include "geometry/box.hpp"
#include "geometry/triangle_geometry.hpp"
#include "sizing/plane_function.hpp"

namespace driftmesh {

// A triangle is compared with what a size field asks for between its corners with some tolerance, so that refinement
// neither chases the last percent of a smooth field nor has to find its exact minimum.

/// No length in a triangle is less than this times the triangle's.
inline constexpr double kTolerated = 0.8;

/// A size field, compiled: squares of a quadtree over the domain, each with lengths at its corners, bilinear in
/// between, and a bound on what the field asks for in it. Squares are divided until the lengths are close to the
/// field's, or, at jumps and in other places where they change fast, until the square is as narrow as the lengths in
/// it: there the least holds for all of the square. So no feature is missed, however narrow.
///
/// A square is compiled when it is first asked for, once, whoever asks. Squares and lengths depend on the field and the
/// box of the domain alone, and queries on their arguments; they may run in several threads at once.
class SizeTree final : public SizeField {
 public:
  struct Rules {
    double tolerance = 0.12;  ///< by how much, relative to it, lengths differ from the field's where it is smooth
    double narrow = 0.5;      ///< width of squares at jumps, relative to the least length in them
    /// Finite: only steep squares matter. Those where the field is no steeper than this are not divided, whatever the
    /// lengths in them, and others like those at jumps.
    double steepest = std::numeric_limits<double>::infinity();
  };

  /// The field is `function` where that is positive, and `field` gives the same lengths at points, or throws; null if
  /// the function is positive everywhere. Where the
  /// bounds of the function do not tell that it is positive, squares are no narrower than `finest` > 0, and lengths
  /// those of `field`.
  SizeTree(std::shared_ptr<const SizeField> field, std::shared_ptr<const PlaneFunction> function, const Box& domain,
           double finest, const Rules& rules);
  ~SizeTree() override;
  SizeTree(const SizeTree&) = delete;
  SizeTree& operator=(const SizeTree&) = delete;

  /// The squares that meet some triangles, as numbers of fixed layout, after compiling those that are not yet. Throws
  /// Error where lengths are known at points alone.
  void pack(std::span<const CornerPoints> triangles, ByteWriter& writer) const;
  /// A tree of such numbers, which knows lengths in those triangles alone, and throws Error elsewhere. Throws Error for
  /// other numbers.
  [[nodiscard]] static std::unique_ptr<SizeTree> unpacked(ByteReader& reader);

  /// Throws what the field throws where it asks for no length.
  [[nodiscard]] double edge_length(const Point& p) const override;
  [[nodiscard]] double least() const override { return least_; }
  /// Between the corners a length counts if it is less than kTolerated times the triangle's.
  [[nodiscard]] double least_between(const std::array<Point, 3>& triangle, double at_corners) const override;
  [[nodiscard]] bool falls_below(const std::array<Point, 3>& triangle, double length) const override;

  /// Where a square of the tree is, in the grid that divides the root `level` times.
  struct Spot {
    void* node;  // what the tree keeps of it
    std::uint64_t i, j;
    int level;
  };
  /// A square of the tree.
  struct Square {
    Box box;
    double least;  // no length in it is less
    bool is_divided;
    bool is_steep;  // not divided, and not smooth
    Spot spot;
  };
  /// Has the domain in it.
  [[nodiscard]] Square root() const;
  /// That of such a place.
  [[nodiscard]] Square square_at(const Spot& spot) const;
  /// The quarters of a square that is divided, without those that are smooth.
  struct Steep {
    std::array<Square, 4> squares;
    std::size_t count = 0;
    [[nodiscard]] const Square* begin() const { return squares.data(); }
    [[nodiscard]] const Square* end() const { return squares.data() + count; }
  };
  [[nodiscard]] Steep steep_quarters(const Square& square) const;

  /// How many squares were compiled that are not divided.
  [[nodiscard]] std::size_t leaves() const { return leaves_.load(std::memory_order_relaxed); }

 private:
  struct Node;
  struct Source;
  struct Quarters;
  struct Shelf;
  enum Kind : std::uint8_t { kSmooth, kSteep, kUnknown };
  /// A square of the grid that divides the root `level` times.
  struct Place {
    std::uint64_t i = 0, j = 0;
    int level = 0;
  };
  /// A node that is compiled.
  struct Found {
    const Node* node;
    Place place;
  };
  struct Question;
  static constexpr int kDeepest = 40;
  static constexpr std::size_t kShelves = 8;  // along each side of a pattern

  SizeTree();
  void compile_in(const CornerPoints& triangle, Node& node, const Place& place, Quarters& around) const;
  void pack(const Node& node, ByteWriter& writer) const;
  void unpack(Node& node, const Place& place, ByteReader& reader);
  [[nodiscard]] Square square_of(Node& node, const Place& place, const Box& box, std::uintptr_t state) const;
  [[nodiscard]] bool find_index(const Point& p, std::uint64_t& i, std::uint64_t& j) const;
  [[nodiscard]] Found leaf_at(std::uint64_t i, std::uint64_t j, int deepest) const;
  [[nodiscard]] Box box_of(const Place& place) const;
  [[nodiscard]] std::uintptr_t compiled(Node& node, const Place& place, Quarters& around) const;
  [[nodiscard]] std::uintptr_t compile(Node& node, const Place& place, Quarters& around) const;
  void divide(Node& node, const Place& place, std::shared_ptr<const PlaneFunction> function, Quarters& quarters) const;
  [[nodiscard]] Shelf& shelf_of(const Place& place) const;
  [[nodiscard]] float length_at(const PlaneFunction& function, const Point& p) const;

  [[nodiscard]] bool is_below(const Question& question, const Node& node, const Place& place,
                              std::uintptr_t state) const;
  [[nodiscard]] bool is_below_in_leaf(const Question& question, const Node& node, const Box& leaf,
                                      const Box& part) const;

  std::shared_ptr<const SizeField> field_;
  std::shared_ptr<const PlaneFunction> function_;
  double finest_ = 0;
  Rules rules_;
  Point low_{};
  double width_ = 0, to_index_ = 0;
  int deepest_ = kDeepest;
  double least_ = 0;
  double steepest_ = 0;            // slope of the function in the domain
  std::unique_ptr<Quarters> top_;  // has the root alone
  std::unique_ptr<std::array<Shelf, kShelves * kShelves>> shelves_;
  mutable std::vector<std::atomic<Node*>> directory_;  // nodes at kDirectoryLevel, or leaves above
  mutable std::atomic<std::size_t> leaves_{0};
};

}  // namespace driftmesh
