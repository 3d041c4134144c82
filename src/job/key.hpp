#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "job/request.hpp"
#include "job/value.hpp"

namespace driftmesh::job {

/// Where a mesh is made; sets of places are sums.
enum Place : unsigned {
  kOnePiece = 1,    ///< the whole domain as one piece, in this process
  kSubdomains = 2,  ///< in subdomains, in this process
  kRanks = 4,       ///< in subdomains, on the ranks of a communicator
  kSimulated = 8,   ///< in subdomains, on ranks in virtual time
};
using Places = unsigned;
inline constexpr Places kMany = kRanks | kSimulated;
inline constexpr Places kCut = kSubdomains | kMany;
inline constexpr Places kAnywhere = kOnePiece | kCut;

/// Who asks; sets of doors are sums.
enum Door : unsigned {
  kMesh = 1,        ///< driftmesh mesh, and its YAML file
  kDecompose = 2,   ///< driftmesh decompose
  kCheck = 4,       ///< driftmesh check, which has bounds to check against
  kExperiment = 8,  ///< driftmesh run: a YAML file and its --set
  kLibrary = 16,    ///< a program, by the options of the library
};
using Doors = unsigned;
inline constexpr Doors kMeshers = kMesh | kExperiment | kLibrary;

/// What a key means and what its value may be. The command line and its help, YAML files and their schema, the manual
/// page, completion and the table in docs/experiments.md all come from this.
struct KeyInfo {
  enum class Kind {
    kText,
    kFile,     ///< a file that is read; in a YAML file its name is relative to that file
    kOutput,   ///< a file that is written
    kOutputs,  ///< several
    kNumber,   ///< with a unit k, M, G or T, or none
    kInteger,  ///< the same, whole
    kFlag,
    kChoice,
    kTable,    ///< names and values, known to what reads them
    kList,     ///< of records with the keys of `fields`
    kNumbers,  ///< a list, each from `least` to `most`
  };
  std::string name;  ///< with its section: "bounds.angle"
  std::string help;  ///< one line
  Kind kind = Kind::kText;
  std::string unit;  ///< "degrees", "seconds", "bytes" (then a unit k, M, ... stands for powers of 1024), or empty
  Value standard;    ///< its value where none is given
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool above = false;                ///< more than `least`, not equal to it
  std::string why_not_more;          ///< why the value ends at `most`, or empty
  std::vector<std::string> choices;  ///< kChoice
  std::vector<KeyInfo> fields;       ///< kList

  Places places = kAnywhere;  ///< where it has a meaning; given elsewhere it is refused
  Doors doors = kMeshers;     ///< who can say it

  // On the command line of the doors mesh, decompose and check.
  std::string option;       ///< its long name without dashes; empty: it has none. "no-..." sets a flag to false
  char letter = 0;          ///< its short name
  std::string value_name;   ///< what help calls its value: "AREA"
  std::string option_help;  ///< what help says in place of `help`: of an option that sets a flag to false
  std::string group;        ///< the heading of help that it stands under
};

/// A key, and where a request keeps its value.
struct Key : KeyInfo {
  std::function<void(Request&, const Value&)> store;  ///< a value of the right kind and range
  std::function<Value(const Request&)> load;
};

/// A value that cannot be, or cannot be together with others, or where it was given: the key to look at, what it does
/// wrong
/// ("is -5"), and what to do. The message names keys by their full names; whoever has better words, a place in a file
/// or an option, puts them in.
class KeyError : public Error {
 public:
  KeyError(std::string key, const std::string& what, const std::string& next)
      : Error(key + " " + what + "; " + next), key_(std::move(key)), what_(what), next_(next) {}
  [[nodiscard]] const std::string& key() const { return key_; }
  [[nodiscard]] const std::string& problem() const { return what_; }
  [[nodiscard]] const std::string& next() const { return next_; }

 private:
  std::string key_;
  std::string what_;
  std::string next_;
};

}  // namespace driftmesh::job
