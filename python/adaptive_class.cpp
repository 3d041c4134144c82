#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "adaptive_object.hpp"
#include "classes.hpp"
#include "driftmesh/adaptive.hpp"

namespace driftmesh::python {
namespace {

using Adaptive = AdaptiveObject<AdaptiveMesh, ByItself>;

std::unique_ptr<Adaptive> make_adaptive(const Pslg& input, double shortest, double longest, double gradation,
                                        double coarsening, double most_triangles, const py::kwargs& given) {
  const AdaptiveOptions adaptive = adaptive_options(shortest, longest, gradation, coarsening, most_triangles);
  return std::make_unique<Adaptive>(std::make_unique<Options>(given), ByItself(),
                                    [&](const MeshOptions& options) { return AdaptiveMesh(input, options, adaptive); });
}

std::unique_ptr<Adaptive> load_adaptive(const std::filesystem::path& path, const py::kwargs& given) {
  return std::make_unique<Adaptive>(std::make_unique<Options>(given), ByItself(), [&](const MeshOptions& options) {
    return AdaptiveMesh::load(path.string(), options);
  });
}

const std::string kDoc =
    "AdaptiveMesh(input, /, *, shortest=0, longest=inf, gradation=0.2, coarsening=0.03, most_triangles=0, "
    "**options)\n\n"
    "A mesh that follows a solution: it is refined and coarsened where lengths at its points ask for it, keeps what "
    "is\n"
    "as it should be, and carries fields along. Takes the options of mesh() for the first mesh; min_angle, max_area "
    "and\n"
    "region_areas hold for all. The same calls give the same meshes on any number of threads. What raises leaves it "
    "as\n"
    "it was.\n\n"
    "    shortest, longest: lengths are raised, or lowered, to these\n"
    "    gradation: by how much lengths may grow per unit of distance along edges, which lowers some; 0: no limit\n"
    "    coarsening: a subdomain is coarsened once that saves this fraction of its triangles\n"
    "    most_triangles: if lengths ask for more, all are made longer by a factor that fits, as forecast; 0: no limit";

}  // namespace

void add_adaptive_class(py::module_& module) {
  py::options options;
  options.disable_function_signatures();
  const AdaptiveOptions standard;
  py::class_<Adaptive> adaptive(module, "AdaptiveMesh", kDoc.c_str());
  adaptive
      .def(py::init(&make_adaptive), py::arg("input"), py::pos_only(), py::kw_only(),
           py::arg("shortest") = standard.shortest, py::arg("longest") = standard.longest,
           py::arg("gradation") = standard.gradation, py::arg("coarsening") = standard.coarsening,
           py::arg("most_triangles") = standard.most_triangles)
      .def_static(
          "load", &load_adaptive, py::arg("path"), py::pos_only(),
          "load(path, /, **options) -> AdaptiveMesh\n\n"
          "Go on from a file that save() wrote, bit for bit. Of the options count threads, limits, progress and\n"
          "size_resolution.")
      .def_property_readonly(
          "mesh",
          [](Adaptive& self) {
            return self.present([](const AdaptiveMesh& mesh) { return py::cast(Mesh(mesh.mesh())); });
          },
          "The present Mesh. Those of older generations stay valid.")
      .def_property_readonly(
          "old_mesh", [](const Adaptive& self) { return Mesh(self.at_rest().old_mesh()); },
          "The Mesh before the last adapt(), if keep_old() was called before it.");
  add_adaptive_methods(adaptive);
}

}  // namespace driftmesh::python
