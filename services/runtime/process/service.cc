#include "services/runtime/process/service.h"

#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/exit_code.h"
#include "common/interrupt.h"
#include "common/own_pauses.h"
#include "common/process/console.h"
#include "common/process/priority.h"
#include "common/process/this_process.h"
#include "services/runtime/discovery/run_seeker.h"
#include "services/runtime/discovery/waiting_roles.h"
#include "services/runtime/process/version.h"
#include "services/runtime/transport/lcm_url.h"

namespace fogline::runtime {
namespace {

// Priorities in real time. The world is the clock of the run and has the highest priority. The
// other roles have a lower priority, but run before all other processes of the machine.
constexpr int kWorldPriority = 2;
constexpr int kPriority = 1;
// If a network cannot be joined, the process tries again at this interval.
constexpr Duration kTryAgain = milliseconds(500);
// A process with --run-id whose network cannot be reached yet tries to join the network at this
// interval. The interval is short, because the whole run may wait for this process.
constexpr Duration kLookEvery = milliseconds(50);

struct Arguments {
  std::string name;  // name of the program
  Role role;
  std::string url;  // "": NetworkUrl() decides
  std::optional<std::int64_t> run_id;
  double wait_s = 60;
  TrafficOptions traffic;

  void AddTo(ProgramOptions& options) {
    options.Text("--lcm-url", url, "LCM network to join (default: see above)");
    options.RunId("--run-id", run_id, "Join only the run with this id");
    options.Seconds("--wait", wait_s, "Longest wait for a run, in s (0: for ever)", 1e6);
    options.Traffic(traffic);
  }
};

/// A process on its network: a bus, and the role's node on that bus.
class Service {
 public:
  /// @throws InputError or std::runtime_error if the process cannot join the network; Interrupted
  Service(const Arguments& arguments, const WorkFactory& make)
      : arguments_(arguments), make_(make), began_(Clock::now()), pauses_(began_) {
    JoinAtFirst(NetworkUrl(arguments.url));
    if (arguments.run_id) return;
    if (arguments.url.empty()) seeker_.emplace(arguments.role, MeetingUrl());
    Say(fmt::format("waiting for a run on {}{}", bus_->url(), HowToStartOne()));
  }

  /// Takes part in one run. @return the exit code
  int Run() {
    while (!own().left()) {
      if (WasInterrupted()) {
        own().Leave();
        return kInterrupted;
      }
      const TimePoint now = Clock::now();
      pauses_.Attend(now);
      if (own().released()) {
        if (arguments_.run_id) break;  // another process has the role in this run
        StartOver(now);
      } else if (own().Waits()) {
        WarnOfSignatures();
        NameTheFullRun();
        SayThatItWaits(now);
        Seek(now);
      } else if (work_->node().membership().RunnerSilent(now)) {
        SeekAnother(now);
      } else {
        seeker_.reset();
      }
      TakePart();
    }
    const std::string& error = own().message().error;
    if (error.empty()) return kDone;
    Complain(fmt::format("{}: error: {}", arguments_.name, error));
    return kRunFailed;
  }

 private:
  void Say(const std::string& what) const { Notice(fmt::format("{}: {}", arguments_.name, what)); }

  OwnStatus& own() { return work_->node().parts().own; }
  /// The role's information about its run.
  const RunNews& news() { return work_->node().parts().run; }

  /// Joins a network. If the process cannot join the network, it stays on its current network.
  /// @throws as OpenBus()
  void Join(const std::string& url, std::optional<std::int64_t> run_id) {
    auto bus = OpenBus(url, arguments_.traffic, arguments_.role);
    work_ = make_(*bus, run_id);
    bus_ = std::move(bus);
    starts_over_ = false;
    // In real time, the first step may come as soon as the role is READY. So the process raises its
    // priority first.
    work_->node().membership().BeforeReady([this] { PreferIfRealtime(); });
  }

  /// Joins the network for the first time. A process with the option --run-id was started by a
  /// runner on this network. If the network cannot be reached, this process tries again until the
  /// runner kills it, but at most for the time of --wait.
  /// @throws as Join(), and Interrupted
  void JoinAtFirst(const std::string& url) {
    for (bool waits = false;; waits = true) {
      try {
        return Join(url, arguments_.run_id);
      } catch (const NetworkAway& error) {
        const TimePoint now = pauses_.Attend(Clock::now());
        if (!arguments_.run_id || WaitIsOver(now)) throw;
        if (!waits) Say(fmt::format("{}; waits for the network", error.what()));
      }
      if (WasInterrupted()) throw Interrupted("interrupted");
      std::this_thread::sleep_for(kLookEvery);
    }
  }

