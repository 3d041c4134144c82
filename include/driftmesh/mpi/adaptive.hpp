#pragma once

#include <mpi.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "driftmesh/adaptive.hpp"
#include "driftmesh/distributed_piece.hpp"
#include "driftmesh/options.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// An AdaptiveMesh on all ranks of a communicator, each of which holds some of its subdomains and their fields. Mesh
/// and fields are those that AdaptiveMesh makes from the same input and options, bit for bit, on any number of ranks:
/// refinement takes place in rounds, and what is decided for the whole mesh follows from what ranks tell each other.
///
/// All functions but piece(), options(), field(), spent(), report(), what is old and what has become of it are
/// collective: all ranks call the same ones of the same object in the same order. What one rank throws all throw,
/// naming it, and everything stays as it was; different calls are an Error on all ranks once each is in one. Messages
/// travel on duplicates of the communicator, which must outlive the object.
///
/// The input is that of rank 0. All options must be the same on every rank; those for many ranks have no meaning, since
/// subdomains stay where they are while they are refined. Every rank uses its own MeshOptions::size, which must behave
/// identically everywhere, and its own MeshOptions::progress, which can cancel the work of all ranks.
///
/// \code
/// driftmesh::DistributedAdaptiveMesh flow(MPI_COMM_WORLD, driftmesh::generate("pipe"), {.max_area = 100});
/// flow.attach("u", std::vector<double>(flow.piece().mesh.points.size(), 1));
/// std::vector<double> lengths;
/// for (const driftmesh::Point& p : flow.piece().mesh.points) lengths.push_back(1 + 0.1 * std::abs(p.x));
/// flow.adapt(lengths);  // a new piece on each rank, and u on it
/// std::cout << flow.piece().mesh.triangles.size() << " of " << flow.piece().total_triangles << " triangles\n";
/// \endcode
class DistributedAdaptiveMesh {
 public:
  /// Makes the first mesh. Throws what mesh_distributed() throws, and Error for options that are out of range.
  DistributedAdaptiveMesh(MPI_Comm communicator, const Pslg& input, const MeshOptions& options = {},
                          const AdaptiveOptions& adaptive = {});
  DistributedAdaptiveMesh(DistributedAdaptiveMesh&&) noexcept;
  DistributedAdaptiveMesh& operator=(DistributedAdaptiveMesh&&) noexcept;
  ~DistributedAdaptiveMesh();

  /// As AdaptiveMesh::load and save, collectively: a file that any number of ranks wrote is loaded on any other.
  [[nodiscard]] static DistributedAdaptiveMesh load(MPI_Comm communicator, const std::string& path,
                                                    const MeshOptions& options = {});
  void save(const std::string& path);

  /// This rank's piece of the present mesh, valid until the next call of adapt(). add_ghost_layer() takes it.
  [[nodiscard]] const DistributedPiece& piece() const;
  [[nodiscard]] const AdaptiveOptions& options() const;

  /// Makes the next mesh, as AdaptiveMesh::adapt. `lengths`: one for each point of the piece; at points that ranks
  /// share, the shortest one counts.
  void adapt(std::span<const double> lengths);
  void adapt(const std::function<double(const Point&)>& size);

  /// As AdaptiveMesh::lengths_from_error, for the triangles and points of the piece.
  [[nodiscard]] std::vector<double> lengths_from_error(std::span<const double> indicators, double target,
                                                       double order = 1) const;

  /// As AdaptiveMesh::attach, with this rank's values. Where ranks share a point, the value of its owner
  /// (DistributedPiece::owners) counts. The shape of a rank without places does not count.
  void attach(const std::string& name, std::vector<double> values, FieldPlace place = FieldPlace::kPoints,
              Transfer how = Transfer::kInterpolate, std::vector<std::int64_t> shape = {});
  void detach(const std::string& name);
  /// The values of a field on the present piece, to be read and changed; valid until the next call of adapt() or
  /// attach(). Throws Error if there is no such field.
  [[nodiscard]] std::span<double> field(const std::string& name);
  [[nodiscard]] std::span<const double> field(const std::string& name) const;

  [[nodiscard]] std::vector<std::int64_t> shape(const std::string& name) const;

  /// Tells how many seconds this rank has worked on the present mesh: once adapt() has made the next one, subdomains
  /// move with their fields where the slowest rank would take more than 1.05 times the mean, so that ranks take the
  /// same time if they are as fast as they were. By default all are taken to be as fast. Not collective; what adapt()
  /// cannot use (NaN, less than 0) it throws an Error for.
  void spent(double seconds);
  /// The same for each of this rank's subdomains, in the order of their numbers (Mesh::subdomains): if all ranks tell
  /// that, the triangles of each subdomain cost what they did.
  void spent(std::span<const double> seconds);

  /// The names of all fields, ascending, each with its place.
  [[nodiscard]] std::map<std::string, FieldPlace> fields() const;

  // After adapt():

  /// For each point of the present piece the number in the last one of the point at the same place; -1: it is new, or
  /// came from another rank.
  [[nodiscard]] const std::vector<std::int32_t>& stayed_points() const;
  /// The same for triangles: those that have the same corners.
  [[nodiscard]] const std::vector<std::int32_t>& stayed_triangles() const;
  /// As of AdaptiveMesh, for the subdomains of all ranks.
  [[nodiscard]] std::vector<std::vector<std::int32_t>> parents() const;
  /// Numbers of subdomains are those of all ranks, times those of this one.
  [[nodiscard]] const AdaptReport& report() const;

  /// As of AdaptiveMesh, for this rank alone: the piece that it had before the last call of adapt().
  void keep_old(bool keep = true);
  [[nodiscard]] const DistributedPiece& old_piece() const;

 private:
  struct Impl;
  explicit DistributedAdaptiveMesh(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace driftmesh
