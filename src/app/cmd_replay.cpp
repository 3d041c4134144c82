#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "balancer/policies/policy_factory.hpp"
#include "base/standard_streams.hpp"
#include "cli/values.hpp"
#include "study/recorded_run.hpp"

namespace driftmesh::app {
namespace {

struct ReplayCommand {
  std::string record;
  std::vector<std::string> policies;
  std::vector<std::string> parameters;
};

/// NAME=VALUE, or POLICY.NAME=VALUE for that policy alone.
balancer::Parameters::Values parameters_for(const std::string& policy, const std::vector<std::string>& given) {
  balancer::Parameters::Values values;
  for (const std::string& setting : given) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos)
      throw cli::UsageError("--parameter '" + setting + "' has no value; give NAME=VALUE");
    const auto [named, name] = balancer::split_parameter(setting.substr(0, equals));
    for (const std::string& other : given)
      if (other != setting && other.starts_with(setting.substr(0, equals + 1)))
        throw cli::UsageError("--parameter '" + setting + "' contradicts '" + other + "'; remove one of them");
    if (named.empty() || named == balancer::short_name(policy)) values[name] = setting.substr(equals + 1);
  }
  return values;
}

std::string line_of(const std::string& policy, double seconds, const study::RecordOfRun& record, std::size_t moves) {
  return fmt::format("| {:>19} | {:>10.4g} | {:>10.3f} | {:>8.1f} | {:>9} |\n", policy, seconds, record.ideal / seconds,
                     100 * (seconds / record.oracle - 1), moves);
}

void replay_run(const ReplayCommand& command) {
  const study::RecordOfRun record = study::read_recorded_run(command.record);
  const std::vector<std::string> policies = command.policies.empty() ? balancer::policy_names() : command.policies;
  std::vector<std::shared_ptr<const balancer::Policy>> made;  // all are checked before the first run
  for (const std::string& policy : policies)
    made.push_back(balancer::make_policy(policy, parameters_for(policy, command.parameters)));
  std::string table = fmt::format("| {:>19} | {:>10} | {:>10} | {:>8} | {:>9} |\n", "policy", "seconds", "efficiency",
                                  "regret %", "moved");
  table += fmt::format("|{0:->20}:|{0:->11}:|{0:->11}:|{0:->9}:|{0:->10}:|\n", "");
  table += line_of("recorded: " + record.policy, record.seconds, record, record.moves);
  for (std::size_t i = 0; i < policies.size(); ++i) {
    const ReplayedRun replayed = replay(record.run, made[i]);
    table += line_of(balancer::short_name(policies[i]), replayed.seconds, record, replayed.moves);
  }
  print(table);
}

}  // namespace

cli::Command replay_command() {
  const auto command = std::make_shared<ReplayCommand>();
  return {.name = "replay",
          .summary = "Balance the work of a recorded run with other policies",
          .options = {{.kind = cli::Option::Kind::kPositional,
                       .name = "run",
                       .value = "RUN.json",
                       .help = "The record of a run that `driftmesh run` wrote",
                       .required = true,
                       .completes = cli::Option::Completes::kFile,
                       .take = cli::into(command->record)},
                      {.name = "policy",
                       .value = "NAME",
                       .help = "A policy to balance with, or a file .so; may be given several times",
                       .standard = "all of them",
                       .repeats = true,
                       .take = cli::into(command->policies)},
                      {.name = "parameter",
                       .value = "NAME=VALUE",
                       .help = "A parameter of the policies, or as POLICY.NAME=VALUE of one of them",
                       .repeats = true,
                       .take = cli::into(command->parameters)}},
          .notes =
              "Each subdomain takes what it took in the recorded run, wherever it is, and its ranks have the speeds "
              "that they "
              "had. Nothing is meshed: a run of hours is replayed in seconds. Regret is measured against an oracle "
              "that knows all work beforehand.",
          .examples = {"driftmesh replay sciclone-144.runs/run-1.json",
                       "driftmesh replay run-1.json --policy zoltan --parameter zoltan.method=rcb"},
          .exit_codes = "0 done, 1 error, 2 wrong usage",
          .run = [command](cli::Call&) {
            replay_run(*command);
            return 0;
          }};
}

}  // namespace driftmesh::app
