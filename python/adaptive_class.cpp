#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "callbacks.hpp"
#include "classes.hpp"
#include "driftmesh/adaptive.hpp"
#include "driftmesh/error.hpp"
#include "options.hpp"
#include "size_class.hpp"
#include "table.hpp"

namespace driftmesh::python {
namespace {

AdaptiveOptions adaptive_options(double shortest, double longest, double gradation, double coarsening,
                                 double most_triangles) {
  return {.shortest = shortest,
          .longest = longest,
          .gradation = gradation,
          .coarsening = coarsening,
          .most_triangles = most_triangles};
}

/// An AdaptiveMesh with what its callables need, and the shapes of its fields.
class Adaptive {
 public:
  Adaptive(const Pslg& input, const AdaptiveOptions& adaptive, const py::kwargs& options)
      : options_(std::make_unique<Options>(options)) {
    with_options(*options_, [&](const MeshOptions& values) { mesh_.emplace(input, values, adaptive); });
  }

  /// A copy, made once for each generation: arrays of older ones stay valid.
  py::object mesh() {
    require_rest();
    if (!copy_) copy_ = py::cast(Mesh(mesh_->mesh()));
    return copy_;
  }

  void adapt(const py::object& lengths) {
    require_rest();
    const bool by_function = PyCallable_Check(lengths.ptr()) != 0;
    if (py::isinstance<FieldObject>(lengths)) {
      const auto field = lengths.cast<const FieldObject&>().field;
      work([&] { mesh_->adapt([&](const Point& p) { return field->edge_length(p); }); });
    } else if (by_function) {
      Callbacks& callbacks = options_->callbacks();
      work([&] {
        mesh_->adapt([&](const Point& p) {
          return callbacks.ask([&] { return number_from("what size returns", lengths(p.x, p.y)); });
        });
      });
    } else {
      const std::vector<double> values = numbers_from(lengths, "lengths").values;
      work([&] { mesh_->adapt(values); });
    }
    copy_ = py::object();
  }

  [[nodiscard]] std::vector<double> lengths_from_error(py::handle indicators, double target, double order) {
    require_rest();
    return mesh_->lengths_from_error(numbers_from(indicators, "indicators").values, target, order);
  }

  void attach(const std::string& name, const py::object& given, const std::string& where, const std::string& transfer) {
    require_rest();
    const std::map<std::string, FieldPlace> places{
        {"points", FieldPlace::kPoints}, {"triangles", FieldPlace::kTriangles}, {"corners", FieldPlace::kCorners}};
    const std::map<std::string, Transfer> ways{{"interpolate", Transfer::kInterpolate},
                                               {"conserve", Transfer::kConserve}};
    const auto place = places.find(where);
    if (place == places.end())
      throw py::value_error("where is '" + where + "'; it must be 'points', 'triangles' or 'corners'");
    const auto way = ways.find(transfer);
    if (way == ways.end())
      throw py::value_error("transfer is '" + transfer + "'; it must be 'interpolate' or 'conserve'");
    const py::object values = is_masked(given) ? given : py::module_::import("numpy").attr("asarray")(given);
    const auto shape = values.attr("shape").cast<std::vector<py::ssize_t>>();
    const bool at_corners = place->second == FieldPlace::kCorners;
    const std::size_t leading = at_corners ? 2 : 1;
    const auto count = static_cast<py::ssize_t>(place->second == FieldPlace::kPoints ? mesh_->mesh().points.size()
                                                                                     : mesh_->mesh().triangles.size());
    if (shape.size() < leading || shape[0] != count || (at_corners && shape[1] != 3))
      throw py::value_error("field '" + name + "' has shape " + py::str(values.attr("shape")).cast<std::string>() +
                            "; give (" + std::to_string(count) + (at_corners ? ", 3" : "") +
                            ", ...), numbers for each of the present mesh's " + where);
    mesh_->attach(name, numbers_from(values.attr("reshape")(-1), name).values, place->second, way->second);
    trailing_[name] = {shape.begin() + 1, shape.end()};
  }

  void detach(const std::string& name) {
    require_rest();
    mesh_->detach(name);
    trailing_.erase(name);
  }

  /// A copy.
  [[nodiscard]] py::array field(const std::string& name) {
    require_rest();
    const std::span<const double> values = mesh_->field(name);
    std::vector<py::ssize_t> shape{-1};
    for (const py::ssize_t n : trailing_.at(name)) shape.push_back(n);
    return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data()).reshape(shape);
  }

  [[nodiscard]] const AdaptiveMesh& at_rest() const {
    require_rest();
    return *mesh_;
  }

