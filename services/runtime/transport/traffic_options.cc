#include "services/runtime/transport/traffic_options.h"

#include <cstdlib>

#include <fmt/core.h>

#include "common/errors.h"

namespace fogline::runtime {
namespace {

/// The faults; nullopt if the options name none. @throws InputError
std::optional<FaultRates> FaultsOf(const TrafficOptions& options) {
  if (options.faults.empty()) return std::nullopt;
  const FaultRates rates = ParseFaults(options.faults);
  if (rates.Damage() && options.key_file.empty()) {
    throw InputError(
        "error: --faults: truncate and flip need --key: without a signature no process notices "
        "that a message was damaged (on a real network UDP's checksum does)");
  }
  return rates;
}

/// The effect of the options on the messages of a bus.
struct Treatment {
  /// @throws InputError when the options, or the key's file, are wrong
  explicit Treatment(const TrafficOptions& options)
      : key(KeyOf(options)), faults(FaultsOf(options)) {}

  void Apply(std::optional<Role> role, Bus& bus) const {
    if (key) bus.Secure(MessageSigner(*key, role));
    if (faults) bus.Impair(Faults(*faults, role.value_or(Role::kRunner)));
  }

  std::optional<SigningKey> key;
  std::optional<FaultRates> faults;
};

}  // namespace

TrafficOptions WithKeyOfEnvironment(TrafficOptions options) {
  const char* const variable = std::getenv(kKeyVariable);
  if (options.key_file.empty() && variable != nullptr) options.key_file = variable;
  return options;
}

std::optional<SigningKey> KeyOf(const TrafficOptions& options) {
  if (!options.key_file.empty()) return SigningKey::Load(options.key_file);
  // A user who sets the variable wants signatures. An empty variable may come from a script that
  // has not found the key's file. So an empty variable is an error.
  if (const char* variable = std::getenv(kKeyVariable); variable != nullptr && *variable == '\0') {
    throw InputError(fmt::format(
        "error: {} is empty: name the key's file, or unset it to run unsigned", kKeyVariable));
  }
  return std::nullopt;
}

void Check(const TrafficOptions& options) { Treatment{options}; }

std::unique_ptr<Bus> OpenBus(const std::string& url, const TrafficOptions& options,
                             std::optional<Role> role) {
  const Treatment treatment(options);
  // This check refuses an mpudpm network before the network is opened, because LCM may print a line
  // of its own when an mpudpm network is closed.
  if (treatment.key) RequireSignable(url);
  auto bus = std::make_unique<Bus>(url);
  treatment.Apply(role, *bus);
  return bus;
}

void Apply(const TrafficOptions& options, std::optional<Role> role, Bus& bus) {
  Treatment(options).Apply(role, bus);
}

std::vector<std::string> ToArguments(const TrafficOptions& options) {
  std::vector<std::string> arguments;
  if (!options.key_file.empty()) arguments.insert(arguments.end(), {"--key", options.key_file});
  if (!options.faults.empty()) arguments.insert(arguments.end(), {"--faults", options.faults});
  return arguments;
}

}  // namespace fogline::runtime
