#include "services/models/traffic/load_sumo.h"

#include <dlfcn.h>

#include <cmath>
#include <system_error>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/process/programs.h"
#include "common/text.h"

namespace fogline::models {
namespace {

constexpr double kMicrosPerSecond = 1e6;
constexpr std::int64_t kMicrosPerMilli = 1000;

/// Finds a function of the module. The module stays loaded until the process ends, because SUMO's
/// libraries do not expect to be unloaded.
template <class Function>
Function* Find(const std::filesystem::path& module, const char* name) {
  std::error_code ignored;
  if (!std::filesystem::exists(module, ignored)) {
    throw InputError(
        "/lead/profile: \"sumo\" needs SUMO, and this build of Fogline has none: install Debian's "
        "package sumo, and build again (tools/build fogline_programs)");
  }
  void* loaded = dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* found = loaded == nullptr ? nullptr : dlsym(loaded, name);
  if (found != nullptr) return reinterpret_cast<Function*>(found);
  throw InputError(fmt::format(
      "/lead/profile: \"sumo\" needs SUMO: install Debian's package sumo ({})", dlerror()));
}

std::int64_t StepOf(const Scenario& scenario) {
  const auto step_us = static_cast<std::int64_t>(std::llround(scenario.step_s * kMicrosPerSecond));
  if (step_us % kMicrosPerMilli == 0) return step_us;
  throw InputError(
      fmt::format("/step_s: {} s is no whole number of milliseconds, in which SUMO "
                  "counts time",
                  NumberText(scenario.step_s)));
}

}  // namespace

std::filesystem::path SumoModule() { return OwnFolder().parent_path() / "lib/fogline/sumo.so"; }

std::unique_ptr<Traffic> LoadSumo(const Scenario& scenario, const std::filesystem::path& module) {
  const SumoSection& sumo = scenario.lead.sumo;
  const std::string version = SumoVersion(module);
  if (!sumo.version.empty() && sumo.version != version) {
    throw InputError(
        fmt::format("/lead/sumo/version: {}, but this machine has {}; other versions "
                    "of SUMO may move the cars otherwise",
                    QuoteShort(sumo.version), Quote(version)));
  }
  if (sumo.routes.empty()) {
    throw InputError("/lead/sumo: \"route_file\" or \"routes\" is needed: SUMO has no cars");
  }
  const TrafficSetup setup{.net = sumo.net,
                           .routes = sumo.routes,
                           .behind = sumo.behind,
                           .start_s = sumo.start_s,
                           .step_us = StepOf(scenario),
                           .seed = scenario.seed,
                           .host_gap_m = scenario.world.host_gap_m,
                           .length_m = scenario.world.vehicle_length_m};
  auto* make = Find<Traffic*(const TrafficSetup&)>(module, "FoglineSumoTraffic");
  return std::unique_ptr<Traffic>(make(setup));
}

std::string SumoVersion(const std::filesystem::path& module) {
  return Find<const char*()>(module, "FoglineSumoVersion")();
}

}  // namespace fogline::models
