#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace driftmesh::cli {

/// A command line that cannot be meant. The message says why, in the words that the user typed.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An option of a command, or a positional argument. Parsing, help, the manual page and completion all come from this.
struct Option {
  enum class Kind {
    kValue,       ///< --name VALUE
    kFlag,        ///< --name, which has no value
    kPositional,  ///< VALUE
  };
  enum class Completes { kNothing, kFile, kFolder };

  Kind kind = Kind::kValue;
  std::string name{};      ///< long, without its dashes
  char letter = 0;         ///< the short one; 0: there is none
  std::string value{};     ///< what help calls the value: "AREA"
  std::string help{};      ///< sentences, without the last period
  std::string standard{};  ///< what holds where it is not given, in words
  std::string group{};     ///< the heading of help that it stands under; empty: "Options"
  bool required = false;   ///< must be given
  bool repeats = false;    ///< may be given several times
  Completes completes = Completes::kNothing;
  std::vector<std::string> choices{};  ///< the only values that are allowed; empty: ask `take`
  /// Stores a value, "" for a flag. Throws a UsageError that goes on behind the option's name: "is 5; it must be ...".
  std::function<void(const std::string&)> take{};
  std::function<std::string()> prints{};  ///< a flag that prints this in place of what the command does
};

struct Call;

/// A command of a program, or a group of commands, or the program itself.
struct Command {
  std::string name{};
  std::string summary{};  ///< one line, without a period
  std::vector<Option> options{};
  std::vector<Command> commands{};      ///< one of these must follow
  std::string notes{};                  ///< what else there is to know: paragraphs, with empty lines between them
  std::vector<std::string> examples{};  ///< command lines
  std::string exit_codes{};             ///< "0 done, 1 error"
  std::function<int(Call&)> run{};      ///< returns the exit code; throws UsageError for options that contradict
};

/// A command, and the options that it was called with.
struct Call {
  struct Given {
    const Option* option = nullptr;
    std::string value;  ///< "" for a flag
  };
  const Command* command = nullptr;
  std::string name;                     ///< with the names of what it belongs to: "driftmesh generate bay"
  std::vector<Given> given;             ///< in the order of the command line
  std::function<std::string()> prints;  ///< what to print instead of running the command, if anything

  [[nodiscard]] bool has(const std::string& option) const;
  /// Gives one more option its value. Throws UsageError, as Option::take does, if it is not allowed.
  void give(const Option& option, const std::string& value);
};

/// The names of the commands directly below one.
[[nodiscard]] std::vector<std::string> command_names(const Command& command);

/// A command and those below it, each with its name in full, in the order of help.
struct NamedCommand {
  std::string name;  ///< "driftmesh generate bay"
  const Command* command = nullptr;
};
[[nodiscard]] std::vector<NamedCommand> all_commands(const Command& program);

/// As it is typed: "--area", or "INPUT" for an argument.
[[nodiscard]] std::string spelled(const Option& option);

/// "graph, block or round-robin"
[[nodiscard]] std::string listed(const std::vector<std::string>& words);

/// " (did you mean WORD?)", WORD being that of `known` that `name` was probably meant to be, with `dashes` before it;
/// "" if there is none.
[[nodiscard]] std::string did_you_mean(const std::string& name, const std::vector<std::string>& known,
                                       const std::string& dashes = "");

}  // namespace driftmesh::cli
