#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

#include "base/growing_array.hpp"
#include "mesh/handles.hpp"

namespace driftmesh {

/// The slots of the triangle array that may hold a triangle that is too large, in the order in which they are examined.
/// There is no queue of triangles: a cursor sweeps over the array itself, so a waiting slot costs nothing however often
/// its triangle changes.
///
/// The sweep goes block by block over the `given` slots that exist at the start (sorted in space, see renumber), and
/// after each block over the slots that were added meanwhile, so that the active part of the mesh stays in cache.
/// Slots behind the cursor that receive a triangle that is too large go onto a stack. After the end of the sweep all
/// do, whether they are old or new, so that what is refined then does not depend on the slots that earlier work has
/// freed.
class Sweep {
 public:
  void start(std::int32_t given, std::int32_t block) {
    cursor_ = block_end_ = 0;
    given_ = added_ = given;
    block_ = std::max(block, 1);
    again_.clear();
  }
  /// Looks at no slot any more but those of the stack.
  void end() { *this = Sweep(kEnded, {}); }
  [[nodiscard]] bool ended() const { return added_ == kEnded.added; }
  /// Whether the sweep will still come to slot `t`.
  [[nodiscard]] bool will_visit(TriangleId t) const {
    const std::int32_t slot = to_int(t);
    return (slot >= cursor_ && slot < given_) || slot >= added_;
  }
  void visit_again(TriangleId t) { again_.push_back(t); }

  /// The slot to look at now of an array of `size`, kNone at the end of a block. It stays the same until done_with.
  [[nodiscard]] TriangleId current(std::int32_t size) const {
    if (!again_.empty()) return again_.back();
    if (cursor_ < block_end_) return TriangleId{cursor_};
    return added_ < size ? TriangleId{added_} : kNone;
  }
  void done_with(TriangleId t) {
    if (!again_.empty())
      again_.pop_back();
    else if (to_int(t) == cursor_ && cursor_ < block_end_)
      ++cursor_;
    else
      ++added_;
  }
  /// Moves on to the next block of given slots. False if there is none.
  bool next_block() {
    if (block_end_ == given_) return false;
    block_end_ = given_ - block_end_ < block_ ? given_ : block_end_ + block_;
    return true;
  }

  /// The whole state, to be stored and restored: these five numbers and the stack.
  struct Places {
    std::int32_t cursor, block_end, given, added, block;
    friend bool operator==(const Places&, const Places&) = default;
  };
  static constexpr Places kEnded{0, 0, 0, INT32_MAX, 1};
  [[nodiscard]] Places places() const { return {cursor_, block_end_, given_, added_, block_}; }
  [[nodiscard]] const GrowingArray<TriangleId>& again() const { return again_; }
  Sweep() = default;
  Sweep(const Places& p, GrowingArray<TriangleId> again)
      : cursor_(p.cursor),
        block_end_(p.block_end),
        given_(p.given),
        added_(p.added),
        block_(p.block),
        again_(std::move(again)) {}

 private:
  std::int32_t cursor_ = 0;     // given slots before it are done
  std::int32_t block_end_ = 0;  // end of the block of given slots in work
  std::int32_t given_ = 0;
  std::int32_t added_ = 0;  // added slots before it are done
  std::int32_t block_ = 1;
  GrowingArray<TriangleId> again_;
};

/// Skinny triangles by the length of their shortest edge: off-centers pay off when the shortest edges come first (Ungor
/// 2004), so buckets are narrow, lengths 1.03 to 1.06 apart. Within a bucket the oldest entry comes first: in inputs
/// with many equal edges the work then goes round them all before it returns to its own new triangles, which saves a
/// tenth of the mesh in places. Entries are slots; whether a slot still holds such a triangle is checked when it is
/// taken out.
class SkinnyBuckets {
 public:
  static constexpr int kPerExponent = 8;  ///< buckets for each binary exponent of a squared length
  static constexpr int kBuckets = 2048 * kPerExponent;
  /// The bucket of a squared length: its binary exponent and the first bits of its fraction.
  static int bucket_of(double squared_length) {
    return static_cast<int>(std::bit_cast<std::uint64_t>(squared_length) >> 49) & (kBuckets - 1);
  }
  void add(TriangleId t, int bucket) {
    if (bucket < first_ || bucket >= end()) [[unlikely]]
      make_room(bucket);
    buckets_[bucket - first_].waiting.push_back(t);
    lowest_ = std::min(lowest_, bucket);
  }
  struct Entry {
    TriangleId triangle;
    int bucket;
    /// Whether a triangle with this shortest edge can be the one that was added. Adjacent buckets count too: the
    /// squared length may have been computed in a different order then, and shells make powers of two common.
    [[nodiscard]] bool fits(double squared_length) const { return std::abs(bucket_of(squared_length) - bucket) <= 1; }
  };
  /// Takes out the oldest entry of the lowest bucket; triangle kNone if all are empty.
  Entry take() {
    while (lowest_ < end() && buckets_[lowest_ - first_].waiting.empty()) ++lowest_;
    if (lowest_ >= end()) return {kNone, 0};
    return {buckets_[lowest_ - first_].take(), lowest_};
  }
  /// Empties the buckets and gives their memory back.
  void clear() { *this = {}; }
  /// All entries, in an order such that adding them to empty buckets restores these.
  [[nodiscard]] std::vector<Entry> entries() const {
    std::vector<Entry> all;
    for (int b = lowest_; b < end(); ++b) {
      const Bucket& bucket = buckets_[b - first_];
      for (std::size_t i = bucket.taken; i < bucket.waiting.size(); ++i) all.push_back({bucket.waiting[i], b});
    }
    return all;
  }

 private:
  struct Bucket {
    GrowingArray<TriangleId> waiting;  // from `taken` on
    std::size_t taken = 0;

    TriangleId take() {
      const TriangleId t = waiting[taken++];
      if (taken == waiting.size()) {
        waiting.clear();
        taken = 0;
      }
      return t;
    }
  };

  [[nodiscard]] int end() const { return first_ + static_cast<int>(buckets_.size()); }
  /// Few exponents occur in one mesh, so only the range that occurred has buckets.
  void make_room(int bucket) {
    const int begin = bucket / kPerExponent * kPerExponent;
    if (buckets_.empty()) first_ = begin;
    if (begin < first_) {
      buckets_.insert(buckets_.begin(), first_ - begin, {});
      first_ = begin;
    }
    if (bucket >= end()) buckets_.resize(begin + kPerExponent - first_);
  }

  std::vector<Bucket> buckets_;  // from bucket first_ on
  int first_ = 0;
  int lowest_ = kBuckets;  // none before it has entries
};

}  // namespace driftmesh
