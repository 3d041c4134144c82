#include "mesh/merge_pieces.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <tuple>
#include <vector>

#include "base/narrow.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/id_vector.hpp"

namespace driftmesh {
namespace {

/// Compares to the last bit, including NaN, and -0 against 0.
bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

class Merger {
 public:
  Merger(std::span<const Mesh* const> pieces, MergeFaults& faults, Numbering numbering,
         std::vector<std::size_t>* order = nullptr)
      : pieces_(pieces), faults_(faults), numbering_(numbering), order_(order) {}

  Mesh merge() {
    count_points();
    choose_arrays();
    for (std::size_t k = 0; k < pieces_.size(); ++k) take_points(k);
    report_gaps();
    take_triangles();
    take_edges();
    take_names();
    if (numbering_ == Numbering::kSparse) whole_.numbers = std::move(numbers_);
    return std::move(whole_);
  }

 private:
  static constexpr std::int32_t kNobody = -1;

  void count_points() {
    std::size_t sum = 0;
    std::int64_t largest = -1;
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      const Mesh& piece = *pieces_[k];
      sum += piece.points.size();
      if (piece.numbers.size() != piece.points.size())
        throw Error("piece " + std::to_string(k) + " does not say which numbers its points have in the whole mesh");
      for (const std::int64_t number : piece.numbers) {
        if (number < 0) throw Error("piece " + std::to_string(k) + " has a point of number " + std::to_string(number));
        largest = std::max(largest, number);
      }
    }
    const bool sparse = numbering_ == Numbering::kSparse;
    if (sparse || largest >= static_cast<std::int64_t>(sum)) close_ranks();
    if (!sparse && !numbers_.empty()) report_large_numbers(largest);
    const std::size_t count = !sparse && numbers_.empty() ? to_index(largest + 1) : numbers_.size();
    (void)narrow<std::int32_t>(count, "points of the merged mesh");
    whole_.points.resize(count);
    holder_.assign(count, {kNobody, 0});
  }

  /// Closes the gaps if numbers exceed the count of points, as they do when a piece is missing, to save memory.
  void close_ranks() {
    for (const Mesh* piece : pieces_) numbers_.insert(numbers_.end(), piece->numbers.begin(), piece->numbers.end());
    std::sort(numbers_.begin(), numbers_.end());
    numbers_.erase(std::unique(numbers_.begin(), numbers_.end()), numbers_.end());
  }

  void report_large_numbers(std::int64_t largest) {
    faults_.add([&] {
      return "numbers go up to " + std::to_string(largest) + ", but all pieces together have " +
             std::to_string(numbers_.size()) + " points: pieces are missing";
    });
  }

  /// The place of a point in the whole: its number, unless there are gaps.
  [[nodiscard]] std::size_t place_of(std::int64_t number) const {
    if (numbers_.empty()) return number;
    return std::lower_bound(numbers_.begin(), numbers_.end(), number) - numbers_.begin();
  }

  /// An array is merged if every piece has it.
  void choose_arrays() {
    const auto all = [&](auto tells) {
      return std::all_of(pieces_.begin(), pieces_.end(), [&](const Mesh* piece) { return tells(*piece); });
    };
    const bool markers = all([](const Mesh& p) { return p.point_markers.size() == p.points.size(); });
    if (markers) whole_.point_markers.assign(whole_.points.size(), 0);
    for (const Mesh* p : pieces_)
      whole_.attributes_per_point = std::max(whole_.attributes_per_point, p->attributes_per_point);
    if (!all(
            [&](const Mesh& p) { return p.points.empty() || p.attributes_per_point == whole_.attributes_per_point; })) {
      faults_.add([] { return std::string("pieces have different numbers of attributes at a point"); });
      whole_.attributes_per_point = 0;
    }
    whole_.attributes.assign(whole_.points.size() * whole_.attributes_per_point, 0);
    has_regions_ = all([](const Mesh& p) { return p.regions.size() == p.triangles.size(); });
    has_subdomains_ = all([](const Mesh& p) { return p.subdomains.size() == p.triangles.size(); });
    has_ranks_ = all([](const Mesh& p) { return p.ranks.size() == p.triangles.size(); });
  }

