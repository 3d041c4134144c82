#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "driftmesh/options.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// How lengths that a caller asks for are taken. Lengths are in the units of the coordinates.
struct AdaptiveOptions {
  double shortest = 0;                                       ///< shorter lengths are raised to this one
  double longest = std::numeric_limits<double>::infinity();  ///< longer ones are lowered to this one
  /// Lengths at points grow by at most this much per unit of distance along the edges of the mesh, which lowers some of
  /// them; 0: no limit. It makes sure that nothing between points is missed.
  double gradation = 0.2;
  /// A subdomain is coarsened once that saves this fraction of its triangles.
  double coarsening = 0.03;
  /// If lengths ask for more triangles than this, all are made longer by a factor that fits, as forecast.
  /// The first forecast may be some 20 % too low, more where lengths change from point to point or the outline asks for
  /// triangles, too; later ones know how many more the present mesh needed. 0: no limit.
  double most_triangles = 0;
};

/// Where a field has values.
enum class FieldPlace : std::uint8_t {
  kPoints,     ///< linear between them
  kTriangles,  ///< constant in each
  kCorners,    ///< linear in each triangle, with three values of its own
};

/// How a field gets to the next mesh. Where the mesh is the same, values keep their bits: at points, at points all of
/// whose triangles stay, in triangles.
enum class Transfer : std::uint8_t {
  kInterpolate,  ///< linearly; only at points, where one that stays keeps its bits whatever is around it
  /// The integral stays the same but for rounding (1e-12 of that of the absolute values). At triangles and corners,
  /// each gets its part of those that it overlaps; at points, interpolation is brought as close to the lumped
  /// projection as that takes, which leaves a linear field what it is. In all cases no value exceeds those that it
  /// comes from, but for rounding: that of points on slanted lines and between subdomains, where old and new triangles
  /// do not cover quite the same, grows with coordinates relative to the size of triangles.
  kConserve,
};

/// What a call of adapt() did.
struct AdaptReport {
  std::int64_t generation = 0;  ///< 0 before the first call
  std::int32_t kept = 0;        ///< subdomains that are what they were, but for points on their borders
  std::int32_t mended = 0;      ///< subdomains of which only parts changed
  std::int32_t remade = 0;      ///< subdomains that were made anew
  std::int32_t divided = 0;     ///< subdomains that were added, since lengths asked for too much of one
  std::int32_t joined = 0;      ///< subdomains that are part of another one now, since lengths asked for little of them
  std::int32_t moved = 0;       ///< subdomains that went to another rank
  double scale = 1;             ///< factor on all lengths, for most_triangles
  double imbalance = 1;         ///< time of the slowest rank over the mean, as forecast, for what the caller does next
  // Times in seconds.
  double lengths = 0;   ///< limiting and comparing lengths
  double join = 0;      ///< joining subdomains, and giving others new numbers
  double refine = 0;    ///< making the subdomains
  double assemble = 0;  ///< putting them together
  double transfer = 0;  ///< fields, and what stayed
  double divide = 0;    ///< cutting subdomains further and making them anew
  double balance = 0;   ///< moving subdomains between ranks
  double seconds = 0;   ///< all of it
};

/// A mesh that follows a solution: it is refined and coarsened where lengths at its points ask for it, and carries
/// fields along. Made in this process by its threads. Each mesh is a constrained Delaunay triangulation that meets the
/// bounds of mesh() with the new lengths, also as to what counts between corners and centroid. Outlines, markers and
/// regions stay; so do whole subdomains, with all their points and triangles, where the mesh is as it should be.
///
/// The domain is cut as by options.subdomains; a subdomain that lengths come to ask for more than four times the mean
/// of is cut further, and those of which they ask little become one. options.min_angle, max_area and region_areas hold
/// for all generations; options.size and options.triangles for the first one alone. The same calls give the same meshes
/// and fields, bit for bit, on any number of threads.
///
/// An object is used by one thread at a time. What throws leaves it as it was.
///
/// \code
/// driftmesh::AdaptiveMesh flow(driftmesh::generate("pipe"), {.max_area = 100});
/// flow.attach("u", std::vector<double>(flow.mesh().points.size(), 1));
/// std::vector<double> lengths(flow.mesh().points.size(), 20);
/// lengths[0] = 1;       // where the solution asks for more
/// flow.adapt(lengths);  // a new mesh, and u on it
/// std::cout << flow.mesh().triangles.size() << " triangles, " << flow.field("u").size() << " values\n";
/// \endcode
class AdaptiveMesh {
 public:
  /// Makes the first mesh. Throws what mesh() throws, and Error for options that are out of range.
  explicit AdaptiveMesh(const Pslg& input, const MeshOptions& options = {}, const AdaptiveOptions& adaptive = {});
  AdaptiveMesh(AdaptiveMesh&&) noexcept;
  AdaptiveMesh& operator=(AdaptiveMesh&&) noexcept;
  ~AdaptiveMesh();

