#include "migration/dormant_mesh.hpp"

#include <algorithm>
#include <utility>

#include "base/narrow.hpp"
#include "driftmesh/error.hpp"
#include "geometry/midpoint.hpp"
#include "mesh/link_triangles.hpp"

namespace driftmesh {
namespace {

bool is_given(VertexOrigin o) {
  return o != kFree && o != kDeleted && !is_midpoint(o);
}

// ---- Bits ----

class BitWriter {
 public:
  explicit BitWriter(std::vector<std::byte>& bytes) : bytes_(bytes) {}
  void put(bool bit) {
    if (used_ % 8 == 0) bytes_.push_back(std::byte{0});
    if (bit) bytes_.back() |= std::byte{1} << (used_ % 8);
    ++used_;
  }

 private:
  std::vector<std::byte>& bytes_;
  std::size_t used_ = 0;
};

class BitReader {
 public:
  explicit BitReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  [[nodiscard]] bool get() {
    if (used_ / 8 >= bytes_.size()) throw Error("the trees of subsegments end too early");
    const bool bit = (bytes_[used_ / 8] >> (used_ % 8) & std::byte{1}) != std::byte{0};
    ++used_;
    return bit;
  }
  /// Skips `trees` whole trees.
  void skip(std::size_t trees) {
    while (trees > 0) get() ? ++trees : --trees;
  }
  [[nodiscard]] bool at_end() const { return (used_ + 7) / 8 == bytes_.size(); }

