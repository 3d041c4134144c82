#include "verify/piece_check.hpp"

#include <algorithm>
#include <deque>
#include <utility>
#include <vector>

#include "base/in_parts.hpp"
#include "driftmesh/id_vector.hpp"
#include "verify/corner_table.hpp"
#include "verify/local_check.hpp"
#include "verify/ring_check.hpp"

namespace driftmesh {
namespace {

class PieceCheck {
 public:
  PieceCheck(const NamedMesh& piece, const PieceOrder& order) : names_(piece), mesh_(piece.mesh()), order_(order) {
    report_.findings = Findings(order.max_listed);
  }

  PieceReport run() {
    count();
    if (!check_arrays(names_, report_.findings)) return std::move(report_);
    corners_.emplace(mesh_);
    check_coordinates(names_, *corners_, report_.findings);
    if (!report_.findings.empty()) return std::move(report_);
    report_.computable = true;
    check_triangles();
    mark_points();
    check_rings();
    report_.frame = frame_of(names_, *corners_, marks_, report_.parts ? &*report_.parts : nullptr);
    corners_.reset();
    take_inside();
    if (order_.bounds != nullptr) report_.measures = measure(names_, *order_.bounds, order_.threads);
    return std::move(report_);
  }

 private:
  void count() {
    report_.points = mesh_.points.size();
    report_.triangles = mesh_.triangles.size();
    report_.has_subsegments = !mesh_.edges.empty();
    std::vector<std::int32_t> subdomains = mesh_.subdomains;
    subdomains.erase(std::unique(subdomains.begin(), subdomains.end()), subdomains.end());
    report_.subdomains.insert(subdomains.begin(), subdomains.end());
  }

  void check_triangles() {
    std::vector<Findings> findings(order_.threads, Findings(order_.max_listed));
    in_parts(mesh_.triangles.size(), order_.threads, [&](std::size_t part, std::size_t begin, std::size_t end) {
      check_orientations(names_, begin, end, findings[part]);
    });
    for (const Findings& part : findings) report_.findings.append(part);
  }

  /// Those that have to do with more than the inside of the piece, as far as that does not show in their triangles.
  void mark_points() {
    marks_.assign(mesh_.points.size(), 0);
    for (const Mesh::Edge& edge : mesh_.edges) marks_[edge.a] = marks_[edge.b] = 1;
    if (order_.corners != nullptr)
      for (const std::int32_t v : points())
        if (order_.corners->find(mesh_.points[v]) != kNone) marks_[v] = 1;
    if (!order_.shared.empty())
      for (const std::int32_t v : points())
        if (std::ranges::binary_search(order_.shared, names_.number(v))) marks_[v] = 1;
    mark_repeated_numbers();
  }

  void mark_repeated_numbers() {
    NumberRuns numbers;
    for (const std::int32_t v : points()) numbers.add(names_.number(v));
    numbers.sort();
    const std::vector<std::int64_t> repeated = numbers.repeated();
    if (repeated.empty()) return;
    for (const std::int32_t v : points())
      if (std::ranges::binary_search(repeated, names_.number(v))) marks_[v] = 1;
  }

  /// Joining triangles is not for several threads.
  void check_rings() {
    if (order_.parts) report_.parts.emplace(mesh_.triangles.size());
    const std::size_t threads = order_.parts ? 1 : order_.threads;
    std::deque<RingCheck> checks;
    for (std::size_t part = 0; part < threads; ++part)
      checks.emplace_back(names_, *corners_, marks_, order_.delaunay, order_.max_listed);
    in_parts(mesh_.points.size(), threads, [&](std::size_t part, std::size_t begin, std::size_t end) {
      checks[part].check(begin, end, report_.parts ? &*report_.parts : nullptr);
    });
    for (const RingCheck& check : checks) {
      report_.findings.append(check.edges().findings());
      report_.interfaces.add(check.edges().interfaces());
    }
  }

  void take_inside() {
    for (const std::int32_t v : points()) {
      if (marks_[v] != 0) continue;
      ++report_.used_inside;
      report_.inside.add(names_.number(v));
    }
  }

  [[nodiscard]] IdRange<std::int32_t> points() const { return first_ids<std::int32_t>(mesh_.points.size()); }

  NamedMesh names_;
  const Mesh& mesh_;
  const PieceOrder& order_;
  PieceReport report_;
  std::optional<CornerTable> corners_;
  std::vector<char> marks_;  // points left to the check of the frame
};

}  // namespace

PieceReport check_piece(const NamedMesh& piece, const PieceOrder& order) {
  return PieceCheck(piece, order).run();
}

}  // namespace driftmesh
