#pragma once

#include "base/scratch_file.hpp"
#include "migration/dormant_mesh.hpp"

namespace driftmesh {

/// The bulk of a dormant mesh in a scratch file.
class StoredBulk {
 public:
  /// `file` must outlive the object.
  StoredBulk(ScratchFile& file, const DormantMesh::Bulk& bulk)
      : points_(bulk.free.size()),
        piece_(file.put({std::as_bytes(std::span(bulk.free)), std::as_bytes(std::span(bulk.code))})) {}

  [[nodiscard]] DormantMesh::Bulk read() const {
    const std::size_t bytes_of_points = points_ * sizeof(Point);
    DormantMesh::Bulk bulk{std::vector<Point>(points_), Bytes(piece_.bytes() - bytes_of_points)};
    piece_.read(0, std::as_writable_bytes(std::span(bulk.free)));
    piece_.read(bytes_of_points, std::as_writable_bytes(std::span(bulk.code)));
    return bulk;
  }

 private:
  std::size_t points_;
  ScratchFile::Piece piece_;
};

}  // namespace driftmesh