  /// Loads what save() of either class has written, and goes on as the one that was saved would have, bit for bit.
  /// Of `options` count threads, limits, progress, and size_resolution for adapt() with a function. Throws InputError,
  /// naming the version of a file that another driftmesh wrote, and FileError.
  [[nodiscard]] static AdaptiveMesh load(const std::string& path, const MeshOptions& options = {});
  /// Writes plan, subdomains and fields into one HDF5 file, which appears when it is complete. Throws FileError, and
  /// InputError for a path that cannot hold a regular file.
  void save(const std::string& path);

  /// The present mesh, valid until the next call of adapt().
  [[nodiscard]] const Mesh& mesh() const;
  [[nodiscard]] const AdaptiveOptions& options() const;

  /// Makes the next mesh, whose lengths are linear on the triangles of the present one. `lengths`: one for each of its
  /// points, > 0, or infinite for no bound. Throws Error for anything else, LimitError, Cancelled, and what
  /// options.progress throws.
  void adapt(std::span<const double> lengths);
  /// The same for a size as MeshOptions::size, with its rules; its growth is not limited. Also throws what `size`
  /// throws.
  void adapt(const std::function<double(const Point&)>& size);

  /// Lengths at the points of the present mesh for adapt(), such that errors are spread evenly over the triangles of
  /// the next one and sum up to `target`. `indicators`: an estimate of the error in each triangle, >= 0, whose squares
  /// sum up to the square of the whole error, and which decreases like the `order`-th power of its edges: 2 for linear
  /// elements in the norm of L2, 1 in that of H1. Where there is no error, lengths are infinite: see
  /// AdaptiveOptions::longest. Throws Error unless there is one indicator for each triangle, and target and order are
  /// positive.
  [[nodiscard]] std::vector<double> lengths_from_error(std::span<const double> indicators, double target,
                                                       double order = 1) const;

  /// Adds a field with the same number of values at each place, place by place, that adapt() carries along. Replaces a
  /// field of that name. `shape`: of the values at each place, for those who look at a file of save(), {2, 2} for a
  /// matrix. Throws Error if the number of values is no multiple of that of places, or another one than the shape's,
  /// and for interpolation at triangles or corners.
  void attach(const std::string& name, std::vector<double> values, FieldPlace place = FieldPlace::kPoints,
              Transfer how = Transfer::kInterpolate, std::vector<std::int64_t> shape = {});
  /// Throws Error if there is no such field.
  void detach(const std::string& name);
  /// The values of a field on the present mesh, to be read and changed; valid until the next call of adapt() or
  /// attach(). Throws Error if there is no such field.
  [[nodiscard]] std::span<double> field(const std::string& name);
  [[nodiscard]] std::span<const double> field(const std::string& name) const;

  /// The shape of a field's values at each place. Where attach() was told none: {} for one, {n} for several. Throws
  /// Error if there is no such field.
  [[nodiscard]] std::vector<std::int64_t> shape(const std::string& name) const;

  /// The names of all fields, ascending, each with its place.
  [[nodiscard]] std::map<std::string, FieldPlace> fields() const;

  // After adapt():

  /// For each point of the present mesh the number in the last one of the point at the same place; -1: it is new.
  [[nodiscard]] const std::vector<std::int32_t>& stayed_points() const;
  /// The same for triangles: those that have the same corners.
  [[nodiscard]] const std::vector<std::int32_t>& stayed_triangles() const;
  /// For each subdomain those of the last mesh of which it is what they were, or part of it, ascending: itself under
  /// its old number, the one that was divided, or all that were joined.
  [[nodiscard]] std::vector<std::vector<std::int32_t>> parents() const;
  [[nodiscard]] const AdaptReport& report() const;

  /// Whether adapt() keeps the mesh that it replaces, from the next call on, for what a caller wants to transfer
  /// itself. It takes its memory until the next call, or keep_old(false).
  void keep_old(bool keep = true);
  /// The mesh before the last call of adapt(), valid until the next one. Throws Error if it was not kept.
  [[nodiscard]] const Mesh& old_mesh() const;

 private:
  struct Impl;
  explicit AdaptiveMesh(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace driftmesh
