#include "options.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <type_traits>
#include <utility>

#include "api/library_request.hpp"
#include "arrays.hpp"
#include "base/nearest_name.hpp"
#include "job/keys.hpp"

namespace driftmesh::python {
namespace {

using Given = std::map<std::string, py::object>;

[[noreturn]] void refuse(const std::string& name, const char* wanted, py::handle given) {
  throw py::type_error(name + " takes " + wanted + ", not " + Py_TYPE(given.ptr())->tp_name);
}

double number_from(const std::string& name, py::handle given) {
  const double number = PyFloat_AsDouble(given.ptr());
  if (number != -1 || PyErr_Occurred() == nullptr) return number;
  PyErr_Clear();
  refuse(name, "a number", given);
}

std::int64_t integer_from(const std::string& name, py::handle given) {
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

/// The values of a table by their names: policies read them as text.
std::map<std::string, std::string> table_of(const std::string& name, py::handle given) {
  if (!py::isinstance<py::dict>(given)) refuse(name, "a dictionary", given);
  std::map<std::string, std::string> table;
  for (const auto& [entry, value] : given.cast<py::dict>())
    table[py::str(entry).cast<std::string>()] =
        PyBool_Check(value.ptr()) ? (value.cast<bool>() ? "true" : "false") : py::str(value).cast<std::string>();
  return table;
}

/// Stores what is given for a key in a member of the options. `place`: that of the key in `request`.
template <class Member>
void take(const std::string& name, const job::Key& key, py::handle given, Member& member, job::Request& request,
          const Member& place) {
  if constexpr (std::is_same_v<Member, std::map<std::string, std::string>>) {
    member = table_of(name, given);
  } else if constexpr (std::is_same_v<Member, std::vector<double>>) {
    member = numbers_from(given, name).values;
  } else if (py::isinstance<py::str>(given)) {  // as in a file: a choice, or a number with a unit such as 6G
    key.store(request, job::read_value(key, given.cast<std::string>()));
    member = place;
  } else if constexpr (std::is_same_v<Member, bool>) {
    if (!PyBool_Check(given.ptr())) refuse(name, "True or False", given);
    member = given.cast<bool>();
  } else if constexpr (std::is_integral_v<Member>) {
    const std::int64_t number = integer_from(name, given);
    if (!std::in_range<Member>(number)) job::check_range(key, static_cast<double>(number));
    member = static_cast<Member>(number);
  } else if constexpr (std::is_floating_point_v<Member>) {
    member = number_from(name, given);
  } else {
    refuse(name, "a name", given);
  }
}

/// "subdomains" of "subdomains.count"; empty if there is none.
std::string section_of(const std::string& name) {
  const std::size_t dot = name.find('.');
  return dot == std::string::npos ? "" : name.substr(0, dot);
}

/// The options that are functions, which no table of keys can hold.
constexpr const char* kCallables[] = {"warning", "size", "progress"};

std::vector<std::string> names_of_options() {
  std::vector<std::string> names(std::begin(kCallables), std::end(kCallables));
  job::Request unused;
  visit_options(MeshOptions{}, unused,
                [&](const char*, const char* member, const auto&, const auto&) { names.emplace_back(member); });
  return names;
}

/// The arguments by the full names of their options. None is as if it were not given.
Given flattened(const py::kwargs& arguments) {
  const std::vector<std::string> names = names_of_options();
  Given given;
  for (const auto& [key, value] : arguments) {
    const auto name = key.cast<std::string>();
    const bool is_section =
        std::any_of(names.begin(), names.end(), [&](const auto& n) { return section_of(n) == name; });
    if (is_section && !py::isinstance<py::dict>(value)) refuse(name, "a dictionary of options", value);
    if (!is_section) given[name] = py::reinterpret_borrow<py::object>(value);
    if (is_section)
      for (const auto& [entry, inner] : value.template cast<py::dict>())
        given[name + "." + py::str(entry).template cast<std::string>()] = py::reinterpret_borrow<py::object>(inner);
  }
  std::erase_if(given, [](const auto& entry) { return entry.second.is_none(); });
  return given;
}

/// The value given by this name, which is thereby taken; None without one.
py::object taken(Given& given, const std::string& name) {
  const auto found = given.extract(name);
  return found.empty() ? py::none() : std::move(found.mapped());
}

py::object callable(Given& given, const std::string& name) {
  py::object found = taken(given, name);
  if (!found.is_none() && PyCallable_Check(found.ptr()) == 0) refuse(name, "a callable", found);
  return found;
}

/// True stands for the progress that comes with the package, False for none.
py::object progress_from(Given& given) {
  const auto found = given.find("progress");
  if (found == given.end() || !PyBool_Check(found->second.ptr())) return callable(given, "progress");
  return taken(given, "progress").cast<bool>() ? py::module_::import("driftmesh._progress").attr("ProgressLine")()
                                               : py::none();
}

py::object object_of(const job::Value& value) {
  const auto object = [](const auto& held) -> py::object {
    if constexpr (std::is_same_v<std::decay_t<decltype(held)>, std::vector<job::Record>>)
      return py::none();  // no option holds records
    else
      return py::cast(held);
  };
  return std::visit(object, static_cast<const job::Value::variant&>(value));
}

const char* kind_name(job::KeyInfo::Kind kind) {
  using Kind = job::KeyInfo::Kind;
  switch (kind) {
    case Kind::kFlag:
      return "bool";
    case Kind::kInteger:
      return "int";
    case Kind::kNumber:
      return "float";
    case Kind::kNumbers:
      return "list[float]";
    case Kind::kTable:
      return "dict[str, object]";
    default:
      return "str";
  }
}

constexpr const char* kCallableLines =
    "    size (callable): size(x, y) is the target edge length there, positive or infinite. Called once for each "
    "point\n"
    "        of a grid (size_resolution) in the domain, and for each point of the mesh.\n"
    "    progress (callable or bool): progress(p) is called at most twenty times a second with p.triangles made and\n"
    "        p.forecast expected; returning False ends the work with Cancelled. True: a line in the terminal or "
    "notebook.\n"
    "    warning (callable): warning(text) is called for what the author of the input may not have meant; by default,\n"
    "        Python's warnings.warn with InputWarning.\n";

}  // namespace

Options::Options(const py::kwargs& arguments) {
  Given given = flattened(arguments);
  job::Request request;
  with_words_of_options([&] {
    visit_options(values_, request, [&](const char* key, const char* name, auto& member, const auto& place) {
      if (const py::object value = taken(given, name); !value.is_none())
        take(name, *job::find_key(key).key, value, member, request, place);
    });
  });
  take_callables(given);
  if (!given.empty()) {
    const std::string& unknown = given.begin()->first;
    throw py::type_error("there is no option '" + unknown + "'; the nearest one is '" +
                         nearest_name(unknown, names_of_options()) + "'");
  }
}

void Options::take_callables(Given& given) {
  size_ = callable(given, "size");
  progress_ = progress_from(given);
  warning_ = callable(given, "warning");
  if (warning_.is_none()) warning_ = py::module_::import("driftmesh._errors").attr("warn");
  if (!size_.is_none())
    values_.size = [this](const Point& p) {
      return callbacks_.ask([&] { return number_from("what size returns", size_(p.x, p.y)); });
    };
  values_.progress = [this](const Progress& now) { return callbacks_.goes_on(progress_, now); };
  values_.warning = [this](const std::string& text) { callbacks_.ask([&] { warning_(text); }); };
}

py::list option_table() {
  py::list table;
  job::Request request = request_of(MeshOptions{});
  visit_options(MeshOptions{}, request, [&](const char* name, const char* member, const auto&, const auto&) {
    const job::Key& key = *job::find_key(name).key;
    py::dict option;
    option["name"] = member;
    option["kind"] = kind_name(key.kind);
    option["unit"] = key.unit;
    option["default"] = object_of(key.load(request));
    option["least"] = key.least;
    option["most"] = key.most;
    option["choices"] = key.choices;
    option["help"] = key.help;
    table.append(option);
  });
  return table;
}

std::string option_lines() {
  std::string lines = kCallableLines;
  const job::Request request = request_of(MeshOptions{});
  job::Request unused;
  visit_options(MeshOptions{}, unused, [&](const char* name, const char* member, const auto&, const auto&) {
    const job::Key& key = *job::find_key(name).key;
    lines += std::string("    ") + member + " (" + kind_name(key.kind) + (key.unit.empty() ? "" : ", " + key.unit) +
             "; default " + job::text_of(key.load(request)) + "): " + key.help + "\n";
  });
  return lines;
}

}  // namespace driftmesh::python