 private:
  template <class Work>
  void work(const Work& run) {
    busy_ = true;
    try {
      with_options(*options_, [&](const MeshOptions&) { run(); });
    } catch (...) {
      busy_ = false;
      throw;
    }
    busy_ = false;
  }

  /// With the interpreter's lock held, as it is when busy_ changes.
  void require_rest() const {
    if (busy_)
      throw Error(
          "the AdaptiveMesh is at work: a function that adapt calls, or another thread, cannot use it meanwhile");
  }

  std::unique_ptr<Options> options_;
  std::optional<AdaptiveMesh> mesh_;
  py::object copy_;
  std::map<std::string, std::vector<py::ssize_t>> trailing_;  // shapes of fields, without the number of places
  bool busy_ = false;
};

py::array copied(const std::vector<std::int32_t>& numbers) {
  return py::array_t<std::int32_t>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}

py::dict report_of(const AdaptReport& r) {
  py::dict report;
  report["generation"] = r.generation;
  report["kept"] = r.kept;
  report["mended"] = r.mended;
  report["remade"] = r.remade;
  report["scale"] = r.scale;
  report["lengths"] = r.lengths;
  report["refine"] = r.refine;
  report["assemble"] = r.assemble;
  report["transfer"] = r.transfer;
  report["seconds"] = r.seconds;
  return report;
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
  py::class_<Adaptive>(module, "AdaptiveMesh", kDoc.c_str())
      .def(py::init([](const Pslg& input, double shortest, double longest, double gradation, double coarsening,
                       double most_triangles, const py::kwargs& given) {
             return std::make_unique<Adaptive>(
                 input, adaptive_options(shortest, longest, gradation, coarsening, most_triangles), given);
           }),
           py::arg("input"), py::pos_only(), py::kw_only(), py::arg("shortest") = standard.shortest,
           py::arg("longest") = standard.longest, py::arg("gradation") = standard.gradation,
           py::arg("coarsening") = standard.coarsening, py::arg("most_triangles") = standard.most_triangles)
      .def_property_readonly("mesh", &Adaptive::mesh, "The present Mesh. Those of older generations stay valid.")
      .def("adapt", &Adaptive::adapt, py::arg("lengths"), py::pos_only(),
           "adapt(lengths, /) -> None\n\n"
           "Make the next mesh. `lengths`: target edge lengths at the points of the present one, shape (points,),\n"
           "positive or infinite; or a function of x and y as mesh() takes it, or a SizeField.")
      .def(
          "lengths_from_error",
          [](Adaptive& self, py::handle indicators, double target, double order) {
            const std::vector<double> lengths = self.lengths_from_error(indicators, target, order);
            return py::array_t<double>(static_cast<py::ssize_t>(lengths.size()), lengths.data());
          },
          py::arg("indicators"), py::arg("target"), py::arg("order") = 1.0,
          "lengths_from_error(indicators, target, order=1) -> array\n\n"
          "Lengths for adapt() that spread errors evenly, from an estimate of the error in each triangle, shape\n"
          "(triangles,). The squares of those of the next mesh are to sum up to that of `target`. Errors decrease "
          "like\n"
          "the `order`-th power of edges: 2 for linear elements in the norm of L2, 1 in that of H1.")
      .def("attach", &Adaptive::attach, py::arg("name"), py::arg("values"), py::kw_only(), py::arg("where") = "points",
           py::arg("transfer") = "interpolate",
           "attach(name, values, *, where='points', transfer='interpolate') -> None\n\n"
           "Add a field that adapt() carries along, or replace it: shape (points, ...), or (triangles, ...) where it "
           "is\n"
           "'triangles', (triangles, 3, ...) where it is 'corners'. 'conserve' keeps its integral; at triangles and\n"
           "corners there is no other way.")
      .def("detach", &Adaptive::detach, py::arg("name"), "Forget a field.")
      .def("field", &Adaptive::field, py::arg("name"), "The values of a field on the present mesh, a copy.")
      .def_property_readonly(
          "stayed_points", [](const Adaptive& self) { return copied(self.at_rest().stayed_points()); },
          "For each point its number in the last mesh, -1 for those that are new, shape (points,).")
      .def_property_readonly(
          "stayed_triangles", [](const Adaptive& self) { return copied(self.at_rest().stayed_triangles()); },
          "For each triangle its number in the last mesh, -1 for those that are new, shape (triangles,).")
      .def_property_readonly(
          "report", [](const Adaptive& self) { return report_of(self.at_rest().report()); },
          "What the last adapt() did: subdomains kept, mended and remade, and times in seconds.");
}

}  // namespace driftmesh::python
