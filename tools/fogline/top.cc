// fogline top: a text view of the traffic on an LCM network.
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/interrupt.h"
#include "services/runtime/discovery/beacon.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/fogline/verbs.h"
#include "tools/watch/announced.h"
#include "tools/watch/followed_network.h"
#include "tools/watch/screen/top_screen.h"
#include "tools/watch/senders/senders_report.h"
#include "tools/watch/terminal.h"
#include "tools/watch/traffic_statistics.h"
#include "tools/watch/traffic_text.h"

namespace fogline {
namespace {

constexpr const char* kTopExplanation =
    R"(Per channel and run: messages since top listens; rate and bandwidth (payload) of the last
interval; jitter, the standard deviation of the times between messages in it; age of the last
message; undecodable messages, by apparent type. A step is lost if it has not come when a step
comes that is newer by 64. It is late if it comes after a newer step, and twice if it comes again.
Per role, from its STATUS: state, step, repairs asked for and served, processor time, memory,
refusals; a role is silent after 1 s without STATUS. Per sender of LCM traffic of any kind, by LCM's
own numbers of messages (udpm only): lost are messages that the network has lost, and here are
messages that top has lost because it was too slow. Without --lcm-url top follows the newest run
that is announced on this machine, and names all announced runs. Top sees only messages that reach
this machine; a message that is lost on the way here may have arrived elsewhere. Roles that wait for
a run are listed before any run.

On a terminal the tables scroll: arrows move, Tab goes to the next table, Enter opens a row (the
fields of a channel's newest message, all of a role's STATUS), Esc closes it, s sorts the table by
the next column, r reverses it, q quits.

Examples:
  fogline run scenario/paper.json --pace 1 & fogline top
  fogline top --lcm-url 'udpm://239.255.76.67:7700?ttl=0'
  fogline top --once --json --interval 2 | jq '.runs[].channels[] | {channel, rate_hz}'
  fogline top --once --json | jq '.senders[] | select(.lost > 0)'
  fogline top --for 60 --interval 10 >> traffic.txt
  lcm-logplayer logs/paper-1.lcm & fogline top     a log that is being played)";

struct TopArguments {
  explicit TopArguments(CLI::App& verb) : network(verb, "to look at") {
    verb.add_option("--interval", interval_s, "Length of an observation, in s")
        ->check(cli::NumberIn(0.1, 3600))
        ->capture_default_str();
    verb.add_option("--for", limit_s, "Quit after this time, in s (0: never)")
        ->check(cli::NumberIn(0, 1e7))
        ->capture_default_str();
    verb.add_flag("--once", once, "Print the traffic of one interval, and quit");
    verb.add_flag("--json", json, "Print a JSON document for every interval instead of a table");
    cli::ShowExitCodes(verb, {.interruptible = true});
    verb.footer(kTopExplanation);
  }

  cli::NetworkArguments network;
  double interval_s = 1;
  double limit_s = 0;
  bool once = false;
  bool json = false;
};

// Time within which every run of this machine announces itself.
constexpr Duration kDiscovery = 2 * runtime::kBeaconEvery;

watch::Following FollowingOf(const TopArguments& arguments) {
  if (!arguments.network.Follows()) return watch::Following::kNothing;
  // The output of --once has the traffic of one run, and names the network of this run.
  return arguments.once ? watch::Following::kFirstRun : watch::Following::kNewestRun;
}

class Top {
 public:
  explicit Top(const TopArguments& arguments)
      : arguments_(arguments),
        statistics_(Clock::now()),
        network_(arguments.network.Url(), FollowingOf(arguments),
                 [this](std::string_view channel, runtime::Bytes bytes) {
                   statistics_.Add(channel, bytes, Clock::now());
                 }) {
    if (isatty(STDOUT_FILENO) == 1 && !arguments.once && !arguments.json) terminal_.emplace();
  }

  int Run() {
    if (!terminal_) Discover();
    const TimePoint began = Clock::now();
    const TimePoint end =
        arguments_.limit_s > 0 ? began + cli::FromSeconds(arguments_.limit_s) : TimePoint::max();
    const Duration interval = cli::FromSeconds(arguments_.interval_s);
    if (terminal_) ShowOnTerminal();
    for (TimePoint next = began + interval; Clock::now() < end; next += interval) {
      const bool whole = Listen(std::min(next, end));
      if (!whole && !WasInterrupted()) return kDone;  // the user pressed q
      if (!whole && arguments_.once) throw Interrupted("interrupted before the interval was over");
      if (!whole) return kInterrupted;
      Show();
      if (terminal_ && terminal_->gone()) throw std::runtime_error("the terminal is gone");
      if (arguments_.once) return kDone;
    }
    return kDone;
  }

