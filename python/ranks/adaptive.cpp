#include "driftmesh/mpi/adaptive.hpp"

#include <mpi.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "python/adaptive_object.hpp"
#include "python/ranks/ranks.hpp"
#include "python/ranks/together.hpp"

namespace driftmesh::python {

namespace {

/// What fails on one rank alone is an Error on the others, which call the library.
struct OnRanks {
  MPI_Comm communicator;
  template <class Make>
  auto operator()(const Make& make) const {
    return made_together(communicator, make);
  }
  [[nodiscard]] static const Mesh& mesh_of(const DistributedAdaptiveMesh& adaptive) { return adaptive.piece().mesh; }
};

using Adaptive = AdaptiveObject<DistributedAdaptiveMesh, OnRanks>;

std::unique_ptr<Adaptive> make_adaptive(const py::object& given, const py::object& input, double shortest,
                                        double longest, double gradation, double coarsening, double most_triangles,
                                        const py::kwargs& options) {
  MPI_Comm communicator = communicator_from(given);
  const Pslg none;  // the input is that of rank 0
  const AdaptiveOptions adaptive = adaptive_options(shortest, longest, gradation, coarsening, most_triangles);
  auto [domain, own] = made_together(communicator, [&] {
    const Pslg* pslg = input.is_none() ? &none : &object_from<Pslg>(input, "input", "a Pslg");
    return std::pair(pslg, std::make_unique<Options>(options));
  });
  return std::make_unique<Adaptive>(std::move(own), OnRanks{communicator},
                                    [&, pslg = domain](const MeshOptions& values) {
                                      return DistributedAdaptiveMesh(communicator, *pslg, values, adaptive);
                                    });
}

std::unique_ptr<Adaptive> load_adaptive(const py::object& given, const std::filesystem::path& path,
                                        const py::kwargs& options) {
  MPI_Comm communicator = communicator_from(given);
  auto own = made_together(communicator, [&] { return std::make_unique<Options>(options); });
  return std::make_unique<Adaptive>(std::move(own), OnRanks{communicator}, [&](const MeshOptions& values) {
    return DistributedAdaptiveMesh::load(communicator, path.string(), values);
  });
}

void note_spent(Adaptive& self, const py::object& seconds) {
  if (py::isinstance<py::float_>(seconds) || py::isinstance<py::int_>(seconds))
    self.at_rest().spent(seconds.cast<double>());
  else
    self.at_rest().spent(numbers_from(seconds, "seconds").values);
}

}  // namespace

void add_adaptive_on_ranks(py::module_& module) {
  py::options options;
  options.disable_function_signatures();
  const AdaptiveOptions standard;
  py::class_<Adaptive> adaptive(
      module, "DistributedAdaptiveMesh",
      "DistributedAdaptiveMesh(communicator, input, /, *, shortest=0, longest=inf, gradation=0.2, coarsening=0.03, "
      "most_triangles=0, **options)\n\n"
      "An AdaptiveMesh on all ranks of an mpi4py communicator, each of which holds a piece: the same mesh and fields, "
      "bit\n"
      "for bit, on any number of ranks. All but properties, field(), spent() and keep_old() is collective. The input "
      "is that of\n"
      "rank 0, and may be None elsewhere; options must be the same on all ranks.");
  adaptive
      .def(py::init(&make_adaptive), py::arg("communicator"), py::arg("input"), py::pos_only(), py::kw_only(),
           py::arg("shortest") = standard.shortest, py::arg("longest") = standard.longest,
           py::arg("gradation") = standard.gradation, py::arg("coarsening") = standard.coarsening,
           py::arg("most_triangles") = standard.most_triangles)
      .def_static("load", &load_adaptive, py::arg("communicator"), py::arg("path"), py::pos_only(),
                  "load(communicator, path, /, **options) -> DistributedAdaptiveMesh\n\n"
                  "Go on from a file that any number of ranks wrote. Of the options count threads, limits, progress "
                  "and\n"
                  "size_resolution.")
      .def_property_readonly(
          "piece",
          [](Adaptive& self) {
            return self.present(
                [](const DistributedAdaptiveMesh& mesh) { return py::cast(DistributedPiece(mesh.piece())); });
          },
          "The present DistributedPiece of this rank. Those of older generations stay valid.")
      .def_property_readonly(
          "old_piece", [](const Adaptive& self) { return DistributedPiece(self.at_rest().old_piece()); },
          "The DistributedPiece of this rank before the last adapt(), if keep_old() was called before it.")
      .def("spent", &note_spent, py::arg("seconds"), py::pos_only(),
           "spent(seconds, /) -> None\n\n"
           "Tell how long this rank has worked on the present mesh, or each of its subdomains, in the order of their\n"
           "numbers: after adapt() has made the next one, subdomains move so that ranks take the same time.");
  add_adaptive_methods(adaptive);
}

}  // namespace driftmesh::python
