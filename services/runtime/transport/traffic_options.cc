#include "services/runtime/transport/traffic_options.h"

#include <cstdlib>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "common/errors.h"

namespace fogline::runtime {

namespace {

constexpr const char* kKeyVariable = "FOGLINE_KEY";

}  // namespace

void AddTrafficOptions(CLI::App& app, TrafficOptions& options) {
  app.add_option("--key", options.key_file,
                 "Sign messages with the key in this file, and refuse unsigned ones")
      ->envname(kKeyVariable)
      ->check([](const std::string& file) {
        return file.empty() ? "the name of the key's file is empty" : "";
      });
  app.add_option("--faults", options.faults,
                 "Receive as over a bad network, such as loss=0.3,delay_ms=5");
}

std::optional<SigningKey> KeyOf(const TrafficOptions& options) {
  if (!options.key_file.empty()) return SigningKey::Load(options.key_file);
  // A user who sets the variable wants signatures. An empty variable may come from a script that
  // has not found the key's file.
  if (const char* variable = std::getenv(kKeyVariable); variable != nullptr && *variable == '\0') {
    throw InputError(fmt::format(
        "error: {} is empty: name the key's file, or unset it to run unsigned", kKeyVariable));
  }
  return std::nullopt;
}

void Apply(const TrafficOptions& options, std::optional<Role> role, Bus& bus) {
  if (const auto key = KeyOf(options)) bus.Secure(MessageSigner(*key, role));
  if (options.faults.empty()) return;
  const FaultRates rates = ParseFaults(options.faults);
  if (rates.Damage() && options.key_file.empty()) {
    throw InputError(
        "error: --faults: truncate and flip need --key: without a signature no process notices "
        "that a message was damaged (on a real network UDP's checksum does)");
  }
  bus.Impair(Faults(rates, role.value_or(Role::kRunner)));
}

std::vector<std::string> ToArguments(const TrafficOptions& options) {
  std::vector<std::string> arguments;
  if (!options.key_file.empty()) arguments.insert(arguments.end(), {"--key", options.key_file});
  if (!options.faults.empty()) arguments.insert(arguments.end(), {"--faults", options.faults});
  return arguments;
}

}  // namespace fogline::runtime
