#include "cli/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <map>
#include <optional>

#include "base/standard_streams.hpp"
#include "cli/help_text.hpp"

namespace driftmesh::cli {
namespace {

// CLI11 takes a word that begins with a dash for an option. Words that stand for a standard stream are masked.
constexpr char kMask = '\x1f';

std::string masked(const std::string& word) {
  return is_standard_stream(word) ? kMask + word : word;
}

std::string unmasked(const std::string& word) {
  return word.starts_with(kMask) ? word.substr(1) : word;
}

/// The words in the order that CLI11 expects. It would not notice the empty value in "--name=".
std::vector<std::string> backwards_for_cli11(const std::vector<std::string>& words) {
  std::vector<std::string> backwards;
  for (auto word = words.rbegin(); word != words.rend(); ++word) {
    const bool empty_value = word->starts_with("--") && word->find('=') + 1 == word->size();
    if (empty_value) backwards.emplace_back();
    backwards.push_back(empty_value ? word->substr(0, word->size() - 1) : masked(*word));
  }
  return backwards;
}

/// Whether a word stands behind "--", and nowhere before it.
bool is_argument(const std::string& word, const std::vector<std::string>& words) {
  const auto dashes = std::ranges::find(words, "--");
  return std::find(dashes, words.end(), word) != words.end() && std::find(words.begin(), dashes, word) == dashes;
}

/// The option's name as declared to CLI11: "-a,--area", or "input".
std::string declared(const Option& option) {
  if (option.kind == Option::Kind::kPositional) return option.name;
  const std::string letter = option.letter == 0 ? "" : std::string("-") + option.letter + ",";
  return letter + "--" + option.name;
}

/// One command of the tree as CLI11 sees it. CLI11 only assigns the words to commands and options; their meaning and
/// validity are decided here, with our own messages.
class Level {
 public:
  Level(const Command& command, CLI::App& app) : command_(command), app_(app) {
    app_.set_help_flag();
    app_.allow_extras();
    app_.require_subcommand(0, command.commands.empty() ? 0 : 1);
    for (const OptionGroup& group : option_groups(command))
      for (const Option* option : group.options) options_[declare(*option)] = option;
    for (const Command& below : command.commands) below_.emplace_back(below, *app_.add_subcommand(below.name));
  }

  /// The level that was called below this one, if any.
  [[nodiscard]] const Level* called() const {
    for (const Level& level : below_)
      if (level.app_.parsed()) return &level;
    return nullptr;
  }
  [[nodiscard]] const Command& command() const { return command_; }

  /// Whether an option was given that prints something instead; `call` then says what.
  bool prints(Call& call) const {
    for (const auto& [known, option] : options_) {
      if (known->count() == 0 || !(option->prints || option == &help_option())) continue;
      call.prints = option->prints;
      if (option == &help_option())
        call.prints = [name = call.name, &command = command_] { return help_text(name, command); };
      return true;
    }
    return false;
  }

  /// `words`: all of the command line.
  void refuse_unknown(const std::vector<std::string>& words) const {
    std::vector<std::string> unknown = app_.remaining();
    std::erase(unknown, "--");  // CLI11 keeps it, though it was understood
    if (unknown.empty()) return;
    const std::string word = unmasked(unknown.front());
    const bool is_option = word.starts_with('-') && !is_standard_stream(word);
    if (is_argument(word, words))
      throw UsageError("unexpected argument '" + word + "'" +
                       (is_option ? ": after --, every word is the name of a file; options go before --" : ""));
    if (is_option) refuse_option(word);
    if (command_.commands.empty()) throw UsageError("unexpected argument '" + word + "'");
    throw UsageError("unknown command '" + word + "'" + did_you_mean(word, command_names(command_)));
  }

  /// Passes the values to the options, in the order of the words.
  void give(Call& call) const {
    std::map<const CLI::Option*, std::size_t> taken;
    for (const CLI::Option* known : app_.parse_order()) {
      const Option& option = *options_.at(known);
      const std::string value = known->results().at(taken[known]++);
      give(option, value, call);
    }
  }