 private:
  /// Waits until a run is announced, but no longer than kDiscovery. The first interval of the
  /// statistics begins after this wait, so it has all traffic of the run.
  void Discover() {
    const TimePoint end = Clock::now() + kDiscovery;
    while (network_.follows() && !network_.followed() && Clock::now() < end &&
           Listen(Clock::now() + watch::FollowedNetwork::kLookEvery)) {
    }
    statistics_.Observe(Clock::now());
  }

  /// Handles messages and keys. @return false on an interrupt, or if the user quits before `until`
  bool Listen(TimePoint until) {
    while (true) {
      const TimePoint now = Clock::now();
      if (now >= until) return true;
      const auto [network, followed] = network_.descriptors();
      std::array<pollfd, 3> waited{
          pollfd{.fd = network, .events = POLLIN, .revents = 0},
          pollfd{.fd = followed, .events = POLLIN, .revents = 0},
          pollfd{.fd = terminal_ ? terminal_->fd() : -1, .events = POLLIN, .revents = 0}};
      const Duration wait = std::min(until - now, watch::FollowedNetwork::kLookEvery);
      poll(waited.data(), waited.size(), static_cast<int>(Milliseconds(wait)) + 1);
      if (WasInterrupted()) return false;
      network_.Handle(now);
      network_.ForgetNames(statistics_.unknown_names());
      if (terminal_ && !HandleKeys()) return false;
    }
  }

  /// Handles the keys that were pressed. Draws again after a key, or if the window has another
  /// size.
  /// @return false if the user quits
  bool HandleKeys() {
    bool changed = watch::Terminal::size() != size_;
    while (const auto key = terminal_->NextKey()) {
      if (!screen_.OnKey(*key)) return false;
      changed = true;
    }
    if (changed) Draw();
    return true;
  }

  void Draw() {
    size_ = watch::Terminal::size();
    terminal_->Draw(screen_.Lines(size_.columns, size_.rows));
  }

  void ShowOnTerminal() {
    const TimePoint now = Clock::now();
    screen_.Show({.url = network_.url(),
                  .traffic = statistics_.Observe(now),
                  .senders = network_.ViewSenders(now),
                  .announced = network_.runs(),
                  .followed = network_.followed(),
                  .waiting = network_.waiting(now)});
    Draw();
  }

  void Show() {
    if (terminal_) return ShowOnTerminal();
    const watch::TrafficView view = statistics_.Observe(Clock::now());
    if (arguments_.json) {
      cli::PrintJson(Json(view), arguments_.once ? 2 : -1);
    } else {
      for (const watch::Line& line : Lines(view)) fmt::print("{}\n", line.text);
      if (!arguments_.once) fmt::print("\n");
    }
    std::fflush(stdout);
  }

  std::vector<watch::Line> Lines(const watch::TrafficView& view) const {
    std::vector<watch::Line> lines = watch::TrafficLines(view, network_.url());
    const std::vector<watch::Line> announced =
        watch::AnnouncedLines(network_.runs(), network_.followed());
    lines.insert(lines.begin() + 1, announced.begin(), announced.end());
    for (const runtime::WaitingRole& role : network_.waiting(Clock::now())) {
      lines.push_back({role.Text()});
    }
    std::ranges::move(watch::SenderLines(network_.ViewSenders(Clock::now())),
                      std::back_inserter(lines));
    return lines;
  }

  nlohmann::ordered_json Json(const watch::TrafficView& view) const {
    nlohmann::ordered_json json = watch::TrafficJson(view, network_.url());
    const watch::SendersView senders = network_.ViewSenders(Clock::now());
    json["senders"] =
        network_.numbered() ? watch::SendersJson(senders) : nlohmann::ordered_json(nullptr);
    json["own_overflow"] = senders.own_overflow;
    json["waiting"] = watch::WaitingJson(network_.waiting(Clock::now()));
    if (network_.follows()) {
      json["announced"] = watch::AnnouncedJson(network_.runs(), network_.followed());
    }
    return json;
  }

  const TopArguments& arguments_;
  watch::TrafficStatistics statistics_;
  watch::FollowedNetwork network_;
  std::optional<watch::Terminal> terminal_;
  watch::TopScreen screen_;
  watch::Terminal::Size size_;
};

}  // namespace

void AddTop(CLI::App& app, cli::Action& action) {
  CLI::App* verb = app.add_subcommand("top", "Show live traffic: channels and roles, run by run");
  const auto arguments = std::make_shared<TopArguments>(*verb);
  verb->callback([&action, arguments] {
    action = [arguments] {
      WatchInterrupts();
      return Top(*arguments).Run();
    };
  });
}

}  // namespace fogline
