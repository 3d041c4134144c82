#include "table.hpp"

#include <cmath>
#include <utility>

#include "base/nearest_name.hpp"

namespace driftmesh::python {

Given entries_of(const py::dict& dictionary) {
  Given entries;
  for (const auto& [name, value] : dictionary)
    if (!value.is_none()) entries[py::str(name).cast<std::string>()] = py::reinterpret_borrow<py::object>(value);
  return entries;
}

py::object taken(Given& given, const std::string& name) {
  const auto found = given.extract(name);
  return found.empty() ? py::none() : std::move(found.mapped());
}

void refuse_rest(const Given& given, const std::vector<std::string>& known) {
  if (given.empty()) return;
  const std::string& unknown = given.begin()->first;
  throw py::type_error("there is no option '" + unknown + "'; the nearest one is '" + nearest_name(unknown, known) +
                       "'");
}

void refuse(const std::string& name, const char* wanted, py::handle given) {
  throw py::type_error(name + " takes " + wanted + ", not " + Py_TYPE(given.ptr())->tp_name);
}

double number_from(const std::string& name, py::handle given) {
  if (PyFloat_Check(given.ptr())) return PyFloat_AS_DOUBLE(given.ptr());  // what sizes return, for each point
  if (is_truth_value(given) || is_masked(given)) refuse(name, "a number", given);
  const double number = PyFloat_AsDouble(given.ptr());
  if (number != -1 || PyErr_Occurred() == nullptr) return number;
  PyErr_Clear();
  refuse(name, "a number", given);
}

std::int64_t integer_from(const std::string& name, py::handle given) {
  if (is_truth_value(given) || is_masked(given)) refuse(name, "a whole number", given);
  const py::object whole = PyFloat_Check(given.ptr()) && std::floor(given.cast<double>()) == given.cast<double>()
                               ? py::reinterpret_steal<py::object>(PyNumber_Long(given.ptr()))
                               : py::reinterpret_steal<py::object>(PyNumber_Index(given.ptr()));
  int overflow = 0;
  const long long number = whole ? PyLong_AsLongLongAndOverflow(whole.ptr(), &overflow) : -1;
  PyErr_Clear();
  if (!whole) refuse(name, "a whole number", given);
  if (overflow != 0) throw py::value_error(name + " is out of range");
  return number;
}

std::int32_t short_integer_from(const std::string& name, py::handle given) {
  const std::int64_t number = integer_from(name, given);
  if (!std::in_range<std::int32_t>(number)) throw py::value_error(name + " is out of range");
  return static_cast<std::int32_t>(number);
}

std::map<std::string, std::string> texts_from(const std::string& name, py::handle given) {
  if (!py::isinstance<py::dict>(given)) refuse(name, "a dictionary", given);
  std::map<std::string, std::string> table;
  for (const auto& [entry, value] : given.cast<py::dict>())
    table[py::str(entry).cast<std::string>()] =
        PyBool_Check(value.ptr()) ? (value.cast<bool>() ? "true" : "false") : py::str(value).cast<std::string>();
  return table;
}

}  // namespace driftmesh::python
