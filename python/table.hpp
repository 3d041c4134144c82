#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "api/library_request.hpp"
#include "arrays.hpp"
#include "job/keys.hpp"

/// From Python's values to members of options, as the table of keys declares them.
namespace driftmesh::python {

namespace py = pybind11;

/// Values by the names of their options.
using Given = std::map<std::string, py::object>;

/// The entries of a dictionary. None is as if it were not given.
[[nodiscard]] Given entries_of(const py::dict& dictionary);

/// The value given by this name, which is thereby taken; None without one.
[[nodiscard]] py::object taken(Given& given, const std::string& name);

/// Throws TypeError for what has not been taken, with the nearest of the known names.
void refuse_rest(const Given& given, const std::vector<std::string>& known);

/// Throws TypeError: `name` takes what is wanted, not a thing of this type.
[[noreturn]] void refuse(const std::string& name, const char* wanted, py::handle given);

/// Throws TypeError for all that is no number, such as True.
[[nodiscard]] double number_from(const std::string& name, py::handle given);
/// Throws ValueError for one of more than 64 bits.
[[nodiscard]] std::int64_t integer_from(const std::string& name, py::handle given);
/// Throws ValueError for one of more than 32 bits.
[[nodiscard]] std::int32_t short_integer_from(const std::string& name, py::handle given);
/// The values of a table by their names: policies read them as text.
[[nodiscard]] std::map<std::string, std::string> texts_from(const std::string& name, py::handle given);

/// Stores what is given for a key in a member of the options. `place`: that of the key in `request`.
template <class Member>
void take(const std::string& name, const job::Key& key, py::handle given, Member& member, job::Request& request,
          const Member& place) {
  if constexpr (std::is_same_v<Member, std::map<std::string, std::string>>) {
    member = texts_from(name, given);
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

/// The same for a value that may be among those given. `key`: its name in the table.
template <class Member>
void take_if_given(Given& given, const std::string& name, const char* key, Member& member, job::Request& request,
                   const Member& place) {
  if (const py::object value = taken(given, name); !value.is_none())
    take(name, *job::find_key(key).key, value, member, request, place);
}

}  // namespace driftmesh::python
