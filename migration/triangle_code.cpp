#include "migration/triangle_code.hpp"

#include "driftmesh/error.hpp"

namespace driftmesh {

using namespace triangle_code;

BorderGuess::BorderGuess(std::size_t vertices, std::span<const BorderEdge> border)
    : after_(vertices, kNone), before_(vertices, kNone) {
  for (const auto [a, b] : border) {
    after_[a] = b;
    before_[b] = a;
  }
}

void BorderGuess::cover(VertexId a, VertexId b, VertexId v) {
  const bool closes_left = before(a) == v, closes_right = after(b) == v;
  if (!closes_left) {
    after_[a] = v;
    before_[v] = a;
  }
  if (!closes_right) {
    after_[v] = b;
    before_[b] = v;
  }
}

namespace {

class Encoder {
 public:
  Encoder(const Triangulation& mesh, IdVector<VertexId, VertexId>& number, std::int32_t fixed,
          std::span<const BorderEdge> border)
      : mesh_(mesh), number_(number), guess_(mesh.live_vertices(), border), visited_(mesh.triangles.size(), false) {
    coded_.fixed = coded_.vertices = fixed;
  }

  /// The walk over all triangles reachable from that of `entrance`, a half-edge on the domain's border.
  void walk_from(HalfEdge entrance) {
    if (visited_[triangle_of(entrance)]) return;
    out_.varint(to_index(number_of(mesh_.edge_start(entrance))));
    out_.varint(to_index(number_of(mesh_.edge_end(entrance))));
    enter(entrance);
    while (!ways_.empty()) {
      const Way way = ways_.back();
      ways_.pop_back();
      const HalfEdge g = mesh_.across(way.through);
      if (g == kNone || visited_[triangle_of(g)]) continue;
      out_.bytes()[way.place] |= static_cast<std::byte>(way.bit);
      enter(g);
    }
  }

  [[nodiscard]] CodedTriangles take() {
    coded_.code = out_.take();
    return std::move(coded_);
  }
  [[nodiscard]] std::int32_t triangles() const { return coded_.triangles; }

 private:
  /// An edge through which the walk may continue; whether it does is recorded in the code of the triangle it leaves.
  struct Way {
    HalfEdge through;
    std::size_t place;
    std::uint8_t bit;
  };

  [[nodiscard]] VertexId number_of(VertexId v) const { return number_[v]; }

  void enter(HalfEdge g) {
    const TriangleId t = triangle_of(g);
    visited_[t] = true;
    ++coded_.triangles;
    const std::size_t place = out_.bytes().size();
    put_corner(number_of(mesh_.edge_start(g)), number_of(mesh_.edge_end(g)), mesh_.apex(g));
    put_region(t, place);
    ways_.push_back({half_edge(t, previous(index_of(g))), place, kGoesLeft});
    ways_.push_back({half_edge(t, next(index_of(g))), place, kGoesRight});
  }

  void put_corner(VertexId a, VertexId b, VertexId apex) {
    VertexId& v = number_[apex];
    const Corner corner = v == kNone ? kNew : v == guess_.after(b) ? kAfter : v == guess_.before(a) ? kBefore : kNamed;
    out_.number(corner);
    if (corner == kNew) v = VertexId{coded_.vertices++};
    if (corner == kNamed) out_.varint(to_index(v));
    guess_.cover(a, b, v);
  }

  void put_region(TriangleId t, std::size_t place) {
    if (mesh_.region.empty() || mesh_.region[t] == region_) return;
    region_ = mesh_.region[t];
    out_.bytes()[place] |= static_cast<std::byte>(kNewRegion);
    out_.varint(region_);
  }

  const Triangulation& mesh_;
  IdVector<VertexId, VertexId>& number_;
  BorderGuess guess_;
  IdVector<TriangleId, bool> visited_;
  CodedTriangles coded_;
  ByteWriter out_;
  std::vector<Way> ways_;
  std::uint16_t region_ = 0;
};

}  // namespace

CodedTriangles encode_triangles(const Triangulation& mesh, IdVector<VertexId, VertexId>& number, std::int32_t fixed,
                                std::span<const BorderEdge> border, std::span<const HalfEdge> entrances) {
  Encoder encoder(mesh, number, fixed, border);
  for (const HalfEdge entrance : entrances) encoder.walk_from(entrance);
  if (to_index(encoder.triangles()) != mesh.live_triangles())
    throw Error("some triangles of a mesh cannot be reached from its border");
  return encoder.take();
}

}  // namespace driftmesh
