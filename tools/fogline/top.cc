// fogline top: shows the traffic on an LCM network as text.
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/interrupt.h"
#include "services/runtime/discovery/beacon.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/lcm_url.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/fogline/verbs.h"
#include "tools/watch/announced.h"
#include "tools/watch/senders/packet_tap.h"
#include "tools/watch/senders/senders_report.h"
#include "tools/watch/terminal.h"
#include "tools/watch/traffic_statistics.h"
#include "tools/watch/traffic_text.h"

namespace fogline {
namespace {

constexpr const char* kTopExplanation =
    R"(Per channel and run: messages since top listens; rate and bandwidth (payload) of the last
interval; jitter, the standard deviation of the times between messages in it; age of the last
message; steps that were still missing when a step came that is newer by 64 (lost), came after a
newer one (late), or came again (twice); undecodable messages, by apparent type. Per role, from its
STATUS: state, step, repairs asked for and served, processor time, memory, refusals; a role is
silent after 1 s without STATUS. Per sender of LCM traffic of any kind, by LCM's own numbers of
messages (udpm only): messages that are missing because they were lost on the way, or because top
itself was too slow (here). Without --lcm-url top follows the newest run that is announced on
this machine, and names all announced runs. Top sees only messages that reach this machine; a
message that is lost on the way here may have arrived elsewhere. q quits.

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

// After a flood of messages, poll() may not report the messages that remain. So top looks for such
// messages at this interval.
constexpr Duration kLookEvery = milliseconds(50);
// Interval at which top checks whether it should follow another run. The interval is not shorter,
// because opening a network takes time.
constexpr Duration kFollowEvery = milliseconds(100);
// Every run of this machine announces itself within this time.
constexpr Duration kDiscovery = 2 * runtime::kBeaconEvery;
// While a network is open, LCM stores every channel name that it receives, with about 300 bytes for
// each name. After this many unknown names top closes the network and opens it again.
constexpr std::int64_t kMostNames = 10'000;
// Largest number of announced runs that top remembers because their networks are unreachable.
constexpr std::size_t kMaxUnreachable = 64;

Duration FromSeconds(double seconds) {
  return duration_cast<Duration>(std::chrono::duration<double>(seconds));
}

/// A network that top watches.
class WatchedNetwork {
 public:
  WatchedNetwork(const std::string& url, runtime::Bus::Watcher watcher, watch::Senders& senders)
      : bus_(url), tap_(watch::PacketTap::Open(bus_.url(), senders)) {
    bus_.SubscribeAll(std::move(watcher));
  }

  /// Handles what has come. @throws std::runtime_error if the network's relay has ended
  void Drain() {
    bus_.Drain();
    // The tap comes second, so it has taken the packet of each message that the bus has handled.
    if (tap_) tap_->Drain(Clock::now());
  }

  int fd() const { return bus_.fd(); }
  const std::string& url() const { return bus_.url(); }
  /// Whether its packets have numbers. Those of a relay have none.
  bool numbered() const { return tap_ != nullptr; }

 private:
  runtime::Bus bus_;
  std::unique_ptr<watch::PacketTap> tap_;
};

class Top {
 public:
  explicit Top(const TopArguments& arguments)
      : arguments_(arguments), url_(arguments.network.Url()), statistics_(Clock::now()) {
    Open();
    if (arguments.network.Follows()) listener_.emplace(bus_->url());
    if (isatty(STDOUT_FILENO) == 1 && !arguments.once && !arguments.json) terminal_.emplace();
  }

