#include "tools/hosts/lab_file.h"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "common/file.h"
#include "common/text.h"
#include "scenario/io/diagnostic_list.h"
#include "scenario/io/json.h"
#include "scenario/io/reader.h"
#include "services/runtime/transport/lcm_url.h"
#include "tools/hosts/run_plan.h"

namespace fogline::hosts {
namespace {

constexpr std::string_view kAllowed = "fogline check --lab --schema";

/// Checks the rules of a laboratory that the schema of its fields does not express.
class LabCheck {
 public:
  LabCheck(const JsonValue& root, DiagnosticList& mistakes) : root_(root), mistakes_(mistakes) {}

  void Check(const LabPlan& lab) {
    if (lab.hosts.empty()) Add("/hosts", "needed", "a laboratory needs a machine");
    for (std::size_t i = 0; i < lab.hosts.size(); ++i) {
      CheckHost(fmt::format("/hosts/{}", i), lab.hosts[i]);
    }
    if (lab.url.empty()) return;
    if (runtime::IsInMemory(lab.url)) {
      Add("/url", "text",
          fmt::format("{}: other machines cannot look into the memory of this one; give a udpm:// "
                      "URL",
                      QuoteShort(lab.url)));
    } else if (const std::string why = runtime::WhyWrongUrl(lab.url); !why.empty()) {
      Add("/url", "text", fmt::format("{}: {}", QuoteShort(lab.url), why));
    } else if (lab.relay || !lab.relay_at.empty()) {
      Add("/url", "needed", "the relay has a URL of its own; leave out url, or relay");
    }
  }

 private:
  void Add(const std::string& pointer, std::string_view rule, std::string message) {
    mistakes_.Add(FindPlace(root_, pointer), pointer, rule, std::move(message));
  }

  void CheckHost(const std::string& pointer, const LabHostSection& host) {
    if (host.name.empty()) {
      Add(pointer + "/name", "needed", "a name is needed");
    } else if (!names_.emplace(host.name, pointer).second) {
      Add(pointer + "/name", "duplicate",
          fmt::format("two machines have the name {}", QuoteShort(host.name)));
    } else if (const std::string why = WhyNoDestination(host.ssh.empty() ? host.name : host.ssh);
               !why.empty()) {
      Add(pointer + (host.ssh.empty() ? "/name" : "/ssh"), "text", why);
    }
    for (std::size_t i = 0; i < host.roles.size(); ++i) {
      CheckRole(fmt::format("{}/roles/{}", pointer, i), host.roles[i]);
    }
  }

  void CheckRole(const std::string& pointer, const std::string& role) {
    if (std::string why = WhyNoRemoteRole(role); !why.empty()) {
      return Add(pointer, "choice", std::move(why));
    }
    const auto [other, is_new] = roles_.emplace(role, pointer);
    if (is_new) return;
    Add(pointer, "duplicate",
        fmt::format("the {} already runs on another machine ({})", role, other->second));
  }

  const JsonValue& root_;
  DiagnosticList& mistakes_;
  std::map<std::string, std::string> names_;
  std::map<std::string, std::string> roles_;
};

}  // namespace

LabPlan ParseLab(std::string_view text, std::string_view name) {
  const std::vector<Source> sources{{.name = std::string(name), .text = text}};
  DiagnosticList mistakes;
  const std::optional<JsonValue> root = ParseJson(text, 0, mistakes);
  if (!root) mistakes.Throw(sources, kAllowed);
  LabPlan lab = ReadLab(*root, mistakes);
  if (mistakes.empty()) LabCheck(*root, mistakes).Check(lab);
  if (!mistakes.empty()) mistakes.Throw(sources, kAllowed);
  return lab;
}

LabPlan LoadLab(const std::filesystem::path& file) {
  const FileText read = ReadFile(file, kMaxFileBytes, ".json");
  if (!read.error.empty()) ThrowUnreadable(file.string(), read.error);
  return ParseLab(read.text, file.string());
}

}  // namespace fogline::hosts
