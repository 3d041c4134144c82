#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "callbacks.hpp"
#include "driftmesh/adaptive.hpp"
#include "driftmesh/error.hpp"
#include "options.hpp"
#include "size_class.hpp"
#include "table.hpp"

namespace driftmesh::python {

[[nodiscard]] inline AdaptiveOptions adaptive_options(double shortest, double longest, double gradation,
                                                      double coarsening, double most_triangles) {
  return {.shortest = shortest,
          .longest = longest,
          .gradation = gradation,
          .coarsening = coarsening,
          .most_triangles = most_triangles};
}

/// For one process: whatever is done, nobody waits for it.
struct ByItself {
  template <class Make>
  auto operator()(const Make& make) const {
    return make();
  }
  [[nodiscard]] static const Mesh& mesh_of(const AdaptiveMesh& adaptive) { return adaptive.mesh(); }
};

/// An adaptive mesh with what its callables need. `Library` is its class in C++;
/// together(make) does what may fail on this rank alone, so that the others hear of it; mesh_of() is this rank's part.
template <class Library, class Together>
class AdaptiveObject {
 public:
  AdaptiveObject(std::unique_ptr<Options> options, Together together,
                 const std::function<Library(const MeshOptions&)>& make)
      : options_(std::move(options)), together_(std::move(together)), mesh_(with_options(*options_, make)) {}

  void adapt(const py::object& lengths) {
    require_rest();
    const Lengths asked = together_([&] { return lengths_from(lengths); });
    busy_ = true;
    try {
      with_options(*options_, [&](const MeshOptions&) {
        if (asked.by_function)
          mesh_.adapt(asked.by_function);
        else
          mesh_.adapt(asked.at_points);
      });
    } catch (...) {
      busy_ = false;
      throw;
    }
    busy_ = false;
    copy_ = py::object();
  }

  [[nodiscard]] py::array lengths_from_error(py::handle indicators, double target, double order) {
    require_rest();
    const auto own = together_([&] { return numbers_from(indicators, "indicators").values; });
    std::vector<double> lengths;
    {
      const py::gil_scoped_release unlocked;
      lengths = mesh_.lengths_from_error(own, target, order);
    }
    return py::array_t<double>(static_cast<py::ssize_t>(lengths.size()), lengths.data());
  }

  void attach(const std::string& name, const py::object& given, const std::string& where, const std::string& transfer) {
    require_rest();
    Attached field = together_([&] { return attached_from(name, given, where, transfer); });
    {
      const py::gil_scoped_release unlocked;
      mesh_.attach(name, std::move(field.values), field.place, field.how, std::move(field.shape));
    }
  }

  void detach(const std::string& name) {
    require_rest();
    const py::gil_scoped_release unlocked;
    mesh_.detach(name);
  }

  /// A copy, which nobody should take for the field itself.
  [[nodiscard]] py::array field(const std::string& name) {
    require_rest();
    const std::span<const double> values = mesh_.field(name);
    const FieldPlace place = mesh_.fields().at(name);
    std::vector<py::ssize_t> shape{places_of(place)};
    if (place == FieldPlace::kCorners) shape.push_back(3);
    for (const std::int64_t n : mesh_.shape(name)) shape.push_back(static_cast<py::ssize_t>(n));
    py::array copy = py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data()).reshape(shape);
    copy.attr("setflags")(py::arg("write") = false);
    return copy;
  }

  [[nodiscard]] std::vector<std::string> fields() const {
    std::vector<std::string> names;
    for (const auto& [name, place] : at_rest().fields()) names.push_back(name);
    return names;
  }

  void save(const std::filesystem::path& path) {
    require_rest();
    const py::gil_scoped_release unlocked;
    mesh_.save(path.string());
  }

  [[nodiscard]] const Library& at_rest() const {
    require_rest();
    return mesh_;
  }
  [[nodiscard]] Library& at_rest() {
    require_rest();
    return mesh_;
  }

  /// copy_of(mesh), made once for each generation: arrays of older ones stay valid.
  template <class Copy>
  py::object present(const Copy& copy_of) {
    require_rest();
    if (!copy_) copy_ = copy_of(mesh_);
    return copy_;
  }

 private:
  struct Lengths {
    std::vector<double> at_points;
    std::function<double(const Point&)> by_function;  // in place of these
  };
  struct Attached {
    std::vector<double> values;
    FieldPlace place{};
    Transfer how{};
    std::vector<std::int64_t> shape;  // that of the values at each place
  };

  Lengths lengths_from(const py::object& given) {
    if (py::isinstance<FieldObject>(given)) {
      const auto field = given.cast<const FieldObject&>().field;
      return {{}, [field](const Point& p) { return field->edge_length(p); }};
    }
    if (PyCallable_Check(given.ptr()) == 0) return {numbers_from(given, "lengths").values, {}};
    Callbacks& callbacks = options_->callbacks();
    return {{}, [&callbacks, &given](const Point& p) {
              return callbacks.ask([&] { return number_from("what size returns", given(p.x, p.y)); });
            }};
  }