  std::string HowToStartOne() const {
    // The text is empty for the recorder and for a role with --run-id, because a runner starts
    // these roles for its run.
    if (arguments_.role == Role::kRecorder || arguments_.run_id) return "";
    const std::string url =
        arguments_.url.empty() ? "" : fmt::format(" --lcm-url '{}'", arguments_.url);
    return fmt::format("; start one with: fogline run SCENARIO --external {}{}",
                       NameOf(arguments_.role), url);
  }

  void TakePart() {
    try {
      const TimePoint now = Clock::now();
      bus_->Wait(work_->node().Poll(now) - now);
    } catch (const std::exception& error) {
      if (!seeker_ || !seeker_->Tries()) throw;
      GoBack(error.what());  // the relay that an announcement named has ended
    }
  }

  bool WaitIsOver(TimePoint now) const {
    return arguments_.wait_s > 0 &&
           pauses_.HeldAgainst(began_, now) > std::chrono::duration<double>(arguments_.wait_s);
  }

  /// @throws std::runtime_error after the time of --wait
  void LimitWait(TimePoint now) const {
    if (!WaitIsOver(now)) return;
    throw std::runtime_error(
        fmt::format("waited {:g} s for a run on {} in vain{} (--wait 0 waits for ever)",
                    arguments_.wait_s, bus_->url(), HowToStartOne()));
  }

  /// Whether the process may look for a run on other networks: true if the command line names no
  /// network and no run.
  bool MaySeek() const { return arguments_.url.empty() && !arguments_.run_id; }

  /// Opens the seeker if the network of the meeting address can be joined. @return whether there is
  /// a seeker
  bool OpenSeeker(TimePoint now) {
    if (seeker_) return true;
    if (now < try_at_) return false;
    try_at_ = now + kTryAgain;
    try {
      seeker_.emplace(arguments_.role, MeetingUrl());
    } catch (const std::exception&) {  // the network is not there yet
      return false;
    }
    return true;
  }

  /// Goes to the network of a run that waits for the role. Goes back to the meeting address if the
  /// role cannot join that run (RunSeeker::InVain()).
  /// @throws std::runtime_error after the time of --wait
  void Seek(TimePoint now) {
    LimitWait(now);
    if (!MaySeek() || !OpenSeeker(now)) return;
    if (seeker_->InVain(now)) {
      return GoBack(
          news().full ? fmt::format("the announced run has its {} already", NameOf(arguments_.role))
                      : "no message of the announced run has come");
    }
    const auto run = seeker_->Look(now);
    if (!run) return;
    GoTo(*run);
  }

  void GoTo(const Announcement& run) {
    Say("joins " + run.Text());
    try {
      Join(run.url, std::nullopt);
    } catch (const std::exception& error) {  // the address came from the network and may be wrong
      GoBack(error.what());
    }
  }

  /// Called while the runner is silent. If another run waits for the role, the process goes to that
  /// run's network. (The node itself finds runs on the current network.)
  void SeekAnother(TimePoint now) {
    if (!MaySeek() || !OpenSeeker(now)) return;
    seeker_->Ignore(*news().id, bus_->url());
    const auto run = seeker_->Look(now);
    if (!run) return;
    own().Release(fmt::format("went to run {}: the runner was silent", run->run_id));
    began_ = now;
    GoTo(*run);
  }

  /// Called after the node has left its run. Joins the current network again as soon as possible,
  /// and waits for a run on this network. @throws std::runtime_error after the time of --wait
  void StartOver(TimePoint now) {
    if (!std::exchange(starts_over_, true)) {
      Say(own().message().error);
      began_ = now;
      try_at_ = now;
    }
    LimitWait(now);
    if (now < try_at_) return;
    const bool had_seeker = seeker_.has_value();
    if (MaySeek() && OpenSeeker(now) && !had_seeker && !SameNetwork(bus_->url(), MeetingUrl())) {
      seeker_->Stay(*news().id, now);
    }
    try_at_ = now + kTryAgain;
    try {
      Join(std::string(bus_->url()), std::nullopt);
    } catch (const std::exception&) {  // the network is not there yet
    }
  }

