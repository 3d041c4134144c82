#include "decompose/decomposition_file.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/atomic_file.hpp"
#include "base/line_writer.hpp"
#include "base/read_file.hpp"
#include "decompose/check_decomposition.hpp"
#include "decompose/same_input.hpp"
#include "driftmesh/error.hpp"
#include "pslg/record_scanner.hpp"

namespace driftmesh {
namespace {

constexpr std::string_view kFirstLine = "# driftmesh decomposition 2\n";
constexpr std::int32_t kMostRecords = std::numeric_limits<std::int32_t>::max() / 4;

class Parser {
 public:
  Parser(const std::string& file, std::string_view text, const Pslg& input)
      : file_(file), in_(file, text), input_(input) {
    if (!text.starts_with(kFirstLine))
      throw InputError({file, 1}, "this is not a decomposition of version 2",
                       "its first line must be '# driftmesh decomposition 2'; driftmesh decompose writes such files");
  }

  Decomposition parse() {
    read_counts();
    read_points();
    read_roots();
    read_subdomains();
    read_inner_points();
    in_.require_end();
    in_.throw_problems();
    list_roots(d_);
    check();
    require_same_input(d_, input_, file_);
    return std::move(d_);
  }

 private:
  void read_counts() {
    in_.require_record("the number of points, roots, subdomains and inner points, and a digest",
                       "the file may be truncated");
    points_ = in_.header("number of points", kMostRecords);
    roots_ = in_.header("number of roots", kMostRecords);
    subdomains_ = in_.header("number of subdomains", kMostRecords);
    inner_points_ = in_.header("number of inner points", kMostRecords);
    if (in_.header("digest of the input") != input_digest(input_)) refuse_as_another(file_, "");
    in_.require_room(points_, "points", 3);
    in_.require_room(roots_, "roots", 9);
    in_.require_room(subdomains_, "subdomains", 5);
    if (subdomains_ == 0) in_.fail("there are no subdomains", "a decomposition has at least one");
  }

  /// An integer in [low, high].
  std::int32_t integer(const char* what, std::int32_t low, std::int32_t high) {
    const std::int32_t value = in_.integer(what);
    if (in_.broken() || (value >= low && value <= high)) return value;
    in_.problem(std::string(what) + " is " + std::to_string(value),
                "expected " + std::to_string(low) + " to " + std::to_string(high));
    return low;
  }

  void read_points() {
    d_.points.reserve(to_index(points_));
    for (std::int32_t i = 0; i < points_; ++i) {
      in_.require_element(i, points_, "points");
      const double x = in_.number("x"), y = in_.number("y");
      d_.points.push_back({x, y});
      d_.origin.push_back(integer("origin", kNone, kFrame - 1));
    }
  }

  void read_roots() {
    d_.roots.reserve(to_index(roots_));
    for (std::int32_t i = 0; i < roots_; ++i) {
      in_.require_element(i, roots_, "roots");
      Decomposition::Root r;
      r.a = GlobalPointId{integer("first point of a root", 0, points_ - 1)};
      r.b = GlobalPointId{integer("second point of a root", 0, points_ - 1)};
      r.marker = in_.integer("marker of a root");
      r.shell = integer("shell of a root", kNone, kMostRecords);
      r.left = SubdomainId{integer("subdomain left of a root", to_int(kNoSubdomain), subdomains_ - 1)};
      r.right = SubdomainId{integer("subdomain right of a root", to_int(kNoSubdomain), subdomains_ - 1)};
      r.left_region = static_cast<std::uint16_t>(integer("region left of a root", 0, kMostRegion));
      r.right_region = static_cast<std::uint16_t>(integer("region right of a root", 0, kMostRegion));
      r.separator = integer("kind of a root", 0, 1) == 1;
      d_.roots.push_back(r);
    }
  }

  void read_subdomains() {
    for (std::int32_t i = 0; i < subdomains_; ++i) {
      in_.require_element(i, subdomains_, "subdomains");
      Decomposition::Subdomain s;
      s.area = in_.number("area of a subdomain");
      s.predicted = in_.number("work of a subdomain");
      s.centroid.x = in_.number("x of a subdomain's centroid");
      s.centroid.y = in_.number("y of a subdomain's centroid");
      s.region = static_cast<std::uint16_t>(integer("region of a subdomain", 0, kMostRegion));
      if (!(s.predicted > 0)) in_.problem("the work of a subdomain is not above 0", "correct it");
      d_.subdomains.push_back(s);
    }
  }

  void read_inner_points() {
    std::vector<std::pair<SubdomainId, GlobalPointId>> inner;
    for (std::int32_t i = 0; i < inner_points_; ++i) {
      in_.require_element(i, inner_points_, "inner points");
      const SubdomainId subdomain{integer("subdomain of an inner point", 0, subdomains_ - 1)};
      const GlobalPointId point{integer("inner point", 0, points_ - 1)};
      if (!inner.empty() && std::pair(subdomain, point) <= inner.back())
        in_.problem("inner points are not in ascending order", "sort them by subdomain and number");
      inner.emplace_back(subdomain, point);
    }
    list_inner_points(d_, std::move(inner));
  }

  void check() const {
    const DecompositionReport report = check_decomposition(d_);
    if (report.valid()) return;
    throw InputError({file_, 0}, "the decomposition is broken: " + report.problems[0],
                     "make it again with driftmesh decompose");
  }

  static constexpr std::int32_t kMostRegion = std::numeric_limits<std::uint16_t>::max();
  std::string file_;
  RecordScanner in_;
  const Pslg& input_;
  Decomposition d_;
  std::int32_t points_ = 0, roots_ = 0, subdomains_ = 0, inner_points_ = 0;
};

}  // namespace

void write_decomposition(const Decomposition& d, const Pslg& input, const std::string& path) {
  AtomicFile file(path);
  file.write(kFirstLine);
  file.write("# points, roots, subdomains, inner points, digest of the input\n");
  LineWriter line(file);
  line.field(d.points.size()).field(d.roots.size()).field(d.size()).field(d.point_list.size());
  line.field(input_digest(input)).end();
  file.write("# points: x y origin\n");
  for (const GlobalPointId v : ids_of(d.points))
    line.field(d.points[v].x).field(d.points[v].y).field(d.origin[v]).end();
  file.write("# roots: a b marker shell left right left-region right-region separator\n");
  for (const Decomposition::Root& r : d.roots) {
    line.field(to_int(r.a)).field(to_int(r.b)).field(r.marker).field(r.shell);
    line.field(to_int(r.left)).field(to_int(r.right));
    line.field(r.left_region).field(r.right_region).field(r.separator ? 1 : 0).end();
  }
  file.write("# subdomains: area work x y region\n");
  for (const Decomposition::Subdomain& s : d.subdomains)
    line.field(s.area).field(s.predicted).field(s.centroid.x).field(s.centroid.y).field(s.region).end();
  file.write("# inner points: subdomain point\n");
  for (const SubdomainId i : ids_of(d.subdomains))
    for (const GlobalPointId v : d.inner_points_of(i)) line.field(to_int(i)).field(to_int(v)).end();
  file.commit();
}

Decomposition parse_decomposition(const std::string& file, std::string_view text, const Pslg& input) {
  return Parser(file, text, input).parse();
}

Decomposition read_decomposition(const std::string& path, const Pslg& input) {
  return parse_decomposition(path, read_file(path), input);
}

}  // namespace driftmesh