  Attached attached_from(const std::string& name, const py::object& given, const std::string& where,
                         const std::string& transfer) const {
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
    const py::ssize_t count = places_of(place->second);
    if (shape.size() < leading || shape[0] != count || (at_corners && shape[1] != 3))
      throw py::value_error("field '" + name + "' has shape " + py::str(values.attr("shape")).cast<std::string>() +
                            "; give (" + std::to_string(count) + (at_corners ? ", 3" : "") +
                            ", ...), numbers for each of the present mesh's " + where);
    return {numbers_from(values.attr("reshape")(-1), name).values,
            place->second,
            way->second,
            {shape.begin() + static_cast<std::ptrdiff_t>(leading), shape.end()}};
  }

  [[nodiscard]] py::ssize_t places_of(FieldPlace place) const {
    const Mesh& mesh = Together::mesh_of(mesh_);
    return static_cast<py::ssize_t>(place == FieldPlace::kPoints ? mesh.points.size() : mesh.triangles.size());
  }

  /// With the interpreter's lock held, as it is when busy_ changes.
  void require_rest() const {
    if (busy_)
      throw Error(
          "the AdaptiveMesh is at work: a function that adapt calls, or another thread, cannot use it meanwhile");
  }

  std::unique_ptr<Options> options_;
  Together together_;
  Library mesh_;
  py::object copy_;
  bool busy_ = false;
};

[[nodiscard]] inline py::array copied(const std::vector<std::int32_t>& numbers) {
  return py::array_t<std::int32_t>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}

[[nodiscard]] inline py::dict report_of(const AdaptReport& r) {
  py::dict report;
  report["generation"] = r.generation;
  report["kept"] = r.kept;
  report["mended"] = r.mended;
  report["remade"] = r.remade;
  report["divided"] = r.divided;
  report["joined"] = r.joined;
  report["moved"] = r.moved;
  report["scale"] = r.scale;
  report["imbalance"] = r.imbalance;
  report["lengths"] = r.lengths;
  report["join"] = r.join;
  report["refine"] = r.refine;
  report["assemble"] = r.assemble;
  report["transfer"] = r.transfer;
  report["divide"] = r.divide;
  report["balance"] = r.balance;
  report["seconds"] = r.seconds;
  return report;
}

/// The methods that the classes have in common.
template <class Object>
void add_adaptive_methods(py::class_<Object>& adaptive) {
  adaptive
      .def("adapt", &Object::adapt, py::arg("lengths"), py::pos_only(),
           "adapt(lengths, /) -> None\n\n"
           "Make the next mesh. `lengths`: target edge lengths at the points of the present one, shape (points,),\n"
           "positive or infinite; or a function of x and y as mesh() takes it, or a SizeField.")
      .def("lengths_from_error", &Object::lengths_from_error, py::arg("indicators"), py::arg("target"),
           py::arg("order") = 1.0,
           "lengths_from_error(indicators, target, order=1) -> array\n\n"
           "Lengths for adapt() that spread errors evenly, from an estimate of the error in each triangle, shape\n"
           "(triangles,). The squares of those of the next mesh are to sum up to that of `target`. Errors decrease "
           "like\n"
           "the `order`-th power of edges: 2 for linear elements in the norm of L2, 1 in that of H1.")
      .def("attach", &Object::attach, py::arg("name"), py::arg("values"), py::kw_only(), py::arg("where") = "points",
           py::arg("transfer") = "interpolate",
           "attach(name, values, *, where='points', transfer='interpolate') -> None\n\n"
           "Add a field that adapt() carries along, or replace it: shape (points, ...), or (triangles, ...) where it "
           "is\n"
           "'triangles', (triangles, 3, ...) where it is 'corners'. 'conserve' keeps its integral; at triangles and\n"
           "corners there is no other way.")
      .def("detach", &Object::detach, py::arg("name"), "Forget a field.")
      .def("field", &Object::field, py::arg("name"),
           "field(name) -> array\n\n"
           "The values of a field on the present mesh, a read-only copy; attach() changes them.")
      .def_property_readonly("fields", &Object::fields, "The names of all fields.")
      .def(
          "keep_old", [](Object& self, bool keep) { self.at_rest().keep_old(keep); }, py::arg("keep") = true,
          "keep_old(keep=True) -> None\n\n"
          "Whether adapt() keeps the mesh that it replaces, from the next call on, for what you transfer yourself.")
      .def("save", &Object::save, py::arg("path"),
           "save(path) -> None\n\n"
           "Write the mesh, its subdomains and fields into one HDF5 file, from which load() goes on.")
      .def_property_readonly(
          "stayed_points", [](const Object& self) { return copied(self.at_rest().stayed_points()); },
          "For each point its number in the last mesh, -1 for those that are new, shape (points,).")
      .def_property_readonly(
          "stayed_triangles", [](const Object& self) { return copied(self.at_rest().stayed_triangles()); },
          "For each triangle its number in the last mesh, -1 for those that are new, shape (triangles,).")
      .def_property_readonly(
          "parents", [](const Object& self) { return self.at_rest().parents(); },
          "For each subdomain a list of those of the last mesh of which it is what they were, or a part of it.")
      .def_property_readonly(
          "report", [](const Object& self) { return report_of(self.at_rest().report()); },
          "What the last adapt() did: subdomains kept, mended, remade, divided, joined and moved, and times in "
          "seconds.");
}

}  // namespace driftmesh::python
