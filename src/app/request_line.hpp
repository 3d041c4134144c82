#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cli/command.hpp"
#include "config/experiment.hpp"
#include "job/key.hpp"
#include "job/request.hpp"

namespace driftmesh::app {

/// The keys given on a command line, in order, with their words.
struct GivenKeys {
  struct Item {
    const job::Key* key = nullptr;
    std::string text;  ///< "" for a flag that has no value
  };
  std::vector<Item> items;

  /// The names of the keys.
  [[nodiscard]] std::set<std::string> names() const;

  /// Stores these values in `request`. Lists and tables from a command line replace those of the request. Throws
  /// KeyError.
  void apply(job::Request& request) const;
};

/// The options of the keys that an entry point of the command line knows. They record their values in `given`, which
/// must outlive them. `group` is the heading for all of them, instead of their own.
[[nodiscard]] std::vector<cli::Option> key_options(job::EntryPoint entry_point, GivenKeys& given,
                                                   const std::string& group = "");

/// Rethrows the error of a key in terms of its option, as a UsageError, or, if the key came from a YAML file, with its
/// place there.
[[noreturn]] void throw_with_option(const job::KeyError& error, const GivenKeys& given,
                                    const config::SourcePlaces& places);

/// Does `work` on the request of a command line; KeyErrors become UsageErrors in terms of the options or, for keys from
/// a YAML file, InputErrors with the place there.
template <class Work>
void in_words_of_options(const GivenKeys& given, const config::SourcePlaces& places, const Work& work) {
  try {
    work();
  } catch (const job::KeyError& error) {
    throw_with_option(error, given, places);
  }
}

/// The command line for the same request at an entry point: every key with an option and a value other than the
/// default, quoted for a shell. It starts with `name`: "driftmesh mesh".
[[nodiscard]] std::string command_line_of(const std::string& name, const job::Request& request,
                                          job::EntryPoint entry_point);

/// A word quoted for a POSIX shell.
[[nodiscard]] std::string shell_quoted(const std::string& word);

}  // namespace driftmesh::app