  int Run() {
    if (!terminal_) Discover();
    const TimePoint began = Clock::now();
    const TimePoint end =
        arguments_.limit_s > 0 ? began + FromSeconds(arguments_.limit_s) : TimePoint::max();
    const Duration interval = FromSeconds(arguments_.interval_s);
    if (terminal_) Show();
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
  void Open() {
    bus_.reset();
    bus_.emplace(url_, Watcher(), senders_);
    names_ = statistics_.unknown_names();
  }

  /// Makes LCM forget the names of channels when there are too many names. Follow() then opens the
  /// network of the run again.
  void ForgetNames() {
    if (statistics_.unknown_names() - names_ < kMostNames) return;
    followed_.reset();
    Open();
  }

  runtime::Bus::Watcher Watcher() {
    return [this](std::string_view channel, runtime::Bytes bytes) {
      if (!watch::IsHousekeeping(channel)) statistics_.Add(channel, bytes, Clock::now());
    };
  }

  /// Waits at most kDiscovery for the announcement of a run, so that the first interval has all
  /// traffic of the run.
  void Discover() {
    const TimePoint end = Clock::now() + kDiscovery;
    while (listener_ && !followed_ && Clock::now() < end && Listen(Clock::now() + kLookEvery)) {
    }
    statistics_.Observe(Clock::now());
  }

  /// Also watches the network of the newest announced run.
  void Follow(TimePoint now) {
    if (!listener_ || now < follow_at_) return;
    follow_at_ = now + kFollowEvery;
    listener_->Look();
    runs_ = listener_->Runs();
    const auto newest = std::ranges::find_if(runs_, [this](const runtime::Announcement& run) {
      return std::ranges::find(unreachable_, run.run_id) == unreachable_.end();
    });
    if (newest == runs_.end()) return followed_.reset();
    std::rotate(runs_.begin(), newest, newest + 1);
    const runtime::Announcement& run = runs_.front();
    if (followed_ && runtime::SameNetwork(followed_->url(), run.url)) return;
    followed_.reset();
    if (runtime::SameNetwork(bus_->url(), run.url)) return;
    try {
      followed_.emplace(run.url, Watcher(), senders_);
    } catch (const std::exception&) {  // the address came from the network and may be invalid
      Leave(run.run_id);
    }
  }

  /// Handles messages of the followed run.
  void DrainFollowed() {
    if (!followed_) return;
    try {
      followed_->Drain();
    } catch (const std::exception&) {  // the relay of the run has ended
      Leave(runs_.front().run_id);
    }
  }

  /// Stops following this run, and remembers it as unreachable.
  void Leave(std::int64_t run_id) {
    followed_.reset();
    if (unreachable_.size() == kMaxUnreachable) unreachable_.clear();
    unreachable_.push_back(run_id);
  }

  /// Handles messages and keys. @return false on an interrupt, or if the user quits before `until`
  bool Listen(TimePoint until) {
    while (true) {
      const TimePoint now = Clock::now();
      if (now >= until) return true;
      std::array<pollfd, 3> waited{
          pollfd{.fd = bus_->fd(), .events = POLLIN, .revents = 0},
          pollfd{.fd = followed_ ? followed_->fd() : -1, .events = POLLIN, .revents = 0},
          pollfd{.fd = terminal_ ? terminal_->fd() : -1, .events = POLLIN, .revents = 0}};
      const Duration wait = std::min(until - now, kLookEvery);
      poll(waited.data(), waited.size(), static_cast<int>(Milliseconds(wait)) + 1);
      if (WasInterrupted()) return false;
      bus_->Drain();
      DrainFollowed();
      ForgetNames();
      Follow(now);
      if (terminal_ && terminal_->Key() == 'q') return false;
    }
  }

  void Show() {
    const watch::TrafficView view = statistics_.Observe(Clock::now());
    if (terminal_) return terminal_->Draw(Lines(view));
    if (arguments_.json) {
      cli::PrintJson(Json(view), arguments_.once ? 2 : -1);
    } else {
      for (const watch::Line& line : Lines(view)) fmt::print("{}\n", line.text);
      if (!arguments_.once) fmt::print("\n");
    }
    std::fflush(stdout);
  }

  /// The network of the followed run, or the given network if no run is followed.
  const std::string& url() const { return followed_ ? followed_->url() : bus_->url(); }

  bool Numbered() const { return bus_->numbered() || (followed_ && followed_->numbered()); }

  std::vector<watch::Line> Lines(const watch::TrafficView& view) const {
    std::vector<watch::Line> lines = watch::TrafficLines(view, url());
    const std::vector<watch::Line> announced = watch::AnnouncedLines(runs_, followed_.has_value());
    lines.insert(lines.begin() + 1, announced.begin(), announced.end());
    std::ranges::move(watch::SenderLines(senders_.View(Clock::now())), std::back_inserter(lines));
    return lines;
  }

  nlohmann::ordered_json Json(const watch::TrafficView& view) const {
    nlohmann::ordered_json json = watch::TrafficJson(view, url());
    const watch::SendersView senders = senders_.View(Clock::now());
    json["senders"] = Numbered() ? watch::SendersJson(senders) : nlohmann::ordered_json(nullptr);
    json["own_overflow"] = senders.own_overflow;
    if (listener_) json["announced"] = watch::AnnouncedJson(runs_, followed_.has_value());
    return json;
  }

  const TopArguments& arguments_;
  std::string url_;
  watch::TrafficStatistics statistics_;
  watch::Senders senders_;
  std::optional<WatchedNetwork> bus_;
  std::int64_t names_ = 0;                           // unknown names when bus_ was opened
  std::optional<runtime::BeaconListener> listener_;  // set if announced runs are to be followed
  std::vector<runtime::Announcement> runs_;          // announced runs, the followed one first
  std::optional<WatchedNetwork> followed_;           // the network of the followed run
  std::vector<std::int64_t> unreachable_;            // ids of runs
  TimePoint follow_at_{};
  std::optional<watch::Terminal> terminal_;
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
