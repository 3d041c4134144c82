#include <memory>
#include <string>

#include "app/commands.hpp"
#include "base/atomic_file.hpp"
#include "base/standard_streams.hpp"
#include "cli/values.hpp"
#include "config/costs_file.hpp"
#include "study/measure_costs.hpp"

namespace driftmesh::app {
namespace {

struct CalibrateCommand {
  std::string output;
  bool quick = false;
};

}  // namespace

cli::Command calibrate_command() {
  const auto command = std::make_shared<CalibrateCommand>();
  return {
      .name = "calibrate",
      .summary = "Measure on this machine what work costs, for simulated clusters",
      .options = {{.name = "output",
                   .letter = 'o',
                   .value = "FILE",
                   .help = "The YAML file to write, for cluster.costs of experiments; without it, print",
                   .completes = cli::Option::Completes::kFile,
                   .take = cli::into(command->output)},
                  {.kind = cli::Option::Kind::kFlag,
                   .name = "quick",
                   .help = "Measure small cases once: rough, but in a second",
                   .take = cli::into(command->quick)}},
      .notes = "Times are CPU times of one thread. Measure on an idle machine all the same: others take its caches.",
      .examples = {"driftmesh calibrate -o costs.yaml",
                   "driftmesh run configs/first-run.yaml --set cluster.costs=costs.yaml"},
      .exit_codes = "0 done, 1 error, 2 wrong usage",
      .run = [command](cli::Call&) {
        const std::string text = config::costs_text(study::measure_costs(command->quick));
        if (command->output.empty()) {
          print(text);
          return 0;
        }
        AtomicFile file(command->output);
        file.write(text);
        file.commit();
        return 0;
      }};
}

}  // namespace driftmesh::app
