#include "picture/plot.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "base/nearest_name.hpp"
#include "classes.hpp"
#include "driftmesh/error.hpp"
#include "table.hpp"

namespace driftmesh::python {
namespace {

namespace py = pybind11;

template <class Value>
Value named(const PlotNames<Value>& names, const std::string& option, const std::string& word) {
  const auto found = std::ranges::find(names, word, [](const auto& entry) { return entry.first; });
  if (found != names.end()) return found->second;
  std::vector<std::string> words;
  for (const auto& [name, value] : names) words.push_back(name);
  throw Error(option + " is '" + word + "'; the nearest valid value is '" + nearest_name(word, words) + "'");
}

/// x0, y0, x1, y1.
PlotBox box_from(const std::vector<double>& box) {
  if (box.size() != 4) throw Error("box has " + std::to_string(box.size()) + " numbers; give x0, y0, x1, y1");
  if (!(box[0] < box[2] && box[1] < box[3]))
    throw Error("box is not x0, y0, x1, y1 with x0 < x1 and y0 < y1; reorder it");
  return {{box[0], box[1]}, {box[2], box[3]}};
}

template <class Shown>
void draw(const Shown& shown, const std::filesystem::path& path, const std::string& color, const std::string& edges,
          py::handle width, py::handle height, py::handle box, const std::string& title) {
  PlotOptions options{.name = std::is_same_v<Shown, Mesh> ? "the mesh" : "the input",
                      .width = short_integer_from("width", width),
                      .height = short_integer_from("height", height),
                      .color = named(plot_colors(), "color", color),
                      .edges = named(plot_edges(), "edges", edges),
                      .title = title};
  if (!box.is_none()) options.box = box_from(numbers_from(box, "box").values);
  const py::gil_scoped_release unlocked;
  plot(shown, path.string(), options);
}

template <class Shown>
void add_plot_of(py::module_& module, const char* doc) {
  const PlotOptions standard;
  module.def("plot", &draw<Shown>, py::arg("what"), py::arg("path"), py::kw_only(),
             py::arg("color") = plot_colors().front().first, py::arg("edges") = plot_edges().front().first,
             py::arg("width") = standard.width, py::arg("height") = standard.height, py::arg("box") = py::none(),
             py::arg("title") = standard.title, doc);
}

}  // namespace

void add_plot(py::module_& module) {
  py::options options;
  options.disable_function_signatures();
  add_plot_of<Mesh>(
      module,
      "plot(what, path, *, color=\"auto\", edges=\"auto\", width=1600, height=0, box=None, title=\"\")\n\n"
      "Draw a Mesh or a Pslg as .png, .svg or .pdf, by the extension of the path.\n\n"
      "    color: what the colors of triangles show: angle, area, region, subdomain, rank or none; auto: the angle, "
      "or\n"
      "        the area where triangles are too small to be seen\n"
      "    edges: whether edges are drawn: on, off, or auto (where they are long enough to be seen)\n"
      "    width, height: in pixels; height 0 is what fits\n"
      "    box: x0, y0, x1, y1 of the part of the plane to show\n\n"
      "Raises InputError, FileError, and Error for options that are out of range.");
  add_plot_of<Pslg>(module, "");
}

}  // namespace driftmesh::python
