#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>

#include "classes.hpp"
#include "driftmesh/check.hpp"
#include "driftmesh/files.hpp"
#include "driftmesh/generate.hpp"
#include "driftmesh/mesher.hpp"
#include "driftmesh/outline.hpp"
#include "options.hpp"

namespace driftmesh::python {
namespace {

/// As text, by the names that files and the command line have: Python's names have no dashes.
std::map<std::string, std::string> parameters_from(const py::kwargs& given) {
  std::map<std::string, std::string> parameters;
  for (const auto& [key, value] : given) {
    auto name = key.cast<std::string>();
    std::replace(name.begin(), name.end(), '_', '-');
    parameters[name] = PyBool_Check(value.ptr()) ? (value.template cast<bool>() ? "true" : "false")
                                                 : py::str(value).template cast<std::string>();
  }
  return parameters;
}

Pslg generate_by_name(const std::string& kind, const py::kwargs& parameters) {
  std::string name = kind;
  std::replace(name.begin(), name.end(), '_', '-');
  return generate(name, parameters_from(parameters));
}

Mesh make(const Pslg& input, const py::kwargs& options) {
  return with_options(options, [&](const MeshOptions& values) { return mesh(input, values); });
}

CheckReport check_mesh(const Mesh& mesh, const Pslg* input, const py::kwargs& options) {
  return with_options(options, [&](const MeshOptions& values) {
    return input != nullptr ? check(mesh, *input, values) : check(mesh, values);
  });
}

/// The kinds of inputs that can be generated, with their parameters, as lines of documentation.
std::string generator_lines() {
  std::string lines;
  for (const std::string& name : generator_names()) {
    lines += "    " + name + ":";
    for (const GeneratorParameter& parameter : generator_parameters(name))
      lines += "\n        " + parameter.name + " (default " + parameter.standard + "): " + parameter.help;
    lines += "\n";
  }
  std::replace(lines.begin(), lines.end(), '-', '_');
  return lines;
}

const std::string kMeshDoc =
    "mesh(input, /, **options) -> Mesh\n\n"
    "Make a mesh of the domain that a Pslg describes: constrained Delaunay, within the bounds on angles, areas and "
    "sizes.\n\n"
    "The same input and options give the same mesh, bit for bit. The input need not be clean: a copy is repaired "
    "first.\n"
    "Other threads of Python run meanwhile; Ctrl-C ends the work. Raises InputError, Error for options that are out "
    "of\n"
    "range, LimitError, Cancelled, and whatever callables raise.";

const std::string kCheckDoc =
    "check(mesh, input=None, /, **options) -> CheckReport\n\n"
    "Check a mesh, however it was made: it must be constrained Delaunay and meet the bounds on angles, areas and "
    "sizes.\n"
    "If its input is given, it must also cover its domain and have its segments, points, markers and regions. What is\n"
    "wrong is reported, not raised: the report is true if the mesh was accepted.\n\n"
    "Takes the options of mesh() and looks at those bounds, at snap, hull, simplify, close_channels, holes and "
    "threads.";

const std::string kGenerateDoc =
    "generate(kind, /, **parameters) -> Pslg\n\n"
    "Generate a domain with parameters, for demonstrations, tests and benchmarks. Raises InputError.\n\n";

}  // namespace

void add_functions(py::module_& module) {
  using Unlocked = py::call_guard<py::gil_scoped_release>;
  using Path = std::filesystem::path;  // what Python has as str or os.PathLike
  py::options options;
  options.disable_function_signatures();
  module.def("generator_names", &generator_names, "The names of the inputs that generate() makes.");
  module.def("generate", &generate_by_name, py::arg("kind"), py::pos_only(),
             (kGenerateDoc + generator_lines()).c_str());
  module.def(
      "holds_input", [](const Path& path) { return holds_input(path.string()); }, py::arg("path"));
  module.def(
      "read_input", [](const Path& path, const std::string& layers) { return read_input(path.string(), layers).pslg; },
      py::arg("path"), py::arg("layers") = "", Unlocked(),
      "read_input(path, layers='') -> Pslg\n\nRead a domain: GeoJSON, a shapefile or another file that GDAL reads, of "
      "which\nlayers may name some with commas between them (projected to meters), Triangle's .poly, or the points of "
      "a "
      ".node, or the outline of a mesh. "
      "Raises InputError with file and line.");
  module.def(
      "read_poly", [](const Path& path) { return read_poly(path.string()); }, py::arg("path"), Unlocked(),
      "read_poly(path) -> Pslg\n\nRead Triangle's .poly, or the points of a .node. Raises InputError with file and "
      "line, FileError.");
  module.def(
      "outline", [](const Mesh& mesh) { return outline(mesh); }, py::arg("mesh"), Unlocked(),
      "outline(mesh) -> Pslg\n\nThe domain that a mesh covers, to be meshed anew: its boundary, constrained edges and "
      "borders of regions as\nsegments with their markers, and seeds of its holes and regions. Raises InputError.");
  module.def(
      "read_mesh",
      [](const Path& path, bool allow_outside) { return read_mesh(path.string(), {.allow_outside = allow_outside}); },
      py::arg("path"), py::kw_only(), py::arg("allow_outside") = false, Unlocked(),
      "read_mesh(path, *, allow_outside=False) -> Mesh\n\nRead a mesh in any format that Mesh.write writes, or the "
      "pieces "
      "of a .pvtu, which may lie outside of\nits folder only if that is allowed. Raises InputError, FileError.");
  module.def("mesh", &make, py::arg("input"), py::pos_only(), (kMeshDoc + kOptionsHead + option_lines()).c_str());
  module.def("check", &check_mesh, py::arg("mesh"), py::arg("input") = py::none(), py::pos_only(),
             (kCheckDoc + kOptionsHead + option_lines()).c_str());
  module.def(
      "option_table", &option_table,
      "The options of mesh(): a dictionary for each, with name, kind, unit, default, least, most, choices, help.");
}

}  // namespace driftmesh::python
