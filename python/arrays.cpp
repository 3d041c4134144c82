#include "arrays.hpp"

#include <utility>

#include "driftmesh/error.hpp"

namespace driftmesh::python {
namespace {

/// Whether this is of a class of numpy. Python's own numbers are asked for most, and are none.
bool is_class(py::handle given, const char* module, const char* name) {
  if (PyFloat_Check(given.ptr()) || PyLong_Check(given.ptr())) return false;
  return py::isinstance(given, py::module_::import(module).attr(name));
}

/// Throws TypeError for a masked array and for a list with True, False or a masked array somewhere in it: numpy would
/// make numbers of them.
void refuse_what_is_no_number(py::handle given, const std::string& name, const char* wanted) {
  if (PyList_Check(given.ptr()) || PyTuple_Check(given.ptr())) {
    for (const py::handle entry : given) refuse_what_is_no_number(entry, name, wanted);
    return;
  }
  if (is_masked(given))
    throw py::type_error(name + " is a masked array, or has one in it; give " + wanted +
                         ", such as its filled() or compressed()");
  if (is_truth_value(given)) throw py::type_error(name + " has entries of type bool; give " + wanted);
}

/// As an array of one of numpy's kinds of numbers: "fiu" or "iu". An empty list is of any kind.
py::array array_from(py::handle given, const std::string& name, const std::string& kinds, const char* wanted) {
  refuse_what_is_no_number(given, name, wanted);
  py::array array = py::module_::import("numpy").attr("asarray")(given);
  const auto kind = array.dtype().attr("kind").cast<std::string>();
  if (array.size() > 0 && kinds.find(kind) == std::string::npos)
    throw py::type_error(name + " has entries of type " + py::str(array.dtype()).cast<std::string>() + "; give " +
                         wanted);
  return array;
}

void require_shape(const py::array& array, const std::string& name, py::ssize_t columns) {
  if (columns == 1 && array.ndim() == 1) return;
  if (columns > 1 && array.ndim() == 2 && array.shape(1) == columns) return;
  if (array.size() == 0) return;
  throw py::value_error(name + " has shape " + py::str(array.attr("shape")).cast<std::string>() + "; give " +
                        (columns == 1
                             ? "one number after the other, shape (n,)"
                             : "rows of " + std::to_string(columns) + ", shape (n, " + std::to_string(columns) + ")"));
}

template <class T>
py::array_t<T, py::array::c_style | py::array::forcecast> dense(const py::array& array) {
  return {array};
}

template <class T>
std::vector<T> values_of(const py::array& array) {
  const auto numbers = dense<T>(array);
  return std::vector<T>(numbers.data(), numbers.data() + numbers.size());
}

std::vector<std::int64_t> whole_from(py::handle given, const std::string& name, py::ssize_t columns) {
  const py::array array = array_from(given, name, "iu", "whole numbers");
  require_shape(array, name, columns);
  return values_of<std::int64_t>(array);
}

}  // namespace

bool is_truth_value(py::handle given) {
  return PyBool_Check(given.ptr()) || is_class(given, "numpy", "bool_");
}

bool is_masked(py::handle given) {
  return is_class(given, "numpy.ma", "MaskedArray");
}

Numbers numbers_from(py::handle given, const std::string& name, py::ssize_t columns) {
  const py::array array = array_from(given, name, "fiu", "numbers");
  require_shape(array, name, columns);
  Numbers numbers{values_of<double>(array), 0, static_cast<std::size_t>(columns)};
  numbers.rows = numbers.values.size() / numbers.columns;
  return numbers;
}

Numbers table_from(py::handle given, const std::string& name) {
  const py::array array = array_from(given, name, "fiu", "numbers");
  return numbers_from(array, name, array.ndim() == 2 ? array.shape(1) : 1);
}

std::vector<Point> points_from(py::handle given, const std::string& name) {
  const Numbers numbers = numbers_from(given, name, 2);
  std::vector<Point> points(numbers.rows);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = {numbers.values[2 * i], numbers.values[2 * i + 1]};
  return points;
}

std::vector<std::int32_t> integers_from(py::handle given, const std::string& name, py::ssize_t columns) {
  const std::vector<std::int64_t> whole = whole_from(given, name, columns);
  std::vector<std::int32_t> integers(whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (!std::in_range<std::int32_t>(whole[i]))
      throw py::value_error(name + " has the number " + std::to_string(whole[i]) + ", which does not fit into 32 bits");
    integers[i] = static_cast<std::int32_t>(whole[i]);
  }
  return integers;
}

std::vector<std::int64_t> long_integers_from(py::handle given, const std::string& name) {
  return whole_from(given, name, 1);
}

void require_length(std::size_t length, std::size_t wanted, const std::string& name, const std::string& of) {
  if (length == 0 || length == wanted) return;
  throw py::value_error(name + " has " + std::to_string(length) + " entries; give " + std::to_string(wanted) +
                        ", one for each " + of);
}

void require_indices(const std::vector<std::int32_t>& indices, std::size_t count, const std::string& name) {
  for (const std::int32_t index : indices)
    if (index < 0 || std::cmp_greater_equal(index, count))
      throw py::value_error(name + " has index " + std::to_string(index) + ", but there are " + std::to_string(count) +
                            " points, numbered from 0");
}

}  // namespace driftmesh::python
