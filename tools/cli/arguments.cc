#include "tools/cli/arguments.h"

#include <system_error>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/atomic_file.h"
#include "common/file.h"
#include "common/parse_number.h"
#include "common/process/console.h"
#include "common/text.h"
#include "scenario/io/catalogue.h"
#include "services/runtime/transport/lcm_url.h"

namespace fogline::cli {

void RefuseOverride(std::span<const std::string> overrides, std::string_view pointer,
                    std::string_view why) {
  for (const std::string& one : overrides) {
    if (std::string_view(one).substr(0, one.find('=')) != pointer) continue;
    throw InputError(fmt::format("error: --set {}: {}", pointer, why));
  }
}

const std::string& ScenarioArguments::CheckedSeed() const {
  const IntegerSpec& range = FindField("/seed")->As<IntegerField>()->spec;
  const auto seed = ParseNumber<std::int64_t>(seed_);
  if (!seed || *seed < range.min || *seed > range.max) {
    throw InputError(fmt::format("error: --seed: {} is no seed: a whole number from {} to {}",
                                 QuoteShort(seed_), range.min, range.max));
  }
  return seed_;
}

sweep::SeedRange ReadSeeds(const std::string& text) {
  const sweep::SeedRange seeds = sweep::ParseSeeds(text);
  if (seeds.count() == 1 && seeds.first > 1 && text.find(':') == std::string::npos) {
    Notice(fmt::format("--seeds {0} is the one seed {0}; seeds 1 to {0} are --seeds 1:{0}",
                       seeds.first));
  }
  return seeds;
}

void PrintJson(const nlohmann::ordered_json& json, int indent) {
  PrintJson(json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void PrintJson(const std::string& text) { fmt::print("{}\n", EscapeLines(text)); }

void RefuseJsonBeside(const std::filesystem::path& document, std::string_view option, bool json) {
  std::error_code ignored;
  // /dev/null may get both the document and the JSON text, because nothing reads it.
  if (!json || !IsStdout(document) ||
      std::filesystem::canonical(document, ignored) == "/dev/null") {
    return;
  }
  throw InputError(fmt::format("error: --json: {0} {1} uses stdout already; give {0} a file",
                               option, PathText(document)));
}

void PrintBeside(const std::filesystem::path& document, std::string_view text) {
  if (!IsStdout(document)) return fmt::print("{}", text);
  if (text.ends_with('\n')) text.remove_suffix(1);
  Complain(text);
}

nlohmann::ordered_json BuildJson(runtime::BuildId build) {
  if (build == runtime::kUnknownBuild) return nullptr;
  return runtime::BuildText(build);
}

NetworkArguments::NetworkArguments(CLI::App& verb, std::string_view what) {
  verb.add_option("--lcm-url", url_,
                  fmt::format("LCM network {} (default: $LCM_DEFAULT_URL, else {}, and the runs "
                              "announced there)",
                              what, runtime::kLcmDefaultUrl));
}

std::string CheckedNetworkUrl(const std::string& given) {
  const std::string url = runtime::NetworkUrl(given);
  const std::string_view source = given.empty() ? "LCM_DEFAULT_URL" : "--lcm-url";
  if (runtime::IsInMemory(url)) {
    throw InputError(
        fmt::format("error: {} {}: other processes cannot look into the memory of a process; give "
                    "the run a udpm:// URL",
                    source, url));
  }
  runtime::CheckUrl(source, url);
  return url;
}

}  // namespace fogline::cli
