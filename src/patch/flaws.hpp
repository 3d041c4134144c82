#pragma once

#include <string>
#include <typeinfo>

#include "driftmesh/error.hpp"
#include "driftmesh/mesh.hpp"

namespace driftmesh::patch {

/// Throws Error for a mesh without triangles, one whose arrays do not belong together, and one of whose triangles does
/// not have three different points that are somewhere. Attributes are not looked at.
void require_sound(const Mesh& mesh);

/// What is wrong with the triangles of a sound mesh, in numbers of the mesh and in coordinates: they are clockwise,
/// flat, on each other, or do not share all points at which they meet. Empty: none of that.
[[nodiscard]] std::string find_flaw(const Mesh& mesh);

/// Does something with a mesh. If that is a plain Error, and the mesh has a flaw, it throws that one.
template <class Work>
auto with_flaw_of(const Mesh& mesh, Work&& work) {
  try {
    return work();
  } catch (const Error& error) {
    if (typeid(error) != typeid(Error)) throw;
    const std::string flaw = find_flaw(mesh);
    if (flaw.empty()) throw;
    throw Error(flaw + "; driftmesh check lists all such places");
  }
}

}  // namespace driftmesh::patch