  void take_points(std::size_t k) {
    const Mesh& piece = *pieces_[k];
    for (std::size_t v = 0; v < piece.points.size(); ++v) {
      const std::int64_t number = piece.numbers[v];
      Holder& holder = holder_[place_of(number)];
      if (holder.piece == kNobody) {
        holder = {static_cast<std::int32_t>(k), static_cast<std::int32_t>(v)};
        take_point(piece, v, place_of(number));
      } else if (holder.piece == static_cast<std::int32_t>(k)) {
        faults_.add([&] { return point_words(number) + " is twice in piece " + std::to_string(k); });
      } else {
        compare(holder, k, v);
      }
    }
  }

  void take_point(const Mesh& piece, std::size_t v, std::size_t place) {
    whole_.points[place] = piece.points[v];
    if (!whole_.point_markers.empty()) whole_.point_markers[place] = piece.point_markers[v];
    const std::size_t width = whole_.attributes_per_point;
    for (std::size_t i = 0; i < width; ++i) whole_.attributes[place * width + i] = piece.attributes[v * width + i];
  }

  struct Holder {
    std::int32_t piece;  // the first that has the point
    std::int32_t point;
  };

  void compare(const Holder& first, std::size_t k, std::size_t v) {
    const Mesh &one = *pieces_[first.piece], &other = *pieces_[k];
    const std::size_t u = first.point;
    const Point &p = one.points[u], &q = other.points[v];
    const auto say = [&](const char* what) {
      faults_.add([&] {
        return point_words(other.numbers[v]) + " has other " + what + " in piece " + std::to_string(first.piece) +
               " than in piece " + std::to_string(k);
      });
    };
    if (!same_bits(p.x, q.x) || !same_bits(p.y, q.y)) say("coordinates");
    if (!whole_.point_markers.empty() && one.point_markers[u] != other.point_markers[v]) say("marker");
    const std::size_t width = whole_.attributes_per_point;
    for (std::size_t i = 0; i < width; ++i)
      if (!same_bits(one.attributes[u * width + i], other.attributes[v * width + i])) return say("attributes");
  }

  void report_gaps() {
    for (std::size_t number = 0; number < holder_.size(); ++number)  // none after close_ranks
      if (holder_[number].piece == kNobody)
        faults_.add([&] { return point_words(static_cast<std::int64_t>(number)) + " is in no piece"; });
  }

  static std::string point_words(std::int64_t number) { return "point " + std::to_string(number); }

  /// Triangles of one piece with one subdomain, next to each other.
  struct Run {
    std::int32_t subdomain;
    std::size_t piece;
    std::size_t begin;
    std::size_t end;
  };

