#include "errors.hpp"

#include <exception>
#include <string_view>
#include <utility>

#include "api/library_request.hpp"
#include "base/key_error.hpp"

namespace driftmesh::python {
namespace {

namespace py = pybind11;

/// Sets the exception of this class of driftmesh, with the place where there is one.
void raise(const char* name, const Error& error, const SourcePlace& place = {}) {
  const py::object type = py::module_::import("driftmesh._errors").attr(name);
  const py::object exception = type(text_of(error).in(words_of_python));
  if (!place.file.empty()) exception.attr("file") = place.file;
  if (place.line > 0) exception.attr("line") = place.line;
  PyErr_SetObject(type.ptr(), exception.ptr());
}

void translate(std::exception_ptr thrown) {
  if (!thrown) return;
  try {
    std::rethrow_exception(std::move(thrown));
  } catch (const InputError& error) {
    raise("InputError", error, error.place());
  } catch (const FileError& error) {
    raise("FileError", error, {error.file(), 0});
  } catch (const LimitError& error) {
    raise("LimitError", error);
  } catch (const Cancelled& error) {
    raise("Cancelled", error);
  } catch (const Error& error) {
    raise("Error", error);
  }
}

}  // namespace

void translate_errors() {
  py::register_local_exception_translator(translate);
}

std::string words_of_python(const std::string& key) {
  const std::string member = library_name(key).member;
  const std::string_view sizes = "sizes.";  // their members are arguments of adapt_part
  return member.starts_with(sizes) ? member.substr(sizes.size()) : member;
}

}  // namespace driftmesh::python
