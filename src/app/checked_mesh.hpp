#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "adapt/saved.hpp"
#include "driftmesh/files.hpp"
#include "driftmesh/mesh.hpp"
#include "driftmesh/pslg.hpp"
#include "geometry/box.hpp"
#include "io/mesh_file.hpp"
#include "verify/verify.hpp"

namespace driftmesh::app {

/// The mesh to check, in one piece or in several that are read one by one. Errors: as read_mesh.
class CheckedMesh {
 public:
  CheckedMesh(const std::string& path, const ReadOptions& reading);

  /// What a saved adaptive mesh has besides; null: it is none.
  [[nodiscard]] const adapt::SavedHead* session() const { return session_ ? &*session_ : nullptr; }

  [[nodiscard]] Box box() const;

  /// What the coordinates of its points are; empty: not known.
  [[nodiscard]] std::string projection() const;

  /// Points of a mesh that knows where it is on the globe, within kRoundedPlaces, become
  /// these, which are those of the input.
  void settle_on(std::vector<Point> places);

  [[nodiscard]] VerifyReport verify(const Pslg* input, const VerifyOptions& options);
  /// After verify.
  [[nodiscard]] std::uint64_t digest() const { return digest_; }

 private:
  [[nodiscard]] VerifyReport verify_files(const Pslg* input, VerifyOptions options);
  [[nodiscard]] std::size_t pieces_at_once() const;
  void settle(Mesh& mesh) const;

  std::optional<PieceFiles> files_;
  Mesh whole_;
  std::optional<adapt::SavedHead> session_;
  std::vector<Point> places_;
  std::uint64_t digest_ = 0;
};

}  // namespace driftmesh::app
