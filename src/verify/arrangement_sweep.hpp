#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "driftmesh/point.hpp"
#include "verify/arrangement.hpp"

namespace driftmesh {

/// A sweep over the points in lexicographic order (Shamos and Hoey 1976): finds whether links meet where they must
/// not, and for every point and query the link directly below it. All decisions are exact.
class ArrangementSweep {
 public:
  static constexpr std::int32_t kNothing = -1;  ///< no link below
  static constexpr std::int32_t kOn = -2;       ///< the query lies on a link or an end of one

  ArrangementSweep(std::span<const Point> points, std::span<const Arrangement::Link> links,
                   std::span<const Point> queries);

  /// Runs until the end or the first conflict.
  void run();

  [[nodiscard]] const std::optional<std::string>& conflict() const { return conflict_; }
  /// For each point the link directly below it (none of its own), or kNothing.
  [[nodiscard]] const std::vector<std::int32_t>& below_point() const { return below_point_; }
  [[nodiscard]] const std::vector<std::int32_t>& below_query() const { return below_query_; }

 private:
  struct Span {  // a link from its lexicographically lower end to the upper one
    std::int32_t low = 0;
    std::int32_t high = 0;
  };
  struct BelowOrder {
    using is_transparent = void;
    const ArrangementSweep* sweep;
    bool operator()(std::int32_t a, std::int32_t b) const { return sweep->link_below_link(a, b); }
    bool operator()(std::int32_t a, const Point& p) const { return sweep->side_of(a, p) > 0; }
    bool operator()(const Point& p, std::int32_t a) const { return sweep->side_of(a, p) < 0; }
  };
  using Status = std::set<std::int32_t, BelowOrder>;  // active links, lowest first

  [[nodiscard]] std::optional<std::string> find_unfit() const;
  [[nodiscard]] const Point& at(std::int32_t point) const { return points_[point]; }
  [[nodiscard]] const Span& span(std::int32_t link) const { return spans_[link]; }
  [[nodiscard]] double side_of(std::int32_t link, const Point& p) const;
  [[nodiscard]] bool link_below_link(std::int32_t a, std::int32_t b) const;
  [[nodiscard]] bool meet_wrongly(std::int32_t a, std::int32_t b) const;

  void sweep();
  void locate_query(std::size_t query, bool on_point);
  void visit_point(std::int32_t point);
  void end_links(std::int32_t point);
  void start_links(std::int32_t point);
  void check_neighbors(std::int32_t below, Status::iterator upper);
  void report(const char* what, std::int32_t link, std::int32_t other);

  std::span<const Point> points_;
  std::span<const Point> queries_;
  std::vector<Span> spans_;
  std::vector<std::int32_t> first_low_, by_low_, first_high_, by_high_;  // links by their ends
  std::vector<Status::iterator> place_;
  Status status_;
  std::optional<std::string> conflict_;
  std::vector<std::int32_t> below_point_;
  std::vector<std::int32_t> below_query_;
};

}  // namespace driftmesh
