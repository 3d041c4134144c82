#include "driftmesh/mpi/distributed.hpp"

#include <mpi.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "driftmesh/error.hpp"
#include "python/arrays.hpp"
#include "python/options.hpp"
#include "python/ranks/ranks.hpp"
#include "python/ranks/together.hpp"
#include "python/table.hpp"

namespace driftmesh::python {
namespace {

const DistributedPiece& piece_from(const py::object& given) {
  return object_from<DistributedPiece>(given, "piece", "a DistributedPiece");
}

std::string path_from(const py::object& given) {
  const auto path = py::reinterpret_steal<py::object>(PyOS_FSPath(given.ptr()));
  if (!path) throw py::error_already_set();
  return path.cast<std::filesystem::path>().string();
}

DistributedPiece make_piece(const py::object& given, const py::object& input, const py::kwargs& options) {
  MPI_Comm communicator = communicator_from(given);
  const Pslg none;  // the input is that of rank 0
  const auto [domain, own] = made_together(communicator, [&] {
    const Pslg* pslg = input.is_none() ? &none : &object_from<Pslg>(input, "input", "a Pslg");
    return std::pair(pslg, std::make_unique<Options>(options));
  });
  return with_options(
      *own, [&, pslg = domain](const MeshOptions& values) { return mesh_distributed(communicator, *pslg, values); });
}

void write_pieces(const py::object& given, const py::object& piece, const py::object& path) {
  MPI_Comm communicator = communicator_from(given);
  const auto [own, name] = made_together(communicator, [&] { return std::pair(&piece_from(piece), path_from(path)); });
  const py::gil_scoped_release unlocked;
  write_distributed(communicator, *own, name);
}

/// For each neighbor the shared points: a view.
py::dict shared_points(const py::object& self) {
  py::dict shared;
  for (const DistributedPiece::Neighbor& n : self.cast<const DistributedPiece&>().neighbors)
    shared[py::int_(to_int(n.rank))] = view(n.shared, self);
  return shared;
}

GhostedPiece make_ghosts(const py::object& given, const py::object& piece) {
  MPI_Comm communicator = communicator_from(given);
  const DistributedPiece* own = made_together(communicator, [&] { return &piece_from(piece); });
  const py::gil_scoped_release unlocked;
  return add_ghost_layer(communicator, *own);
}

/// For each neighbor two views: triangles that it has as ghosts, and that it owns.
py::dict exchanged_triangles(const py::object& self) {
  py::dict exchanged;
  for (const GhostedPiece::Neighbor& n : self.cast<const GhostedPiece&>().neighbors)
    exchanged[py::int_(to_int(n.rank))] = py::make_tuple(view(n.sent, self), view(n.received, self));
  return exchanged;
}

/// A view of the ranks that own points.
template <class Piece>
py::array owners_of(const py::object& self) {
  const auto& owners = self.cast<const Piece&>().owners;
  static_assert(sizeof(Rank) == sizeof(std::int32_t));
  return column_of(owners, reinterpret_cast<const std::int32_t*>(owners.data()), self);
}

void add_ghosted_piece(py::module_& module) {
  py::class_<GhostedPiece>(module, "GhostedPiece", "One rank's part of a distributed mesh with a ring of ghosts.")
      .def_property_readonly(
          "rank", [](const GhostedPiece& p) { return to_int(p.rank); }, "The rank that has it.")
      .def_readonly("ranks", &GhostedPiece::ranks, "Number of all ranks.")
      .def_property_readonly(
          "mesh", [](const GhostedPiece& p) -> const Mesh& { return p.mesh; },
          py::return_value_policy::reference_internal,
          "The piece, in its order, then ghosts: points and triangles by number. Its ranks are the owners of "
          "triangles.")
      .def_readonly("own_points", &GhostedPiece::own_points, "Points of the piece, which come first in the mesh.")
      .def_readonly("own_triangles", &GhostedPiece::own_triangles, "Triangles of the piece, which come first.")
      .def_readonly("own_edges", &GhostedPiece::own_edges, "Subsegments of the piece, which come first.")
      .def_property_readonly("owners", &owners_of<GhostedPiece>, "Rank that owns each point, shape (points,).")
      .def_property_readonly(
          "triangle_numbers",
          [](const py::object& self) { return view(self.cast<const GhostedPiece&>().triangle_numbers, self); },
          "Number of each triangle in the whole mesh, whichever rank has it, shape (triangles,).")
      .def_property_readonly(
          "neighbors", &exchanged_triangles,
          "For each rank with ghosts here two views: (sent, received), indices of own triangles that are ghosts there, "
          "and of the ghosts here that it owns: a dictionary of pairs of arrays of shape (triangles,). What one rank "
          "sends is in the order in which the other receives it: `sent` here is as long as `received` there.");
  module.def(
      "add_ghost_layer", &make_ghosts, py::arg("communicator"), py::arg("piece"),
      "add_ghost_layer(communicator, piece)\n\n"
      "Each rank's piece with a ring of ghosts around it: the triangles of other ranks that have a point in common\n"
      "with a triangle of the piece. Collective.");
}

}  // namespace

void add_distributed(py::module_& module) {
  py::options options;
  options.disable_function_signatures();
  py::class_<DistributedPiece>(module, "DistributedPiece", "One rank's part of a distributed mesh.")
      .def_property_readonly(
          "rank", [](const DistributedPiece& p) { return to_int(p.rank); }, "The rank that has it.")
      .def_readonly("ranks", &DistributedPiece::ranks, "Number of all ranks.")
      .def_readonly("mesh", &DistributedPiece::mesh,
                    "The subdomains of this rank joined into one Mesh, with `numbers` and `subdomains`.")
      .def_property_readonly("owners", &owners_of<DistributedPiece>,
                             "Rank that owns each point, one of those that have it, shape (points,).")
      .def_property_readonly("neighbors", &shared_points,
                             "For each rank with shared points, the indices of these points, in the same order on both "
                             "sides: a dictionary of arrays of shape (shared points,).")
      .def_readonly("has_regions", &DistributedPiece::has_regions, "Whether the whole mesh has regions.")
      .def_readonly("total_points", &DistributedPiece::total_points, "Points of the whole mesh, each counted once.")
      .def_readonly("total_triangles", &DistributedPiece::total_triangles, "Triangles of the whole mesh.");
  add_ghosted_piece(module);
  module.def(
      "mesh_distributed", &make_piece, py::arg("communicator"), py::arg("input"), py::pos_only(),
      ("mesh_distributed(communicator, input, /, **options) -> DistributedPiece\n\n"
       "Make a mesh on all ranks of an mpi4py communicator, each of which gets its piece. Collective.\n\n"
       "The input is that of rank 0, and may be None elsewhere. Options must be the same on all ranks. Every rank\n"
       "gives its own `size` and `balance[\"own\"]`, which must behave the same everywhere, and its own `progress`.\n"
       "Errors are those of mesh(), raised on all ranks: what is wrong or raised on one rank alone is an Error on the\n"
       "others." +
       std::string(kOptionsHead) + option_lines())
          .c_str());
  module.def(
      "write_distributed", &write_pieces, py::arg("communicator"), py::arg("piece"), py::arg("path"),
      "write_distributed(communicator, piece, path)\n\n"
      "Write the pieces of all ranks. Collective. A .pvtu is written in parallel, one file for each rank; for other\n"
      "formats the mesh is gathered on rank 0. Raises InputError and FileError, on all ranks if one cannot write.");
}

}  // namespace driftmesh::python
