#include "options.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <string>
#include <type_traits>
#include <utility>

#include "api/library_request.hpp"
#include "decomposition_class.hpp"
#include "driftmesh/size_rule.hpp"
#include "job/keys.hpp"
#include "policy.hpp"
#include "size_class.hpp"
#include "table.hpp"

namespace driftmesh::python {
namespace {

/// "subdomains" of "subdomains.count"; empty if there is none.
std::string section_of(const std::string& name) {
  const std::size_t dot = name.find('.');
  return dot == std::string::npos ? "" : name.substr(0, dot);
}

/// The options that are functions or objects, which no table of keys can hold.
constexpr const char* kCallables[] = {"warning", "size", "progress", "subdomains.given", "balance.own"};

std::vector<std::string> names_of_options() {
  std::vector<std::string> names(std::begin(kCallables), std::end(kCallables));
  job::Request unused;
  visit_options(MeshOptions{}, unused,
                [&](const char*, const char* member, const auto&, const auto&) { names.emplace_back(member); });
  return names;
}

/// The arguments by the full names of their options.
Given flattened(const py::kwargs& arguments, const std::vector<std::string>& names) {
  Given given;
  for (const auto& [name, value] : entries_of(arguments)) {
    const bool is_section =
        std::any_of(names.begin(), names.end(), [&n = name](const auto& option) { return section_of(option) == n; });
    if (!is_section) {
      given[name] = value;
      continue;
    }
    if (!py::isinstance<py::dict>(value)) refuse(name, "a dictionary of options", value);
    for (const auto& [entry, inner] : entries_of(value)) given[name + "." + entry] = inner;
  }
  return given;
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
    "        Python's warnings.warn with InputWarning.\n"
    "    subdomains.given (Decomposition): from cut_domain(), instead of a number of subdomains.\n"
    "    balance.own (object or callable): a policy, see simulate().\n";

}  // namespace

Options::Options(const py::kwargs& arguments) {
  const std::vector<std::string> names = names_of_options();
  Given given = flattened(arguments, names);
  job::Request request;
  visit_options(values_, request, [&](const char* key, const char* name, auto& member, const auto& place) {
    take_if_given(given, name, key, member, request, place);
  });
  take_callables(given);
  refuse_rest(given, names);
}

void Options::take_callables(Given& given) {
  size_ = callable(given, "size");
  progress_ = progress_from(given);
  warning_ = callable(given, "warning");
  if (warning_.is_none()) warning_ = py::module_::import("driftmesh._errors").attr("warn");
  if (py::isinstance<FieldObject>(size_))
    values_.size = std::ref(*size_.cast<const FieldObject&>().field);
  else if (py::isinstance<SizeRule>(size_))
    values_.size = size_.cast<const SizeRule&>();
  else if (!size_.is_none())
    values_.size = [this](const Point& p) {
      return callbacks_.ask([&] { return number_from("what size returns", size_(p.x, p.y)); });
    };
  if (const py::object cut = taken(given, "subdomains.given"); py::isinstance<CutDomain>(cut))
    values_.subdomains.given = cut.cast<const CutDomain&>().decomposition;
  else if (!cut.is_none())
    refuse("subdomains.given", "a Decomposition", cut);
  if (const py::object own = taken(given, "balance.own"); !own.is_none())
    values_.balance.own = policy_from(own, callbacks_);
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
