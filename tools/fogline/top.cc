// fogline top: a text view of what goes over an LCM network.
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "services/runtime/bus.h"
#include "tools/fogline/arguments.h"
#include "tools/fogline/help.h"
#include "tools/fogline/interrupt.h"
#include "tools/fogline/verbs.h"
#include "tools/watch/terminal.h"
#include "tools/watch/traffic_statistics.h"
#include "tools/watch/traffic_text.h"

namespace fogline {
namespace {

constexpr const char* kExplanation =
    R"(Per channel and run: messages since top listens; rate and bandwidth (payload) of the last
interval; jitter, the standard deviation of the times between messages in it; age of the last
message; steps that have not come within the next 64 (lost), came behind a newer one (late), or
came again (twice); messages that cannot be decoded, by the type that they seem to be. Per role,
from its STATUS: state, step, repairs asked for and served, processor time, memory, refusals;
silent after 1 s without STATUS. It sees what the network brings to this machine: what is lost on
the way here may have arrived elsewhere. q or Ctrl-C quits.

Examples:
  fogline run scenario/paper.json --pace 1 --lcm-url 'udpm://239.255.76.67:7700?ttl=0' &
  fogline top --lcm-url 'udpm://239.255.76.67:7700?ttl=0'
  fogline top --once --json --interval 2 | jq '.runs[].channels[] | {channel, rate_hz}'
  fogline top --for 60 --interval 10 >> traffic.txt
  lcm-logplayer logs/paper-1.lcm & fogline top     a log that is being played)";

struct TopArguments {
  explicit TopArguments(CLI::App& verb) {
    verb.add_option("--lcm-url", url, "LCM network to look at, as `fogline run` prints it")
        ->envname("LCM_DEFAULT_URL")
        ->capture_default_str();
    verb.add_option("--interval", interval_s, "Length of an observation, in s")
        ->check(NumberIn(0.1, 3600))
        ->capture_default_str();
    verb.add_option("--for", limit_s, "Quit after so long, in s (0: do not)")
        ->check(NumberIn(0, 1e7))
        ->capture_default_str();
    verb.add_flag("--once", once, "Print what was seen in one interval, and quit");
    verb.add_flag("--json", json, "Print a JSON document for every interval instead of a table");
    ShowExitCodes(verb, {.interruptible = true});
    verb.footer(kExplanation);
  }

  std::string url = "udpm://239.255.76.67:7667?ttl=0";
  double interval_s = 1;
  double limit_s = 0;
  bool once = false;
  bool json = false;
};

// How often it looks at what poll() does not see: messages that a flood has left undrained.
constexpr Duration kLookEvery = milliseconds(50);

Duration FromSeconds(double seconds) {
  return duration_cast<Duration>(std::chrono::duration<double>(seconds));
}

class Top {
 public:
  explicit Top(const TopArguments& arguments)
      : arguments_(arguments), bus_(arguments.url), statistics_(Clock::now()) {
    bus_.SubscribeAll([this](std::string_view channel, Bytes bytes) {
      if (!IsLcmsOwn(channel)) statistics_.Add(channel, bytes, Clock::now());
    });
    if (isatty(STDOUT_FILENO) == 1 && !arguments.once && !arguments.json) terminal_.emplace();
  }

  int Run() {
    const TimePoint began = Clock::now();
    const TimePoint end =
        arguments_.limit_s > 0 ? began + FromSeconds(arguments_.limit_s) : TimePoint::max();
    const Duration interval = FromSeconds(arguments_.interval_s);
    if (terminal_) Show();
    for (TimePoint next = began + interval; Clock::now() < end; next += interval) {
      const bool whole = Listen(std::min(next, end));
      if (!whole && terminal_) return kDone;
      if (!whole && arguments_.once) throw Interrupted("interrupted before the interval was over");
      if (!whole) return kInterrupted;
      Show();
      if (arguments_.once) return kDone;
    }
    return kDone;
  }

 private:
  /// Handles messages and keys. @return false if the user wants to quit before it is time
  bool Listen(TimePoint until) {
    while (true) {
      const TimePoint now = Clock::now();
      if (now >= until) return true;
      std::array<pollfd, 2> waited{
          pollfd{.fd = bus_.fd(), .events = POLLIN, .revents = 0},
          pollfd{.fd = terminal_ ? terminal_->fd() : -1, .events = POLLIN, .revents = 0}};
      const Duration wait = std::min(until - now, kLookEvery);
      poll(waited.data(), waited.size(), static_cast<int>(Milliseconds(wait)) + 1);
      if (WasInterrupted()) return false;
      bus_.Drain();
      if (terminal_ && terminal_->Key() == 'q') return false;
    }
  }

  void Show() {
    const TrafficView view = statistics_.Observe(Clock::now());
    if (terminal_) return terminal_->Draw(TrafficLines(view, bus_.url()));
    if (arguments_.json) {
      PrintJson(TrafficJson(view, bus_.url())
                    .dump(arguments_.once ? 2 : -1, ' ', false,
                          nlohmann::json::error_handler_t::replace));
    } else {
      for (const Line& line : TrafficLines(view, bus_.url())) fmt::print("{}\n", line.text);
      if (!arguments_.once) fmt::print("\n");
    }
    std::fflush(stdout);
  }

  const TopArguments& arguments_;
  Bus bus_;
  TrafficStatistics statistics_;
  std::optional<Terminal> terminal_;
};

}  // namespace

void AddTop(CLI::App& app, Action& action) {
  CLI::App* top = app.add_subcommand("top", "Show live traffic: channels and roles, run by run");
  CLI::App* spy = app.add_subcommand("spy", "The same as top")->group("");  // not in the list
  for (CLI::App* verb : {top, spy}) {
    const auto arguments = std::make_shared<TopArguments>(*verb);
    verb->callback([&action, arguments] {
      action = [arguments] {
        CheckNetworkUrl(arguments->url);
        WatchInterrupts();
        return Top(*arguments).Run();
      };
    });
  }
}

}  // namespace fogline
