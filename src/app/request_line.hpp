#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cli/command.hpp"
#include "config/experiment.hpp"
#include "job/key.hpp"
#include "job/request.hpp"

namespace driftmesh::app {

/// The keys that a command line has given values, in their order, as its words.
struct GivenKeys {
  struct Item {
    const job::Key* key = nullptr;
    std::string text;  ///< "" for a flag that has no value
  };
  std::vector<Item> items;

  /// Gives `request` these values. Lists and tables of a command line take the place of those that the request has.
  /// Throws KeyError.
  void apply(job::Request& request) const;
};

/// The options of the keys that a door of the command line knows, which note in `given` what they are given; it must
/// outlive them. `group` names the heading for all of them, in place of their own.
[[nodiscard]] std::vector<cli::Option> key_options(job::Door door, GivenKeys& given, const std::string& group = "");

/// Throws the error of a key in the words of its option, as a UsageError, or, if a YAML file has given the key, with
/// its place there.
[[noreturn]] void throw_with_option(const job::KeyError& error, const GivenKeys& given,
                                    const config::SourcePlaces& places);

/// Does `work` on the request of a command line; KeyErrors in it become UsageErrors in the words of the options, or,
/// for what a YAML file has given, InputErrors with its place there.
template <class Work>
void in_words_of_options(const GivenKeys& given, const config::SourcePlaces& places, const Work& work) {
  try {
    work();
  } catch (const job::KeyError& error) {
    throw_with_option(error, given, places);
  }
}

/// The command line that asks for the same at a door: every key with an option whose value is not the default, quoted
/// for a shell. `name` begins it: "driftmesh mesh".
[[nodiscard]] std::string command_line_of(const std::string& name, const job::Request& request, job::Door door);

/// A word as a POSIX shell reads it back.
[[nodiscard]] std::string shell_quoted(const std::string& word);

}  // namespace driftmesh::app
