#include "tools/cli/plan_options.h"

#include <CLI/CLI.hpp>

namespace fogline::cli {

void AddPlanOptions(CLI::App& app, hosts::PlanWords& words) {
  app.add_option("--on", words.on,
                 "Start this role on another machine by ssh: fusion=[USER@]HOST, or "
                 "fusion=HOST:/FOLDER of Fogline's programs there (repeatable)")
      ->type_name("ROLE=HOST")
      ->allow_extra_args(false);
  app.add_option("--lab", words.lab,
                 "File with machines, their roles, network and key; --on comes before it");
  app.add_option("--ssh", words.ssh,
                 "Command in place of ssh, with its options, such as 'ssh -p 2222' (default: "
                 "$FOGLINE_SSH, or ssh)");
  app.add_flag("--relay", words.relay,
               "With --on: messages go over TCP through a fogline-relay on this machine, because "
               "the network carries no multicast");
  app.add_option("--relay-at", words.relay_at,
                 "With --on: the relay listens at this ADDRESS[:PORT] (default: the address at "
                 "which the other machines see this one)");
}

}  // namespace fogline::cli
