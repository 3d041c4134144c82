#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include "driftmesh/mesh.hpp"

namespace driftmesh {

/// An order of the points and triangles of a mesh.
enum class MeshOrder : std::uint8_t {
  kGiven,    ///< as they are: points of the input first, in their order, then the others as they were made
  kHilbert,  ///< along a Hilbert curve: near each other in the plane, near each other in memory
  kRcm,      ///< reverse Cuthill-McKee: a small bandwidth of matrices that connect the points of a triangle
};

/// The words for them, of options and of Python.
inline constexpr std::array<std::pair<MeshOrder, const char*>, 3> kMeshOrders = {
    {{MeshOrder::kGiven, "given"}, {MeshOrder::kHilbert, "hilbert"}, {MeshOrder::kRcm, "rcm"}}};

/// The order that such a word means. Throws InputError for another word.
[[nodiscard]] MeshOrder mesh_order_from(const std::string& word);

/// The same mesh in another order: points and what belongs to them are permuted, and triangles follow their lowest
/// points. Constrained edges stay in their order, and corners in theirs. The result depends on the mesh alone. kHilbert
/// takes n log n time for n points, kRcm linear time if degrees are bounded. Source: Cuthill and McKee, "Reducing the
/// bandwidth of sparse symmetric matrices", 1969; reversed after George 1971; started from pseudo-peripheral points by
/// Gibbs, Poole and Stockmeyer 1976.
///
/// \code
/// driftmesh::Mesh mesh = driftmesh::mesh(driftmesh::generate("pipe"), {.max_area = 50});
/// mesh = driftmesh::ordered(std::move(mesh), driftmesh::MeshOrder::kRcm);
/// \endcode
[[nodiscard]] Mesh ordered(Mesh mesh, MeshOrder order);

/// The largest difference between the numbers of two points of one triangle; 0 without triangles.
[[nodiscard]] std::int64_t bandwidth(const Mesh& mesh);

}  // namespace driftmesh
