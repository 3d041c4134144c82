#pragma once

#include <pybind11/numpy.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "driftmesh/point.hpp"

/// Between numpy's arrays and those of the library.
namespace driftmesh::python {

namespace py = pybind11;

/// A read-only array over memory that belongs to `owner`, which the array keeps alive. Nothing is copied.
template <class T>
py::array view(const T* first, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides, py::handle owner) {
  py::array array(py::dtype::of<T>(), std::move(shape), std::move(strides), first, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

template <class T>
py::array view(const std::vector<T>& values, py::handle owner) {
  return view(values.data(), {static_cast<py::ssize_t>(values.size())}, {sizeof(T)}, owner);
}

/// A view of `columns` numbers of type T in each record, the first of which is that at `first` in the first record.
template <class T, class Record>
py::array columns_of(const std::vector<Record>& records, const T* first, py::ssize_t columns, py::handle owner) {
  return view(first, {static_cast<py::ssize_t>(records.size()), columns},
              {static_cast<py::ssize_t>(sizeof(Record)), static_cast<py::ssize_t>(sizeof(T))}, owner);
}

/// A view of one number of type T in each record, that at `first` in the first record.
template <class T, class Record>
py::array column_of(const std::vector<Record>& records, const T* first, py::handle owner) {
  return view(first, {static_cast<py::ssize_t>(records.size())}, {static_cast<py::ssize_t>(sizeof(Record))}, owner);
}

/// Whether this is True or False, of Python or of numpy. They would pass for numbers.
[[nodiscard]] bool is_truth_value(py::handle given);
/// Whether this is a masked array of numpy, or a masked number: without their masks they would pass for numbers.
[[nodiscard]] bool is_masked(py::handle given);

/// Numbers from anything that numpy makes an array of. `name`: the argument, for errors. TypeError for what is not
/// numbers, such as bool, and for masked arrays, ValueError for another shape.
struct Numbers {
  std::vector<double> values;  ///< row by row
  std::size_t rows = 0;
  std::size_t columns = 1;
};
/// A list of numbers, or a table with this many columns.
[[nodiscard]] Numbers numbers_from(py::handle given, const std::string& name, py::ssize_t columns = 1);
/// A table with as many columns as it has. A list is one with one column.
[[nodiscard]] Numbers table_from(py::handle given, const std::string& name);

/// Points, a table with two columns.
[[nodiscard]] std::vector<Point> points_from(py::handle given, const std::string& name);

/// Whole numbers likewise, row by row. ValueError if one does not fit into 32 bits.
[[nodiscard]] std::vector<std::int32_t> integers_from(py::handle given, const std::string& name,
                                                      py::ssize_t columns = 1);
[[nodiscard]] std::vector<std::int64_t> long_integers_from(py::handle given, const std::string& name);

/// Throws ValueError unless an array is empty or has `wanted` entries, one for each `of`.
void require_length(std::size_t length, std::size_t wanted, const std::string& name, const std::string& of);

/// Throws ValueError unless each index is in 0 .. count - 1.
void require_indices(const std::vector<std::int32_t>& indices, std::size_t count, const std::string& name);

}  // namespace driftmesh::python
