#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "app/commands.hpp"
#include "base/standard_streams.hpp"
#include "cli/completion.hpp"
#include "cli/manual_page.hpp"
#include "cli/values.hpp"
#include "config/words.hpp"
#include "driftmesh/version.hpp"
#include "sizing/expression_table.hpp"

namespace driftmesh::app {
namespace {

using Printed = std::function<std::string()>;

cli::Option printing(const std::string& name, const std::string& help, Printed text) {
  return {.kind = cli::Option::Kind::kFlag, .name = name, .help = help, .prints = std::move(text)};
}

}  // namespace

cli::Command config_command(const cli::Command& program) {
  const auto shell = std::make_shared<std::string>();
  return {
      .name = "config",
      .summary = "Print the schema of experiment files, the manual page, or shell completion",
      .options = {printing("schema", "Print the JSON schema of experiments, for editors that check YAML as you type",
                           config::json_schema),
                  printing("keys", "Print all keys of experiments as a table in Markdown", config::keys_table),
                  printing("functions", "Print the functions of size expressions as a table in Markdown",
                           expression_functions_table),
                  printing("man", "Print the manual page",
                           [&program] { return cli::manual_page(program, "driftmesh " DRIFTMESH_VERSION); }),
                  {.name = "completion",
                   .value = "SHELL",
                   .help = "Print the script that makes a shell complete commands, options and their values",
                   .choices = cli::completion_shells(),
                   .take = cli::into(*shell)}},
      .examples = {"driftmesh config --schema > experiment.schema.json", "driftmesh config --man | man -l -",
                   "source <(driftmesh config --completion bash)"},
      .exit_codes = "0 done, 1 error, 2 wrong usage",
      .run = [shell, &program](cli::Call&) {
        if (shell->empty()) throw cli::UsageError("--schema, --keys, --man or --completion is missing");
        print(cli::completion_script(program, *shell));
        return 0;
      }};
}

}  // namespace driftmesh::app
