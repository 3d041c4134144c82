#pragma once

#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiment/experiment.hpp"

namespace driftmesh::experiment {

using Json = nlohmann::ordered_json;

/// What a key means and what its value may be. Reading, checking, printing, the JSON schema and the table in
/// docs/experiments.md all come from this.
struct KeyInfo {
  enum class Kind {
    kText,
    kFile,  ///< a name of a file; in an experiment's file it is relative to that file
    kNumber,
    kInteger,
    kFlag,
    kChoice,
    kTable,    ///< names and values, known to what reads them
    kList,     ///< of tables with the keys of `fields`
    kNumbers,  ///< a list, each from `least` to `most`
  };
  std::string name;  ///< with its sections: "bounds.angle"
  std::string help;
  Kind kind = Kind::kText;
  Json standard;  ///< its value where none is given
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool above = false;                ///< more than `least`, not equal to it
  std::vector<std::string> choices;  ///< kChoice
  std::vector<KeyInfo> fields;       ///< kList
};

/// A key, and where its value is kept.
struct Key : KeyInfo {
  std::function<void(Experiment&, const Json&)> store;  ///< a value of the right kind and range
  std::function<Json(const Experiment&)> load;
};

/// All keys, in the order of their sections.
[[nodiscard]] const std::vector<Key>& keys();

/// A key, or one name in a table of names: "input.parameters.seed".
struct KeyPath {
  const Key* key = nullptr;  ///< null: there is none
  std::string entry;         ///< of a kTable; empty: the table as a whole
};
[[nodiscard]] KeyPath find_key(const std::string& name);

/// The key or section that was probably meant.
[[nodiscard]] std::string nearest_key(const std::string& name);

/// Stores a value of the right kind and range.
void store(Experiment& experiment, const KeyPath& path, const Json& value);

}  // namespace driftmesh::experiment
