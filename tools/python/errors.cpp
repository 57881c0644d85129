#include <nanobind/nanobind.h>

#include <exception>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/visible_text.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/tools/python/bindings.h"

namespace roadbed::tools::inline python {
namespace {

PyObject* error_type = nullptr;
PyObject* input_error_type = nullptr;
PyObject* output_error_type = nullptr;

// As a text whose bytes are no UTF-8 too: names of files may be any.
nb::str text(const std::string& of) {
  const std::string shown = map::visible_text(of);
  return nb::steal<nb::str>(
      PyUnicode_DecodeUTF8(shown.data(), static_cast<Py_ssize_t>(shown.size()), "replace"));
}

void raise(PyObject* type, const map::InputError& error) {
  nb::object made = nb::borrow(type)(text(error.what()));
  const map::InputError::Parts& parts = error.parts();
  made.attr("file") = text(parts.file);
  made.attr("place") = text(parts.place);
  made.attr("element") = text(parts.element);
  made.attr("found") = text(parts.found);
  made.attr("needed") = text(parts.needed);
  made.attr("remedy") = text(parts.remedy);
  PyErr_SetObject(type, made.ptr());
}

PyObject* make_error(nb::module_& module, const char* name, nb::object bases, const char* what) {
  PyObject* made = PyErr_NewExceptionWithDoc(("roadbed." + std::string(name)).c_str(), what,
                                             bases.ptr(), nullptr);
  module.attr(name) = nb::borrow(made);
  return made;  // lives as long as the process
}

}  // namespace

void bind_errors(nb::module_& module) {
  const nb::object value_error = nb::borrow(PyExc_ValueError), os_error = nb::borrow(PyExc_OSError);
  error_type = make_error(module, "Error", nb::borrow(PyExc_Exception),
                          "What this package raises of its own.");
  const nb::object base = nb::borrow(error_type);
  input_error_type = make_error(
      module, "InputError", nb::make_tuple(base, value_error),
      "An input that cannot be used. Its text is the line that the program prints; what the line "
      "is made of stands in `file`, `place` (a line or byte), `element`, `found`, `needed` and "
      "`remedy`, each a text that may be empty.");
  output_error_type =
      make_error(module, "OutputError", nb::make_tuple(base, os_error),
                 "An output that cannot be written, for want of space or rights; nothing of it is "
                 "left behind. Its parts are those of InputError.");
  nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
    try {
      std::rethrow_exception(thrown);
    } catch (const map::OutputError& error) {
      raise(output_error_type, error);
    } catch (const map::InputError& error) {
      raise(input_error_type, error);
    }
  });
}

}  // namespace roadbed::tools::python
