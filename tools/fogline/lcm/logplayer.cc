// fogline logplayer: starts LCM's own lcm-logplayer-gui, which plays a log in a window.
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "common/errors.h"
#include "services/log/event_log.h"
#include "services/runtime/transport/lcm_url.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/fogline/verbs.h"
#include "tools/spy/java_program.h"

namespace fogline {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLogplayerExplanation =
    R"(Opens a window that plays a log of any LCM program on a network. You can pause, choose the speed and
the start time, and switch channels off. It begins at once unless --paused is given. It keeps
its settings in a file beside the log, LOG.jlp. Uses JAVA_HOME if it is set.

fogline top, spy and view show the messages while they are played. Give them the same --lcm-url.

Examples:
  fogline logplayer logs/paper-1.lcm
  fogline logplayer logs/paper-1.lcm --paused --lcm-url 'udpm://239.255.76.67:7700?ttl=0')";

struct LogplayerArguments {
  explicit LogplayerArguments(CLI::App& verb) {
    verb.add_option("LOG", log, "Event log to play")->required();
    verb.add_option("--lcm-url", url,
                    fmt::format("LCM network to play on (default: $LCM_DEFAULT_URL, else {})",
                                runtime::kLcmDefaultUrl));
    verb.add_flag("--paused", paused, "Wait for a click on Play");
    verb.add_option("--jars", jars,
                    "Folder of lcm.jar (default: /usr/share/java, or /usr/local/share/java)");
    cli::ShowExitCodes(verb, {.done = "window closed", .check_failed = "lcm-logplayer-gui failed"});
    verb.footer(kLogplayerExplanation);
  }

  fs::path log;
  std::string url;
  bool paused = false;
  fs::path jars;
};

int Logplayer(const LogplayerArguments& arguments) {
  const std::string url = cli::CheckedNetworkUrl(arguments.url);
  const log::EventLogReader log(arguments.log);  // throws if the file is not an event log
  const fs::path java = spy::RequireJava();
  const fs::path lcm = spy::FindJar(arguments.jars, "lcm.jar", "liblcm-java");
  spy::RequireScreen();
  std::vector<std::string> command{
      java.string(), "-Djava.net.preferIPv4Stack=true", "-cp",
      lcm.string(),  "lcm.logging.LogPlayer",           "--lcm-url=" + url};
  if (arguments.paused) command.emplace_back("--paused");
  command.push_back(arguments.log.string());
  spy::BecomeJava(std::move(command));
}

}  // namespace

void AddLogplayer(CLI::App& app, cli::Action& action) {
  CLI::App* verb = app.add_subcommand("logplayer", "Start LCM's lcm-logplayer-gui");
  const auto arguments = std::make_shared<LogplayerArguments>(*verb);
  verb->callback([&action, arguments] { action = [arguments] { return Logplayer(*arguments); }; });
}

}  // namespace fogline
