#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace driftmesh::python {

/// Makes Python's exceptions of those that the library throws.
void translate_errors();

/// What Python calls a key: the library's name of the option alone.
[[nodiscard]] std::string words_of_python(const std::string& key);

}  // namespace driftmesh::python
