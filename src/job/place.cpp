#include "job/place.hpp"

#include "driftmesh/error.hpp"

namespace driftmesh::job {
namespace {

constexpr const char* kNoMesh = "this place keeps no mesh; make it in this process or on ranks";

}  // namespace

void Refined::write(const Request::Output& /*files*/, const Draw& /*draw*/, Watch& /*watch*/) {
  throw Error(kNoMesh);
}

void Refined::save(const Request& /*request*/, Watch& /*watch*/) {
  throw Error(kNoMesh);
}

DistributedPiece Refined::take_piece(Watch& /*watch*/) {
  throw Error(kNoMesh);
}

LiveMesh Refined::take_live(const Request& /*request*/) {
  throw Error(kNoMesh);
}

}  // namespace driftmesh::job
