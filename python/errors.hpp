#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace driftmesh::python {

/// Makes Python's exceptions of those that the library throws.
void translate_errors();

/// A message of the library in the words of Python: an option is called by its name alone.
[[nodiscard]] std::string in_words_of_python(std::string message);

}  // namespace driftmesh::python