  void take_triangles() {
    std::vector<Run> runs;
    std::size_t count = 0;
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      const Mesh& piece = *pieces_[k];
      count += piece.triangles.size();
      for (std::size_t t = 0; t < piece.triangles.size(); ++t) {
        const std::int32_t subdomain = has_subdomains_ ? piece.subdomains[t] : 0;
        if (t == 0 || subdomain != runs.back().subdomain)
          runs.push_back({subdomain, k, t, t + 1});
        else
          ++runs.back().end;
      }
    }
    (void)narrow<std::int32_t>(count, "triangles of the merged mesh");
    std::stable_sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.subdomain < b.subdomain; });
    reserve_triangles(count);
    for (const Run& run : runs) take_run(run);
    if (order_ != nullptr) tell_order(runs);
  }

  void tell_order(const std::vector<Run>& runs) {
    std::vector<std::size_t> first{0};  // that each piece has
    for (const Mesh* piece : pieces_) first.push_back(first.back() + piece->triangles.size());
    order_->clear();
    for (const Run& run : runs)
      for (std::size_t t = run.begin; t < run.end; ++t) order_->push_back(first[run.piece] + t);
  }

  void reserve_triangles(std::size_t count) {
    whole_.triangles.reserve(count);
    if (has_regions_) whole_.regions.reserve(count);
    if (has_subdomains_) whole_.subdomains.reserve(count);
    if (has_ranks_) whole_.ranks.reserve(count);
  }

  void take_run(const Run& run) {
    const Mesh& piece = *pieces_[run.piece];
    for (std::size_t t = run.begin; t < run.end; ++t) {
      const auto& [a, b, c] = piece.triangles[t];
      whole_.triangles.push_back({place(piece, a), place(piece, b), place(piece, c)});
    }
    const auto append = [&](auto& to, const auto& from) {
      to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(run.begin),
                from.begin() + static_cast<std::ptrdiff_t>(run.end));
    };
    if (has_regions_) append(whole_.regions, piece.regions);
    if (has_subdomains_) append(whole_.subdomains, piece.subdomains);
    if (has_ranks_) append(whole_.ranks, piece.ranks);
  }

  [[nodiscard]] std::int32_t place(const Mesh& piece, std::int32_t v) const {
    return static_cast<std::int32_t>(place_of(piece.numbers[v]));
  }

  /// Sorted, so that copies follow each other. Duplicates within one piece stay, for a check to find.
  void take_edges() {
    struct Entry {
      Mesh::Edge edge;
      std::size_t piece;
      [[nodiscard]] auto key() const {
        return std::tuple(std::min(edge.a, edge.b), std::max(edge.a, edge.b), edge.marker);
      }
    };
    std::vector<Entry> all;
    for (std::size_t k = 0; k < pieces_.size(); ++k)
      for (const Mesh::Edge& e : pieces_[k]->edges)
        all.push_back({{place(*pieces_[k], e.a), place(*pieces_[k], e.b), e.marker}, k});
    std::stable_sort(all.begin(), all.end(), [](const Entry& a, const Entry& b) { return a.key() < b.key(); });
    for (std::size_t i = 0; i < all.size(); ++i)
      if (i == 0 || all[i].key() != all[i - 1].key() || all[i].piece == all[i - 1].piece)
        whole_.edges.push_back(all[i].edge);
  }

  /// A piece from a file has them all, or, from other programs, those that it needs.
  void take_names() {
    const auto take = [&](auto& all, const auto& of_piece) {
      for (const auto& entry : of_piece) {
        const std::string& name = entry.second;
        const std::string& known = all.try_emplace(entry.first, name).first->second;
        if (known != name)
          faults_.add([&] { return "pieces have different names, '" + known + "' and '" + name + "'"; });
      }
    };
    for (const Mesh* piece : pieces_) {
      take(whole_.names.markers, piece->names.markers);
      take(whole_.names.regions, piece->names.regions);
    }
    if (pieces_.empty()) return;
    whole_.attribute_names = pieces_.front()->attribute_names;
    whole_.coordinates = pieces_.front()->coordinates;
    for (const Mesh* piece : pieces_)
      if (piece->attribute_names != whole_.attribute_names || piece->coordinates != whole_.coordinates)
        faults_.add([] { return "pieces have different names of attributes or different coordinates"; });
  }

  std::span<const Mesh* const> pieces_;
  MergeFaults& faults_;
  Numbering numbering_;
  std::vector<std::size_t>* order_;  // null: nobody asks
  Mesh whole_;
  std::vector<std::int64_t> numbers_;  // ascending; empty unless gaps are left out
  std::vector<Holder> holder_;         // one for each point
  bool has_regions_ = false;
  bool has_subdomains_ = false;
  bool has_ranks_ = false;
};

}  // namespace

Mesh merge_pieces(std::span<const Mesh* const> pieces, MergeFaults& faults, Numbering numbering) {
  return Merger(pieces, faults, numbering).merge();
}

Mesh merge_pieces(std::span<const Mesh> pieces, MergeFaults& faults, std::vector<std::size_t>* order) {
  std::vector<const Mesh*> all;
  for (const Mesh& piece : pieces) all.push_back(&piece);
  return Merger(all, faults, Numbering::kComplete, order).merge();
}

}  // namespace driftmesh
