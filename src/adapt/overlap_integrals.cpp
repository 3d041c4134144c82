#include "adapt/overlap_integrals.hpp"

#include <utility>
#include <vector>

namespace driftmesh::adapt {
namespace {

/// The old triangles that do not stay, from each to one beside it, so that a search finds the next one near the last.
class Gone {
 public:
  explicit Gone(const Lineage::Change& change) : mesh_(change.old_mesh), is_left_(mesh_.triangles.size(), false) {
    for (const TriangleId t : ids_of(is_left_)) is_left_[t] = mesh_.triangles[t].alive();
    for (const TriangleId from : change.descent.same)
      if (from != kNone) is_left_[from] = false;
  }

  template <class Visit>
  void visit(const Visit& visit) {
    for (const TriangleId first : ids_of(is_left_)) {
      enter(first);
      while (!open_.empty()) {
        const TriangleId t = open_.back();
        open_.pop_back();
        visit(t);
        for (int i = 0; i < 3; ++i)
          if (const HalfEdge beyond = mesh_.across(half_edge(t, i)); beyond != kNone) enter(triangle_of(beyond));
      }
    }
  }

 private:
  void enter(TriangleId t) {
    if (is_left_[t]) open_.push_back(t);
    is_left_[t] = false;
  }

  const Triangulation& mesh_;
  IdVector<TriangleId, bool> is_left_;
  std::vector<TriangleId> open_;
};

}  // namespace

void visit_overlaps(const Lineage::Change& change, const std::function<void(const Overlaps&)>& visit) {
  if (change.is_the_same) return;
  OverlapSearch search(change.old_mesh, change.new_mesh);
  Overlaps overlaps;
  Gone(change).visit([&](TriangleId t) {
    search.find(t, overlaps);
    double area = 0;
    std::erase_if(overlaps.list, [&](const Overlap& o) { return change.stays(o.new_triangle); });
    for (const Overlap& o : overlaps.list) area += o.area;
    if (area > 0) overlaps.correction = area_of(change.old_mesh, t) / area;
    visit(overlaps);
  });
}

}  // namespace driftmesh::adapt
