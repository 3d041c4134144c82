#include "verify/findings.hpp"

namespace driftmesh {

const char* flaw_name(Flaw flaw) {
  switch (flaw) {
    case Flaw::kBadArray:
      return "bad array";
    case Flaw::kBadIndex:
      return "bad index";
    case Flaw::kBadCoordinate:
      return "bad coordinate";
    case Flaw::kDuplicatePoint:
      return "duplicate point";
    case Flaw::kPiecesDisagree:
      return "pieces disagree";
    case Flaw::kNotCounterclockwise:
      return "not counterclockwise";
    case Flaw::kDuplicateTriangle:
      return "duplicate triangle";
    case Flaw::kEdgeUsedTwice:
      return "edge used twice";
    case Flaw::kOpenEdge:
      return "open edge";
    case Flaw::kTangledVertex:
      return "tangled vertex";
    case Flaw::kStraySubsegment:
      return "stray subsegment";
    case Flaw::kDuplicateSubsegment:
      return "duplicate subsegment";
    case Flaw::kBoundaryCrosses:
      return "boundary crosses itself";
    case Flaw::kOverlap:
      return "overlap";
    case Flaw::kNotDelaunay:
      return "not Delaunay";
    case Flaw::kInputNotPlanar:
      return "input not planar";
    case Flaw::kPointMissing:
      return "input point missing";
    case Flaw::kSegmentMissing:
      return "input segment missing";
    case Flaw::kUnknownSubsegment:
      return "unknown subsegment";
    case Flaw::kOffSegment:
      return "off its segment";
    case Flaw::kWrongMarker:
      return "wrong marker";
    case Flaw::kNotCovered:
      return "domain not covered";
    case Flaw::kOutsideFilled:
      return "outside filled";
    case Flaw::kHoleFilled:
      return "hole filled";
    case Flaw::kWrongPolygons:
      return "not what the polygons say";
    case Flaw::kWrongArea:
      return "wrong area";
    case Flaw::kWrongEuler:
      return "wrong Euler number";
    case Flaw::kWrongRegion:
      return "wrong region";
    case Flaw::kWrongPointMarker:
      return "wrong point marker";
    case Flaw::kWrongAttribute:
      return "wrong attribute";
    case Flaw::kSmallAngle:
      return "small angle";
    case Flaw::kLargeArea:
      return "large area";
    case Flaw::kTimeStep:
      return "large Courant number";
    case Flaw::kFewAcross:
      return "few triangles across a channel";
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
