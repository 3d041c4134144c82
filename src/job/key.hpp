#pragma once

#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "base/key_error.hpp"
#include "job/request.hpp"
#include "job/value.hpp"

namespace driftmesh::job {

using driftmesh::KeyError;
using driftmesh::KeyText;

/// Where a mesh is made; sets of places are sums.
enum PlaceKind : unsigned {
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
  kPlot = 32,       ///< driftmesh plot, for sizes
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
    kList,     ///< records with the keys of `fields`
    kNumbers,  ///< a list, each from `least` to `most`
  };
  std::string name;  ///< with its section: "bounds.angle"
  std::string help;  ///< one line
  Kind kind = Kind::kText;
  std::string unit;  ///< "degrees", "seconds", "bytes" (then a unit k, M, ... stands for powers of 1024), or empty
  Value standard;    ///< its default
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool above = false;                          ///< must be greater than `least`, not equal
  std::string why_not_more;                    ///< the reason for the limit `most`, or empty
  std::vector<std::string> choices;            ///< kChoice
  std::map<std::string, EntryPoint> reserved;  ///< kChoice: those that only one entry point has
  std::string or_file;                         ///< kChoice: the extension of a file that may be named instead, or empty
  bool of_files = false;                       ///< kTable: its values name files, as a kFile does
  std::vector<KeyInfo> fields;                 ///< kList

  Places places = kAnywhere;            ///< where it applies; elsewhere it is rejected
  EntryPoints entry_points = kMeshers;  ///< where it can be given

  // On the command lines of mesh, decompose and check:
  std::string option;       ///< its long name without dashes; empty: none. "no-..." sets a flag to false
  char letter = 0;          ///< its short name
  std::string value_name;   ///< the name of its value in the help: "AREA"
  std::string option_help;  ///< replaces `help`, where an option says something else
  std::string group;        ///< its heading in the help
};

/// A key, and access to its value in a request.
struct Key : KeyInfo {
  std::function<void(Request&, const Value&)> store;  ///< a value of the right kind and range
  std::function<Value(const Request&)> load;
};

}  // namespace driftmesh::job