 private:
  std::span<const std::byte> bytes_;
  std::size_t used_ = 0;
};

// ---- Trees, parents first ----

/// Calls visit(subsegment) for the tree below s, parents first.
template <class Visit>
void visit_tree(const Triangulation& mesh, SubsegmentId s, Visit&& visit) {
  visit(s);
  const SubsegmentId child = mesh.subsegments[s].child;
  if (child == kNone) return;
  visit_tree(mesh, child, visit);
  visit_tree(mesh, after(child), visit);
}

/// Splits leaf s according to the bits.
void grow_tree(Triangulation& mesh, SubsegmentId s, BitReader& bits) {
  if (!bits.get()) return;
  if (dyadic::depth(mesh.subsegments[s].path) >= dyadic::kMaxDepth) throw Error("a subsegment is cut too deep");
  const auto [a, b] = mesh.subsegments[s].vertex;
  const SubsegmentId child = mesh.halve(s, mesh.add_vertex(midpoint(mesh.points[a], mesh.points[b]), midpoint_of(s)));
  grow_tree(mesh, child, bits);
  grow_tree(mesh, after(child), bits);
}

std::uint8_t sides_of(const Triangulation& mesh, SubsegmentId s) {
  while (!mesh.subsegments[s].is_leaf()) s = mesh.subsegments[s].child;
  const auto& half = mesh.subsegments[s].half;
  return static_cast<std::uint8_t>((half[0] != kNone ? 1 : 0) | (half[1] != kNone ? 2 : 0));
}

// ---- Names: each number as the difference from one that it tends to follow ----

[[nodiscard]] Bytes names_of(const SubdomainMesh& part, const IdVector<VertexId, VertexId>& number, std::size_t given) {
  const Triangulation& mesh = part.mesh;
  ByteWriter out;
  std::int64_t last = 0;
  out.varint(given);
  for (const VertexOrigin o : mesh.origin)
    if (is_given(o)) out.signed_varint(o - std::exchange(last, o));
  out.varint(part.points.size());
  last = 0;
  for (const GlobalPointId p : part.points) out.signed_varint(to_int(p) - std::exchange(last, to_int(p)));
  out.varint(mesh.roots.size());
  std::int64_t last_end = 0, last_shell = 0, last_root = 0;
  for (const RootId r : ids_of(part.roots)) {
    const RootSegment& root = mesh.roots[r];
    const std::int64_t a = to_int(number[root.vertex[0]]), b = to_int(number[root.vertex[1]]);
    out.signed_varint(a - last_end);
    out.signed_varint(b - a);
    out.signed_varint(root.marker);
    out.signed_varint(root.shell - std::exchange(last_shell, root.shell));
    out.signed_varint(to_int(part.roots[r]) - std::exchange(last_root, to_int(part.roots[r])));
    out.varint(sides_of(mesh, root.tree));
    last_end = b;
  }
  return out.take();
}

/// A number that is at most `most`, for allocation.
std::size_t count_of(ByteReader& in, std::size_t most) {
  const std::uint64_t n = in.varint();
  if (n > most) throw Error("a list of names is longer than its bytes");
  return n;
}

std::int32_t follow(ByteReader& in, std::int64_t last) {
  const std::int64_t step = in.signed_varint();
  if (step > INT64_C(1) << 33 || step < -(INT64_C(1) << 33)) throw Error("a name is out of range");
  return narrow<std::int32_t>(last + step, "a name");
}

}  // namespace

DormantMesh::DormantMesh(const SubdomainMesh& part) {
  const Triangulation& mesh = part.mesh;
  IdVector<VertexId, VertexId> number(mesh.points.size(), kNone);
  std::int32_t fixed = 0;
  for (const VertexId v : ids_of(number))
    if (is_given(mesh.origin[v])) {
      number[v] = VertexId{fixed++};
      given_.push_back(mesh.points[v]);
    }
  names_ = names_of(part, number, given_.size());
  BitWriter bits(trees_);
  std::vector<HalfEdge> entrances;
  for (const RootSegment& root : mesh.roots)
    visit_tree(mesh, root.tree, [&](SubsegmentId s) {
      const Subsegment& segment = mesh.subsegments[s];
      bits.put(!segment.is_leaf());
      if (!segment.is_leaf())
        number[mesh.subsegments[segment.child].vertex[1]] = VertexId{fixed++};
      else if ((segment.half[0] == kNone) != (segment.half[1] == kNone))
        entrances.push_back(segment.half[0] == kNone ? segment.half[1] : segment.half[0]);
    });
  triangles_ = encode_triangles(mesh, number, fixed, border(), entrances);
  has_regions_ = mesh.region.empty() ? 0 : 1;
  free_.resize(to_index(triangles_.vertices - fixed));
  for (const VertexId v : ids_of(number))
    if (to_int(number[v]) >= fixed) free_[to_index(number[v]) - to_index(fixed)] = mesh.points[v];
  for (auto* list : {&names_, &trees_, &triangles_.code}) list->shrink_to_fit();
  given_.shrink_to_fit();
}

std::size_t DormantMesh::bytes() const {
  return sizeof *this + names_.capacity() + trees_.capacity() + triangles_.code.capacity() +
         (given_.capacity() + free_.capacity()) * sizeof(Point);
}

void DormantMesh::give(Bulk bulk) {
  free_ = std::move(bulk.free);
  triangles_.code = std::move(bulk.code);
}

bool DormantMesh::holds(RootId root, dyadic::Path path) const {
  BitReader bits(trees_);
  bits.skip(to_index(root));
  for (dyadic::Path node = dyadic::kWhole; bits.get();) {
    if (node == path) return true;
    const bool second = dyadic::descends_second(node, path);
    if (second) bits.skip(1);
    node = second ? dyadic::second_half(node) : dyadic::first_half(node);
  }
  return false;
}

DormantMesh::Frame DormantMesh::frame() const {
  Frame frame;
  SubdomainMesh& part = frame.part;
  Triangulation& mesh = part.mesh;
  ByteReader in(names_);
  if (count_of(in, names_.size()) != given_.size()) throw Error("given vertices without coordinates");
  std::int32_t last = 0;
  for (const Point& p : given_) {
    last = follow(in, last);
    if (!is_given(last)) throw Error("a given vertex is none");
    mesh.add_vertex(p, last);
  }
  last = 0;
  for (std::size_t n = count_of(in, names_.size()); n > 0; --n)
    part.points.push_back(GlobalPointId{last = follow(in, last)});
  std::int32_t last_end = 0, last_shell = 0, last_root = 0;
  for (std::size_t n = count_of(in, names_.size()); n > 0; --n) {
    const std::int32_t a = follow(in, last_end), b = follow(in, a);
    const std::int32_t marker = follow(in, 0);
    last_shell = follow(in, last_shell);
    last_root = follow(in, last_root);
    last_end = b;
    const std::uint64_t sides = in.varint();
    const auto exists = [&](std::int32_t v) { return to_index(v) < given_.size(); };
    if (!exists(a) || !exists(b) || sides > 3) throw Error("a root has no ends");
    mesh.add_root(VertexId{a}, VertexId{b}, marker, last_shell);
    part.roots.push_back(GlobalRootId{last_root});
    frame.sides.push_back(static_cast<std::uint8_t>(sides));
  }
  if (!in.at_end()) throw Error("there are more names than there should be");
  BitReader bits(trees_);
  for (const RootSegment& root : mesh.roots) grow_tree(mesh, root.tree, bits);
  if (!bits.at_end()) throw Error("there are more trees than roots");
  return frame;
}

std::vector<BorderEdge> DormantMesh::border_of(const Frame& frame) {
  std::vector<BorderEdge> border;
  for (const Subsegment& s : frame.part.mesh.subsegments) {
    const std::uint8_t sides = frame.sides[s.root];
    if (!s.is_leaf()) continue;
    if (sides == 1) border.push_back({s.vertex[0], s.vertex[1]});
    if (sides == 2) border.push_back({s.vertex[1], s.vertex[0]});
  }
  return border;
}

std::vector<Point> DormantMesh::points() const {
  const Frame frame = this->frame();
  std::vector<Point> points(frame.part.mesh.points.begin(), frame.part.mesh.points.end());
  points.insert(points.end(), free_.begin(), free_.end());
  return points;
}

void DormantMesh::check() const {
  check_counts(frame());
  visit_triangles([](const auto&, std::uint16_t) {});
}

void DormantMesh::check_counts(const Frame& frame) const {
  const std::size_t fixed = frame.part.mesh.points.size();
  if (fixed != to_index(triangles_.fixed) || fixed + free_.size() != to_index(triangles_.vertices))
    throw Error("vertices and coordinates differ in number");
}

SubdomainMesh DormantMesh::wake() const {
  Frame frame = this->frame();
  check_counts(frame);
  Triangulation& mesh = frame.part.mesh;
  const std::vector<BorderEdge> border = border_of(frame);
  for (const Point& p : free_) mesh.add_vertex(p, kFree);
  decode_triangles(triangles_, border, [&](const std::array<VertexId, 3>& corners, std::uint16_t region) {
    mesh.triangles.push_back({corners, {kNone, kNone, kNone}});
    if (has_regions_ != 0) mesh.region.push_back(region);
  });
  link_triangles(mesh);
  return std::move(frame.part);
}

IdVector<SubsegmentId, SubsegmentId> DormantMesh::waking_subsegments(const Triangulation& mesh) {
  IdVector<SubsegmentId, SubsegmentId> waking(mesh.subsegments.size(), kNone);
  auto next = static_cast<SubsegmentId>(mesh.roots.size());  // roots come first, then pairs of halves
  for (const RootId r : ids_of(mesh.roots)) {
    waking[mesh.roots[r].tree] = SubsegmentId{to_int(r)};
    visit_tree(mesh, mesh.roots[r].tree, [&](SubsegmentId s) {
      const SubsegmentId child = mesh.subsegments[s].child;
      if (child == kNone) return;
      waking[child] = next;
      waking[after(child)] = after(next);
      next = after(after(next));
    });
  }
  return waking;
}

}  // namespace driftmesh
