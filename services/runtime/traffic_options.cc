#include "services/runtime/traffic_options.h"

#include <cstdio>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "scenario/loader.h"

namespace fogline {

void AddTrafficOptions(CLI::App& app, TrafficOptions& options) {
  app.add_option("--key", options.key_file,
                 "Sign with the key in this file; refuse what is not signed")
      ->envname("FOGLINE_KEY");
  app.add_option("--faults", options.faults,
                 "Receive as over a bad network, such as loss=0.3,delay_ms=5");
}

void Apply(const TrafficOptions& options, std::optional<Role> role, Bus& bus) {
  if (!options.key_file.empty()) {
    bus.Secure(Seal(SealKey::Load(options.key_file), role));
    const std::string warning = KeyFileWarning(options.key_file);
    if (!warning.empty()) fmt::print(stderr, "{}\n", warning);
  }
  if (options.faults.empty()) return;
  const FaultRates rates = ParseFaults(options.faults);
  if (rates.Damage() && options.key_file.empty()) {
    throw InputError(
        "error: --faults: truncate and flip want --key: without a signature nobody finds out that "
        "a message was damaged (on a real network UDP's checksum does)");
  }
  bus.Impair(Faults(rates, role.value_or(Role::kRunner)));
}

std::vector<std::string> ToArguments(const TrafficOptions& options) {
  std::vector<std::string> arguments;
  if (!options.key_file.empty()) arguments.insert(arguments.end(), {"--key", options.key_file});
  if (!options.faults.empty()) arguments.insert(arguments.end(), {"--faults", options.faults});
  return arguments;
}

}  // namespace fogline
