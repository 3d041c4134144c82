#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace driftmesh::cli {

/// A command line that makes no sense. The message says why, in terms of what the user typed.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An option of a command, or a positional argument. Parsing, help, the manual page and completion derive from it.
struct Option {
  enum class Kind {
    kValue,       ///< --name VALUE
    kFlag,        ///< --name, which has no value
    kPositional,  ///< VALUE
  };
  enum class Completes { kNothing, kFile, kFolder };

  Kind kind = Kind::kValue;
  std::string name{};      ///< the long name, without dashes
  char letter = 0;         ///< the short name; 0: none
  std::string value{};     ///< the name of its value in the help: "AREA"
  std::string help{};      ///< sentences, without the last period
  std::string standard{};  ///< the default, in words
  std::string group{};     ///< its heading in the help; empty: "Options"
  bool required = false;   ///< must be given
  bool repeats = false;    ///< may be given several times
  Completes completes = Completes::kNothing;
  std::vector<std::string> choices{};  ///< the only valid values; empty: `take` decides
  std::string or_file{};               ///< besides choices, a file with this extension; empty: none
  /// Stores a value, "" for a flag. Throws a UsageError that continues the option's name: "is 5; it must be ...".
  std::function<void(const std::string&)> take{};
  std::function<std::string()> prints{};  ///< for a flag that prints this text instead of running the command
};

struct Call;

/// A command of a program, or a group of commands, or the program itself.
struct Command {
  std::string name{};
  std::string summary{};  ///< one line, without a period
  std::vector<Option> options{};
  std::vector<Command> commands{};      ///< subcommands, one of which must follow
  std::string notes{};                  ///< further information: paragraphs, separated by empty lines
  std::vector<std::string> examples{};  ///< command lines
  std::string exit_codes{};             ///< "0 done, 1 error"
  /// For a command whose words with one dash are no options of ours, "-pq30a0.1": takes each of them.
  std::function<void(const std::string&)> take_switches{};
  std::function<int(Call&)> run{};  ///< returns the exit code; throws UsageError for contradictory options
};

/// A command and the options given to it.
struct Call {
  struct Given {
    const Option* option = nullptr;
    std::string value;  ///< "" for a flag
  };
  const Command* command = nullptr;
  std::string name;                     ///< full, including those of its parents: "driftmesh generate bay"
  std::vector<Given> given;             ///< in the order of the command line
  std::function<std::string()> prints;  ///< what to print instead of running the command, if set

  [[nodiscard]] bool has(const std::string& option) const;
  /// Passes one more value to an option. Throws UsageError, like Option::take, if it is invalid.
  void give(const Option& option, const std::string& value);
};

/// The names of a command's subcommands.
[[nodiscard]] std::vector<std::string> command_names(const Command& command);

/// A command and all its subcommands with their full names, in the order of the help.
struct NamedCommand {
  std::string name;  ///< "driftmesh generate bay"
  const Command* command = nullptr;
};
[[nodiscard]] std::vector<NamedCommand> all_commands(const Command& program);

/// The spelling of an option: "--area", or "INPUT" for an argument.
[[nodiscard]] std::string spelled(const Option& option);

/// "graph, block or round-robin"
[[nodiscard]] std::string listed(const std::vector<std::string>& words);

/// " (did you mean WORD?)", where WORD is the one of `known` that was probably meant by `name`, with `dashes` before
/// it; "" if there is none.
[[nodiscard]] std::string did_you_mean(const std::string& name, const std::vector<std::string>& known,
                                       const std::string& dashes = "");

}  // namespace driftmesh::cli
