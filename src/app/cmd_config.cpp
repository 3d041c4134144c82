#include <functional>
#include <string>

#include "app/commands.hpp"
#include "base/standard_streams.hpp"
#include "experiment/key_words.hpp"

namespace driftmesh::app {
namespace {

cli::Option flag(const std::string& name, const std::string& help, std::function<std::string()> prints) {
  return {.kind = cli::Option::Kind::kFlag, .name = name, .help = help, .prints = std::move(prints)};
}

}  // namespace

cli::Command config_command(const cli::Command&) {
  return {.name = "config",
          .summary = "Print what the files of experiments can say",
          .options = {flag("schema", "Print the JSON schema, for editors that check YAML while it is written",
                           experiment::json_schema),
                      flag("keys", "Print all keys as a table in Markdown", experiment::keys_table)},
          .examples = {"driftmesh config --schema > experiment.schema.json"},
          .exit_codes = "0 done, 1 error, 2 wrong usage",
          .run = [](cli::Call&) -> int { throw cli::UsageError("say what to print"); }};
}

}  // namespace driftmesh::app
