#include "verify/findings.hpp"

namespace driftmesh {

const char* flaw_name(Flaw flaw) {
  switch (flaw) {
    case Flaw::bad_array:
      return "bad array";
    case Flaw::bad_index:
      return "bad index";
    case Flaw::bad_coordinate:
      return "bad coordinate";
    case Flaw::duplicate_point:
      return "duplicate point";
    case Flaw::pieces_disagree:
      return "pieces disagree";
    case Flaw::not_counterclockwise:
      return "not counterclockwise";
    case Flaw::duplicate_triangle:
      return "duplicate triangle";
    case Flaw::edge_used_twice:
      return "edge used twice";
    case Flaw::open_edge:
      return "open edge";
    case Flaw::tangled_vertex:
      return "tangled vertex";
    case Flaw::stray_subsegment:
      return "stray subsegment";
    case Flaw::duplicate_subsegment:
      return "duplicate subsegment";
    case Flaw::boundary_crosses:
      return "boundary crosses itself";
    case Flaw::overlap:
      return "overlap";
    case Flaw::not_delaunay:
      return "not Delaunay";
    case Flaw::input_not_planar:
      return "input not planar";
    case Flaw::point_missing:
      return "input point missing";
    case Flaw::segment_missing:
      return "input segment missing";
    case Flaw::unknown_subsegment:
      return "unknown subsegment";
    case Flaw::off_segment:
      return "off its segment";
    case Flaw::wrong_marker:
      return "wrong marker";
    case Flaw::not_covered:
      return "domain not covered";
    case Flaw::outside_filled:
      return "outside filled";
    case Flaw::hole_filled:
      return "hole filled";
    case Flaw::wrong_polygons:
      return "not what the polygons say";
    case Flaw::wrong_area:
      return "wrong area";
    case Flaw::wrong_euler:
      return "wrong Euler number";
    case Flaw::wrong_region:
      return "wrong region";
    case Flaw::wrong_point_marker:
      return "wrong point marker";
    case Flaw::wrong_attribute:
      return "wrong attribute";
    case Flaw::small_angle:
      return "small angle";
    case Flaw::large_area:
      return "large area";
  }
  return "unknown flaw";
}

void Findings::append(const Findings& later) {
  for (std::size_t k = 0; k < kFlawCount; ++k) {
    Kind& kind = kinds_[static_cast<Flaw>(k)];
    const Kind& other = later.kinds_[static_cast<Flaw>(k)];
    kind.count += other.count;
    for (const std::string& message : other.messages)
      if (kind.messages.size() < listed_per_kind_) kind.messages.push_back(message);
  }
}

std::uint64_t Findings::total() const {
  std::uint64_t sum = 0;
  for (const Kind& kind : kinds_) sum += kind.count;
  return sum;
}

}  // namespace driftmesh
