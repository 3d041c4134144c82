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

/// The entry points of the product; sets of them are sums.
enum EntryPoint : unsigned {
  kMesh = 1,        ///< driftmesh mesh and its YAML file
  kDecompose = 2,   ///< driftmesh decompose
  kCheck = 4,       ///< driftmesh check, for the bounds
  kExperiment = 8,  ///< driftmesh run: a YAML file and --set
  kLibrary = 16,    ///< a program that uses the library
};
using EntryPoints = unsigned;
inline constexpr EntryPoints kMeshers = kMesh | kExperiment | kLibrary;

/// The declaration of a key: its meaning and valid values. The command line and its help, YAML files and their schema,
/// the manual page, completion and the table in docs/experiments.md derive from it.
struct KeyInfo {
  enum class Kind {
    kText,
    kFile,     ///< a file that is read; in a YAML file its name is relative to that file
    kOutput,   ///< a file that is written
    kOutputs,  ///< several
    kNumber,   ///< with a unit k, M, G or T, or none
    kInteger,  ///< likewise, a whole number
    kFlag,
    kChoice,
    kTable,    ///< names and values, known to their reader
    kList,     ///< of records with the keys of `fields`
    kNumbers,  ///< a list, each from `least` to `most`
  };
  std::string name;  ///< with its section: "bounds.angle"
  std::string help;  ///< one line
  Kind kind = Kind::kText;
  std::string unit;  ///< "degrees", "seconds", "bytes" (then a unit k, M, ... stands for powers of 1024), or empty
  Value standard;    ///< its default
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool above = false;                ///< must be greater than `least`, not equal
  std::string why_not_more;          ///< the reason for the limit `most`, or empty
  std::vector<std::string> choices;  ///< kChoice
  std::string or_file;               ///< kChoice: the extension of a file that may be named instead, or empty
  bool of_files = false;             ///< kTable: its values name files, as a kFile does
  std::vector<KeyInfo> fields;       ///< kList

  Places places = kAnywhere;            ///< where it applies; elsewhere it is rejected
  EntryPoints entry_points = kMeshers;  ///< where it can be given

  // On the command lines of mesh, decompose and check:
  std::string option;       ///< its long name without dashes; empty: none. "no-..." sets a flag to false
  char letter = 0;          ///< its short name
  std::string value_name;   ///< the name of its value in the help: "AREA"
  std::string option_help;  ///< replaces `help`, for an option that sets a flag to false
  std::string group;        ///< its heading in the help
};

/// A key, and access to its value in a request.
struct Key : KeyInfo {
  std::function<void(Request&, const Value&)> store;  ///< a value of the right kind and range
  std::function<Value(const Request&)> load;
};

/// A value that is invalid, or invalid in combination with others or at the place where it was given: the key
/// concerned, the problem ("is -5"), and what to do. The message names keys by their full names; callers that know
/// better words, such as a place in a file or an option, replace them.
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
