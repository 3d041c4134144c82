#include "cli/command_line.hpp"

#include <algorithm>
#include <iostream>

#include "base/standard_streams.hpp"
#include "cli/help_text.hpp"

namespace driftmesh::cli {
namespace {

class Parser {
 public:
  Parser(const Command& program, const std::vector<std::string>& words, Call& call) : words_(words), call_(call) {
    enter(program);
  }

  void parse() {
    bool only_arguments = false;
    while (at_ < words_.size() && !call_.prints) {
      const std::string& word = words_[at_++];
      if (only_arguments || !word.starts_with('-') || is_standard_stream(word))
        argument(word);
      else if (word == "--")
        only_arguments = true;
      else if (word.starts_with("--"))
        long_option(word);
      else
        short_options(word);
    }
    if (!call_.prints) require_all();
  }

 private:
  [[nodiscard]] const Command& command() const { return *call_.command; }

  void enter(const Command& command) {
    call_.name += (call_.command == nullptr ? "" : " ") + command.name;
    call_.command = &command;
  }

  void argument(const std::string& word) {
    if (!command().commands.empty()) return subcommand(word);
    for (const Option& option : command().options)
      if (option.kind == Option::Kind::kPositional && (option.repeats || !call_.has(option.name)))
        return give(option, word);
    throw UsageError("unexpected argument '" + word + "'");
  }

  void subcommand(const std::string& word) {
    for (const Command& below : command().commands)
      if (below.name == word) return enter(below);
    throw UsageError("unknown command '" + word + "'" + did_you_mean(word, command_names(command())));
  }

  // "--name", "--name VALUE" or "--name=VALUE"
  void long_option(const std::string& word) {
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    const Option& option = find(name, [&](const Option& o) { return "--" + o.name == name; });
    if (option.kind != Option::Kind::kFlag)
      give(option, equals == std::string::npos ? next_word(option) : word.substr(equals + 1));
    else if (equals == std::string::npos)
      give(option, "");
    else
      throw UsageError(name + " takes no value");
  }

  // "-abc" is "-a -b -c", or "-a bc" if -a has a value.
  void short_options(const std::string& word) {
    for (std::size_t i = 1; i < word.size() && !call_.prints; ++i) {
      const Option& option = find({'-', word[i]}, [&](const Option& o) { return o.letter == word[i]; });
      if (option.kind == Option::Kind::kFlag) {
        give(option, "");
        continue;
      }
      give(option, i + 1 < word.size() ? word.substr(i + 1) : next_word(option));
      return;
    }
  }

  template <class Matches>
  const Option& find(const std::string& name, const Matches& matches) const {
    std::vector<std::string> known;
    for (const OptionGroup& group : option_groups(command()))
      for (const Option* option : group.options) {
        if (option->kind == Option::Kind::kPositional) continue;
        if (matches(*option)) return *option;
        known.push_back(option->name);
      }
    throw UsageError("unknown option " + name +
                     (name.starts_with("--") ? did_you_mean(name.substr(2), known, "--") : ""));
  }

  const std::string& next_word(const Option& option) {
    if (at_ == words_.size()) throw UsageError(spelled(option) + " needs a value: " + option.value);
    return words_[at_++];
  }

  void give(const Option& option, const std::string& value) {
    try {
      call_.give(option, value);
    } catch (const UsageError& error) {
      throw UsageError(spelled(option) + ": " + error.what());
    }
    call_.prints = option.prints;
    if (&option == &help_option())
      call_.prints = [name = call_.name, command = call_.command] { return help_text(name, *command); };
  }

  void require_all() const {
    if (!command().commands.empty()) throw UsageError("a command is missing: " + listed(command_names(command())));
    for (const Option& option : command().options)
      if (option.required && !call_.has(option.name)) throw UsageError(spelled(option) + " is missing");
  }

  const std::vector<std::string>& words_;
  std::size_t at_ = 0;
  Call& call_;
};

}  // namespace

void parse(const Command& program, const std::vector<std::string>& words, Call& call) {
  Parser(program, words, call).parse();
}

int run(const Command& program, int argc, const char* const* argv) {
  Call call;
  try {
    parse(program, {argv + std::min(argc, 1), argv + argc}, call);
    if (!call.prints) return call.command->run(call);
    print(call.prints());
    return 0;
  } catch (const UsageError& error) {
    std::cerr << program.name << ": " << error.what() << "; see " << call.name << " --help\n";
    return kWrongUsage;
  }
}

}  // namespace driftmesh::cli
