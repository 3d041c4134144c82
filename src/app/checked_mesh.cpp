#include "app/checked_mesh.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

#include "app/mesh_input.hpp"
#include "gis/coordinates.hpp"
#include "job/memory.hpp"
#include "mesh/digest.hpp"
#include "mesh/settle_points.hpp"

namespace driftmesh::app {

CheckedMesh::CheckedMesh(const std::string& path, const ReadOptions& reading) {
  if (!is_saved_session(path) && is_in_pieces(path)) {
    files_.emplace(path, reading);
    return;
  }
  MeshInput input = read_to_check(path, reading);
  whole_ = std::move(input.mesh);
  session_ = std::move(input.session);
}

Box CheckedMesh::box() const {
  if (!files_) return Box::of(whole_.points);
  Box box;
  for (std::size_t k = 0; k < files_->size(); ++k) box.extend(Box::of(files_->read(k).points));
  return box;
}

std::string CheckedMesh::projection() const {
  const std::string text = files_ && files_->size() > 0 ? files_->read(0).coordinates : whole_.coordinates;
  return coordinates_from(text).value_or(Coordinates{}).projection;
}

void CheckedMesh::settle_on(std::vector<Point> places) {
  places_ = std::move(places);
  settle(whole_);
}

VerifyReport CheckedMesh::verify(const Pslg* input, const VerifyOptions& options) {
  if (files_) return verify_files(input, options);
  digest_ = mesh_digest(whole_);
  return input != nullptr ? driftmesh::verify(whole_, *input, options) : driftmesh::verify(whole_, options);
}

/// The digest of the whole mesh is the sum of those of the pieces.
VerifyReport CheckedMesh::verify_files(const Pslg* input, VerifyOptions options) {
  std::vector<std::uint64_t> digests(files_->size());
  const Pieces pieces{files_->size(), [&](std::size_t k, const Pieces::Show& show) {
                        Mesh piece = files_->read(k);
                        settle(piece);
                        digests[k] = mesh_digest(piece);
                        show(piece);
                      }};
  options.threads = std::min(options.threads, pieces_at_once());
  VerifyReport report = verify_pieces(pieces, input, options);
  digest_ = std::accumulate(digests.begin(), digests.end(), std::uint64_t{0});
  return report;
}

/// As many as fit into half of the free memory; each takes about three times its file.
std::size_t CheckedMesh::pieces_at_once() const {
  const std::uint64_t free = job::free_memory(), each = 3 * files_->most_bytes();
  return free == 0 || each == 0 ? 1 : std::max<std::uint64_t>(1, free / 2 / each);
}

void CheckedMesh::settle(Mesh& mesh) const {
  if (!mesh.coordinates.empty()) settle_points(mesh.points, places_, kRoundedPlaces);
}

}  // namespace driftmesh::app