  void GoBack(const std::string& why) {
    seeker_->GiveUp(Clock::now());
    try {
      Join(MeetingUrl(), std::nullopt);
    } catch (const std::exception&) {  // stays on the current network
    }
    Say(fmt::format("{}; waiting for a run on {} again", why, bus_->url()));
  }

  /// Whether a runner has started this process. The runner gives such a process the id of its run,
  /// and the process ends when the runner ends.
  bool IsOfARunner() const { return arguments_.run_id && EndsWithItsParent(); }

  /// Sends a notice that the role waits, if a notice is due. A role that a runner has started sends
  /// no notice, because such a role waits only for a moment.
  void SayThatItWaits(TimePoint now) {
    if (!waiting_.Due(now) || IsOfARunner()) return;
    waiting_.Send(own().message(), *bus_, began_, now);
  }

  void WarnOfSignatures() {
    if (warned_) return;
    const std::string trouble = SignatureTrouble(bus_->unverified());
    warned_ = !trouble.empty();
    if (warned_) Say(trouble);
  }

  /// Prints a line about each run on this network that has no place for the role, once for each
  /// such run.
  void NameTheFullRun() {
    if (!news().full || std::exchange(full_, news().full) == news().full) return;
    Say(fmt::format("run {} on {} has its {} already; waiting for another run", *full_, bus_->url(),
                    NameOf(arguments_.role)));
  }

  void PreferIfRealtime() {
    if (!news().realtime) return;
    const int priority = arguments_.role == Role::kWorld ? kWorldPriority : kPriority;
    if (RunBeforeOthers(priority) || IsOfARunner()) return;  // a runner prints this for its roles
    if (std::exchange(said_not_preferred_, true)) return;
    Say("the kernel grants no real-time priority, or locks no memory: on a busy machine steps "
        "begin "
        "late; `fogline doctor` says how to grant it");
  }

  const Arguments& arguments_;
  const WorkFactory& make_;
  TimePoint began_;  // when the wait for a run began
  OwnPauses pauses_;
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<Work> work_;
  std::optional<RunSeeker> seeker_;  // set while the role has no run, or its runner is silent
  WaitingNotice waiting_;
  TimePoint try_at_{};  // when to try again to join a network
  bool starts_over_ = false;
  std::optional<std::int64_t> full_;  // the last run that NameTheFullRun() has named
  bool warned_ = false;
  bool said_not_preferred_ = false;
};

std::string_view PurposeOf(Role role) {
  for (const RoleInfo& info : kRoles) {
    if (info.role == role) return info.purpose;
  }
  return "";
}

}  // namespace

int RunProcess(int argc, char** argv, Role role, const WorkFactory& make,
               const std::function<void(ProgramOptions&)>& extend) {
  TakeStandardDescriptors();
  Arguments arguments{.name = fmt::format("fogline-{}", NameOf(role)), .role = role};
  const std::string& name = arguments.name;
  ProgramOptions options(
      name,
      fmt::format("Fogline's {}: {}.\n"
                  "Joins the next run on the LCM network, takes part in it, and leaves when the\n"
                  "runner says so. Without --lcm-url it uses $LCM_DEFAULT_URL or, if that is not\n"
                  "set, {}. It also joins runs that are\n"
                  "announced there and wait for this role.",
                  NameOf(role), PurposeOf(role), kLcmDefaultUrl),
      VersionText());
  arguments.AddTo(options);
  options.Footer(
      fmt::format("Exit codes: 0 stopped by the runner, 2 bad usage, 3 failed, 130 interrupted."
                  "\n\nExamples: in two shells of one machine; with a network of one's own\n"
                  "  {0}\n"
                  "  fogline run scenario/paper.json --external {1}\n\n"
                  "  {0} --lcm-url 'udpm://239.255.76.67:7700?ttl=0'\n"
                  "  fogline run scenario/paper.json --external {1} \\\n"
                  "    --lcm-url 'udpm://239.255.76.67:7700?ttl=0'",
                  name, NameOf(role)));
  if (extend) extend(options);
  if (const std::optional<int> exit_code = options.Parse(argc, argv)) return *exit_code;
  WatchInterrupts();
  FailWritesBeyondTheSizeLimit();
  try {
    return Service(arguments, make).Run();
  } catch (const Interrupted&) {
    return kInterrupted;
  } catch (const InputError& error) {
    Complain(fmt::format("{}: {}", name, error.what()));
    return kBadInput;
  } catch (const std::exception& error) {
    Complain(fmt::format("{}: error: {}", name, error.what()));
    return kRunFailed;
  }
}

}  // namespace fogline::runtime