 private:
  const CLI::Option* declare(const Option& option) {
    if (option.kind == Option::Kind::kFlag) return app_.add_flag(declared(option))->take_all();
    constexpr int kMany = CLI::detail::expected_max_vector_size;
    CLI::Option* const known = app_.add_option(declared(option))->take_all();
    if (option.kind == Option::Kind::kPositional)
      return known->expected(1, option.repeats ? kMany : 1)->allow_extra_args(option.repeats);
    return known->expected(1, kMany)->allow_extra_args(false);  // one value each time it is given
  }

  [[noreturn]] void refuse_option(const std::string& word) const {
    const std::string name = word.substr(0, word.find('='));
    std::vector<std::string> known;
    for (const auto& [unused, option] : options_)
      if (option->kind != Option::Kind::kPositional) known.push_back(option->name);
    throw UsageError("unknown option " + name +
                     (name.starts_with("--") ? did_you_mean(name.substr(2), known, "--") : ""));
  }

  static void give(const Option& option, const std::string& value, Call& call) {
    const bool flag = option.kind == Option::Kind::kFlag;
    if (flag && value != "true") throw UsageError(spelled(option) + " takes no value");
    try {
      call.give(option, flag ? "" : unmasked(value));
    } catch (const UsageError& error) {
      throw UsageError(spelled(option) + " " + error.what());
    }
  }

  const Command& command_;
  CLI::App& app_;
  std::map<const CLI::Option*, const Option*> options_;
  std::vector<Level> below_;
};

void require_all(const Call& call) {
  if (!call.command->commands.empty())
    throw UsageError("a command is missing: " + listed(command_names(*call.command)));
  for (const Option& option : call.command->options)
    if (option.required && !call.has(option.name)) throw UsageError(spelled(option) + " is missing");
}

/// Handles an error that CLI11 reports. There is only one kind left to it: an option without its value at the end of
/// the line.
[[noreturn]] void refuse_last(const std::string& word, const Command& command, const CLI::ParseError& error) {
  for (const Option& option : command.options)
    if (word == "--" + option.name || (option.letter != 0 && word.ends_with(option.letter)))
      throw UsageError(spelled(option) + " needs a value: " + option.value);
  throw UsageError(error.what());
}

/// The words that are left once a command has taken its switches. A value that follows its option is none of them.
std::vector<std::string> without_switches(const Command& program, const std::vector<std::string>& words) {
  if (words.empty()) return words;
  const auto command = std::ranges::find(program.commands, words.front(), &Command::name);
  if (command == program.commands.end() || !command->take_switches) return words;
  const auto takes_value = [&](const std::string& word) {
    return std::ranges::any_of(command->options, [&](const Option& option) {
      return option.kind == Option::Kind::kValue && word == "--" + option.name;
    });
  };
  std::vector<std::string> left;
  bool may_be_switch = true;
  for (const std::string& word : words) {
    const bool is_switch = may_be_switch && word.size() > 1 && word[0] == '-' && word[1] != '-';
    if (is_switch)
      command->take_switches(word);
    else
      left.push_back(word);
    may_be_switch = !takes_value(word);
  }
  return left;
}

}  // namespace

void parse(const Command& program, const std::vector<std::string>& words, Call& call) {
  CLI::App app;
  const Level root(program, app);
  std::vector<std::string> backwards = backwards_for_cli11(without_switches(program, words));
  std::optional<CLI::ParseError> failure;
  try {
    app.parse(backwards);
  } catch (const CLI::ParseError& error) {
    failure = error;
  }
  for (const Level* level = &root; level != nullptr; level = level->called()) {
    call.name += (level == &root ? "" : " ") + level->command().name;
    call.command = &level->command();
    if (level->prints(call)) return;
    level->refuse_unknown(words);
    if (failure && level->called() == nullptr) refuse_last(words.back(), level->command(), *failure);
    if (!failure) level->give(call);
  }
  require_all(call);
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
