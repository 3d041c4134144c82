#include "verify/frame.hpp"

#include <algorithm>
#include <utility>

#include "driftmesh/id_vector.hpp"

namespace driftmesh {
namespace {

/// Collects the parts of a piece that belong to its frame.
class FrameMaker {
 public:
  FrameMaker(const NamedMesh& piece, const CornerTable& corners, const std::vector<char>& marks)
      : piece_(piece), from_(piece.mesh()), corners_(corners), marks_(marks), index_(from_.points.size(), kNone) {}

  Frame make(DisjointSets<std::int32_t>* parts) {
    const std::vector<std::int32_t> triangles = triangles_at_marks();
    take_points(triangles);
    take_triangles(triangles);
    for (const Mesh::Edge& edge : from_.edges) to_.edges.push_back({index_[edge.a], index_[edge.b], edge.marker});
    if (parts != nullptr)
      for (const std::int32_t t : triangles) frame_.parts.push_back(parts->find(t));
    return std::move(frame_);
  }

 private:
  [[nodiscard]] std::vector<std::int32_t> triangles_at_marks() const {
    std::vector<std::int32_t> triangles;
    for (const std::int32_t v : first_ids<std::int32_t>(marks_.size()))
      if (marks_[v] != 0)
        for (const std::uint32_t corner : corners_.around(v))
          triangles.push_back(static_cast<std::int32_t>(corner / 3));
    std::ranges::sort(triangles);
    triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
    return triangles;
  }

  void take_points(const std::vector<std::int32_t>& triangles) {
    constexpr std::int32_t kTaken = 0;
    for (const std::int32_t v : first_ids<std::int32_t>(marks_.size()))
      if (marks_[v] != 0) index_[v] = kTaken;
    for (const std::int32_t t : triangles)
      for (const std::int32_t v : from_.triangles[t]) index_[v] = kTaken;
    to_.attributes_per_point = from_.attributes_per_point;
    for (const std::int32_t v : first_ids<std::int32_t>(index_.size()))
      if (index_[v] == kTaken) take_point(v);
  }

  void take_point(std::int32_t v) {
    index_[v] = static_cast<std::int32_t>(to_.points.size());
    to_.points.push_back(from_.points[v]);
    to_.numbers.push_back(piece_.number(v));
    frame_.marks.push_back(marks_[v]);
    if (!from_.point_markers.empty()) to_.point_markers.push_back(from_.point_markers[v]);
    const std::size_t width = from_.attributes_per_point;
    for (std::size_t i = 0; i < width; ++i) to_.attributes.push_back(from_.attributes[to_index(v) * width + i]);
  }

  void take_triangles(const std::vector<std::int32_t>& triangles) {
    for (const std::int32_t t : triangles) {
      const auto& [a, b, c] = from_.triangles[t];
      to_.triangles.push_back({index_[a], index_[b], index_[c]});
      frame_.places.push_back(piece_.place(t));
      if (!from_.subdomains.empty()) to_.subdomains.push_back(from_.subdomains[t]);
      if (!from_.ranks.empty()) to_.ranks.push_back(from_.ranks[t]);
    }
  }

  const NamedMesh& piece_;
  const Mesh& from_;
  const CornerTable& corners_;
  const std::vector<char>& marks_;
  std::vector<std::int32_t> index_;  // points in the frame
  Frame frame_;
  Mesh& to_ = frame_.mesh;
};

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

std::vector<std::int32_t> Frame::marked() const {
  std::vector<std::int32_t> points;
  for (const std::int32_t v : first_ids<std::int32_t>(marks.size()))
    if (marks[v] != 0) points.push_back(v);
  return points;
}

Frame frame_of(const NamedMesh& piece, const CornerTable& corners, const std::vector<char>& marks,
               DisjointSets<std::int32_t>* parts) {
  return FrameMaker(piece, corners, marks).make(parts);
}

// Without subdomains, triangles stay in the order of the pieces.
Frame join_frames(std::span<Frame> frames, MergeFaults& faults) {
  Frame whole;
  std::vector<std::int32_t> subdomains, ranks;
  std::vector<const Mesh*> meshes;
  for (Frame& frame : frames) {
    append(subdomains, std::exchange(frame.mesh.subdomains, {}));
    append(ranks, std::exchange(frame.mesh.ranks, {}));
    append(whole.places, std::exchange(frame.places, {}));
    append(whole.parts, std::exchange(frame.parts, {}));
    meshes.push_back(&frame.mesh);
  }
  whole.mesh = merge_pieces(meshes, faults, Numbering::kSparse);
  const std::size_t count = whole.mesh.triangles.size();
  if (subdomains.size() == count) whole.mesh.subdomains = std::move(subdomains);
  if (ranks.size() == count) whole.mesh.ranks = std::move(ranks);
  whole.marks.resize(whole.mesh.points.size());
  for (const Frame& frame : frames)
    for (std::size_t v = 0; v < frame.marks.size(); ++v)
      if (frame.marks[v] != 0)
        whole.marks[std::ranges::lower_bound(whole.mesh.numbers, frame.mesh.numbers[v]) - whole.mesh.numbers.begin()] =
            1;
  return whole;
}

}  // namespace driftmesh
