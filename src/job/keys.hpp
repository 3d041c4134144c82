#pragma once

#include <functional>
#include <string>
#include <vector>

#include "job/key.hpp"

namespace driftmesh::job {

/// All keys, in the order of their sections.
[[nodiscard]] const std::vector<Key>& keys();

/// A key, or one name in a table of names: "input.parameters.seed".
struct KeyPath {
  const Key* key = nullptr;  ///< null: not found
  std::string entry;         ///< name in a kTable; empty: the table as a whole
  bool negated = false;      ///< given by an option that begins with "no-"
};

/// By its full name.
[[nodiscard]] KeyPath find_key(const std::string& name);
/// By the long name of its option: "area", "no-region-areas".
[[nodiscard]] KeyPath find_option(const std::string& option);

/// The name of a key, section or option of these entry points that was probably meant.
[[nodiscard]] std::string nearest_key(const std::string& name, EntryPoints entry_point);

/// The choices of a key at this entry point.
[[nodiscard]] std::vector<std::string> choices_at(const KeyInfo& key, EntryPoint entry_point);

/// Whether this value of the key is the name of a file that is read.
[[nodiscard]] bool names_file(const KeyInfo& key, const std::string& text);

/// The files that a value of a table of files names, with commas between them. A file that has some in its own name is
/// one.
[[nodiscard]] std::vector<std::string> files_in(const std::string& text);

/// The same in a message: "a.tif and 9 more".
[[nodiscard]] std::string words_of_files(const std::string& text);

/// The value with each file that it names replaced by what `moved` makes of it.
[[nodiscard]] std::string with_files(const KeyInfo& key, const std::string& text,
                                     const std::function<std::string(const std::string&)>& moved);

/// The key whose value is a file of code, which runs when it is loaded, or null: a policy in a shared library.
[[nodiscard]] const Key* key_with_code(const Request& request);

/// Reads the text of a value, for keys with a single value: kText, kFile, kOutput, kNumber, kInteger, kFlag or kChoice;
/// for a kNumbers key, reads one of its numbers, as double. Throws KeyError for an invalid value.
[[nodiscard]] Value read_value(const KeyInfo& key, const std::string& text);

/// Throws KeyError for a value out of the range of its key.
void check_range(const KeyInfo& key, double value);

/// Stores a value of the right kind and range.
void store(Request& request, const KeyPath& path, const Value& value);

}  // namespace driftmesh::job
