#include "decompose/planar_map.hpp"

#include "base/narrow.hpp"

namespace driftmesh {

MapVertexId PlanarMap::add_point(const Point& p, VertexOrigin what) {
  points.push_back(p);
  origin.push_back(what);
  return narrow<MapVertexId>(points.size() - 1, "number of points");
}

SideId PlanarMap::add_wall(MapVertexId a, MapVertexId b, const Wall& wall) {
  const auto h = narrow<SideId>(sides.size(), "number of segments");
  walls.push_back(wall);
  sides.push_back({a, kNone, kNone, 0});
  sides.push_back({b, kNone, kNone, 0});
  return h;
}

void PlanarMap::link(SideId first, SideId second) {
  side(first).next = second;
  side(second).previous = first;
}

SideId PlanarMap::split(SideId h, MapVertexId m) {
  const SideId back = twin(h);
  SideId rest = add_wall(m, end(h), wall(h));
  if (!is_first(h)) {  // keep the wall's direction: a region of its own on each side
    std::swap(side(rest).origin, side(twin(rest)).origin);
    rest = twin(rest);
  }
  const SideId rest_back = twin(rest);
  side(rest).region = side(h).region;
  side(rest_back).region = side(back).region;
  side(back).origin = m;
  const SideId after = side(h).next, before = side(back).previous;
  if (after == back) {  // a dangling end
    link(rest, rest_back);
  } else {
    if (after != kNone) link(rest, after);
    if (before != kNone) link(before, rest_back);
  }
  if (after != kNone) link(h, rest);
  if (before != kNone) link(rest_back, back);
  return rest;
}

SideId PlanarMap::connect(SideId u, SideId v, Kind kind) {
  const SideId h = add_wall(start(u), start(v), {0, kNone, kind});
  side(h).region = side(twin(h)).region = side(u).region;
  const SideId before_u = side(u).previous, before_v = side(v).previous;
  link(before_u, h);
  link(h, v);
  link(before_v, twin(h));
  link(twin(h), u);
  return h;
}

void PlanarMap::contract(SideId h) {
  const SideId back = twin(h);
  const MapVertexId kept = start(h), gone = end(h);
  for (SideId s = side(h).next; s != back; s = side(twin(s)).next) side(s).origin = kept;
  link(side(h).previous, side(h).next);
  link(side(back).previous, side(back).next);
  side(h) = side(back) = {gone, kNone, kNone, 0};
}

}  // namespace driftmesh
