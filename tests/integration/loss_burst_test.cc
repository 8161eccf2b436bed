// Real time on networks that lose many messages for a while. When the network is clean again, every
// role computes again, whatever was lost. A run that succeeds has a whole log.
#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <thread>

#include <fmt/core.h>

#include "services/runtime/transport/bus.h"
#include "tests/integration/not_whole.h"
#include "tests/support/network_test.h"

namespace fogline::test {
namespace {

constexpr const char* kUrl = "udpm://239.255.76.67:7700?ttl=1";

struct Burst {
  int loss_pct;
  double length_s;
  std::size_t where;  // index of the machine that loses messages, or kEverywhere
};
constexpr std::size_t kEverywhere = 99;

/// A run with several bursts of loss, one after the other.
struct Plan {
  int rate_hz;
  int machines;
  std::vector<Burst> bursts;
  double clean_s;  // the time after each burst, without loss
};

/// A role, and the time from the moment at which the network was clean again until the role
/// computed in time. A role computes in time if it computes within a period after the world began
/// the step. The world computes in time if it begins a step within two periods after the step
/// before.
struct Back {
  Role role;
  std::optional<double> after_s;
};

struct Played {
  Plan plan;
  std::vector<std::vector<Back>> back;  // by burst
  std::string trouble;                  // "" if the run ended in an allowed way
  std::int64_t restarts = 0;
};

/// Machines that can lose all kinds of datagrams for a while.
class Machines {
 public:
  explicit Machines(int count) {
    if (count == 1) {
      alone_.emplace("alone");
      alone_->RouteMulticastToItself();
      all_ = {&*alone_};
    } else {
      lab_.emplace(count);
      for (const Machine& machine : lab_->machines()) all_.push_back(&machine);
    }
  }
  const Machine& operator[](std::size_t i) const { return *all_[i]; }
  void Begin(const Burst& burst) const {
    for (const Machine* machine : In(burst)) machine->LoseUdp(burst.loss_pct);
  }
  void End(const Burst& burst) const {
    for (const Machine* machine : In(burst)) machine->LoseNothing();
  }

 private:
  std::vector<const Machine*> In(const Burst& burst) const {
    return burst.where == kEverywhere ? all_ : std::vector{all_.at(burst.where)};
  }
  std::optional<Machine> alone_;
  std::optional<Lab> lab_;
  std::vector<const Machine*> all_;
};

/// Hears, on the runner's machine, when the roles of a run publish which steps.
class Listener {
 public:
  Listener(const Machine& machine, Duration period) : period_(period) {
    machine.Enter([this] {
      bus_.emplace(kUrl);
      ForEachStepChannel([this]<class M>(std::size_t channel) {
        bus_->Subscribe(kChannels[channel].name, [this, channel](runtime::Arrival& arrival) {
          const std::int64_t step = runtime::ReadInt64(arrival.bytes(), runtime::kStepOffset);
          Heard(kChannels[channel].from, step, arrival.time());
        });
      });
      bus_->Subscribe(ChannelOf<status_t>().name, [this](runtime::Arrival& arrival) {
        const auto* status = arrival.As<status_t>();
        if (status == nullptr || status->role != NameOf(Role::kRecorder)) return;
        // The recorder sends STATUS only now and then, so its period does not count: it is back if
        // its last written step began after the burst.
        if (began_.contains(status->header.step)) back_.try_emplace(Role::kRecorder, Clock::now());
      });
    });
  }

  void ListenUntil(TimePoint end) {
    for (TimePoint now = Clock::now(); now < end; now = Clock::now()) bus_->Wait(end - now);
  }
  bool WaitForStep(std::int64_t step, const Background& run) {
    const TimePoint end = Clock::now() + std::chrono::seconds(60);
    while (newest_ < step && Clock::now() < end && IsAlive(run.pid())) {
      bus_->Wait(milliseconds(20));
    }
    return newest_ >= step;
  }
  /// Forgets all steps so far. Since() then counts only steps that begin later.
  void Forget() {
    began_.clear();
    back_.clear();
  }
  std::vector<Back> Since(TimePoint clean) const {
    std::vector<Back> all;
    for (const RoleInfo& info : kRoles) {
      const auto back = back_.find(info.role);
      all.push_back({info.role, back == back_.end()
                                    ? std::nullopt
                                    : std::optional(Seconds(back->second - clean))});
    }
    return all;
  }

 private:
  void Heard(Role from, std::int64_t step, TimePoint now) {
    if (from == Role::kWorld) {
      if (step <= newest_) return;  // sent again
      if (step == newest_ + 1 && now - newest_heard_ <= 2 * period_) back_.try_emplace(from, now);
      newest_ = step;
      newest_heard_ = now;
      began_[step] = now;
      return;
    }
    const auto began = began_.find(step);
    if (began != began_.end() && now - began->second <= period_) back_.try_emplace(from, now);
  }

  Duration period_;
  std::optional<runtime::Bus> bus_;
  std::int64_t newest_ = -1;
  TimePoint newest_heard_{};
  std::map<std::int64_t, TimePoint> began_;
  std::map<Role, TimePoint> back_;
};

/// One run of a plan.
class BurstRun {
 public:
  explicit BurstRun(Plan plan)
      : plan_(std::move(plan)),
        machines_(plan_.machines),
        listener_(machines_[0], std::chrono::duration_cast<Duration>(
                                    std::chrono::duration<double>(1.0 / plan_.rate_hz))) {}

  Played Play() {
    Played result{.plan = plan_};
    std::deque<Background> roles;
    std::vector<std::string> command = Command();
    if (plan_.machines > 1) StartRoles(roles, command);
    Background run(machines_[0].On(command));
    if (!listener_.WaitForStep(plan_.rate_hz / 2, run)) {
      result.trouble = "did not begin: " + run.Err();
      return result;
    }
    for (const Burst& burst : plan_.bursts) {
      result.back.push_back(Suffer(burst));
      if (IsAlive(run.pid())) continue;
      result.trouble = "ended before its last burst was over: " + run.Err();
      return result;
    }
    Judge(run, result);
    return result;
  }

 private:
  static constexpr double kRest_s = 2;  // seconds without bursts, at both ends of the run
  // For the commands that begin and end a burst on each machine, beside other runs.
  static constexpr double kCommands_s = 1;

  std::vector<std::string> Command() const {
    double run_s = 2 * kRest_s;
    for (const Burst& burst : plan_.bursts) run_s += burst.length_s + plan_.clean_s + kCommands_s;
    return {Program("fogline"),
            "run",
            "scenario/paper.json",
            "--json",
            "--realtime",
            "--set",
            "/step_s=" + std::to_string(1.0 / plan_.rate_hz),
            "--set",
            "/steps=" + std::to_string(static_cast<int>(run_s * plan_.rate_hz)),
            "--lcm-url",
            kUrl,
            "--log",
            folder_.File("run.lcm")};
  }
  void StartRoles(std::deque<Background>& roles, std::vector<std::string>& command) const {
    const std::map<Role, std::size_t> places{{Role::kWorld, 1},  {Role::kRadar, 2},
                                             {Role::kLidar, 1},  {Role::kFusion, 2},
                                             {Role::kDriver, 1}, {Role::kArbitrator, 2}};
    for (const auto& [role, place] : places) {
      const std::string name(NameOf(role));
      roles.emplace_back(machines_[place].On({Program("fogline-" + name), "--lcm-url", kUrl}));
      command.insert(command.end(), {"--external", name});
    }
  }
  std::vector<Back> Suffer(const Burst& burst) {
    const TimePoint begin = Clock::now();
    machines_.Begin(burst);
    listener_.ListenUntil(begin + Periods(burst.length_s));
    const TimePoint clean = Clock::now();
    machines_.End(burst);
    listener_.Forget();
    listener_.ListenUntil(clean + Periods(plan_.clean_s));
    return listener_.Since(clean);
  }
  static Duration Periods(double seconds) {
    return duration_cast<Duration>(std::chrono::duration<double>(seconds));
  }
  /// Checks that the run either succeeded with a whole log or failed with an error text.
  void Judge(Background& run, Played& result) const {
    const int code = run.Wait();
    const auto json = nlohmann::json::parse(run.Out(), nullptr, false);
    const std::string err = run.Err();
    if (json.is_object()) {
      for (const auto& role : json["restarts"]) result.restarts += role["count"].get<int>();
    }
    if (code == 0) {
      if (!json.is_object() || json["realtime"].value("unlogged_messages", 0) != 0) {
        result.trouble = "ended well without a whole log: " + run.Out() + err;
      }
    } else if (code != kFailed || err.find(kNotWhole) == std::string::npos) {
      result.trouble = "exit code " + std::to_string(code) + ": " + err;
    }
  }

  ScratchFolder folder_;
  Plan plan_;
  Machines machines_;
  Listener listener_;
};

/// Plays plans, several at the same time, because a run mostly waits.
std::vector<Played> PlayAll(std::deque<Plan> plans, unsigned at_once) {
  std::vector<Played> results;
  std::mutex mutex;
  const auto work = [&] {
    while (true) {
      std::unique_lock lock(mutex);
      if (plans.empty()) return;
      Plan plan = plans.front();
      plans.pop_front();
      lock.unlock();
      Played result;
      try {
        result = BurstRun(plan).Play();
      } catch (const std::exception& error) {
        result = {.plan = plan, .trouble = error.what()};
      }
      lock.lock();
      results.push_back(std::move(result));
    }
  };
  std::deque<std::thread> threads;
  for (unsigned i = 0; i < at_once; ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  return results;
}

/// The figures of one kind of burst at one rate.
struct Figures {
  int bursts = 0;
  int back = 0;  // bursts after which every role was back within the limit
  double longest_s = 0;
};

class LossBurstInRealtimeTest : public NetworkTest {
 protected:
  /// Expects that every role was back within the limit after every burst, and that every run ended
  /// in an allowed way.
  void Judge(const std::vector<Played>& results, double limit_s) {
    for (const Played& result : results) {
      const std::string what = std::to_string(result.plan.rate_hz) + " Hz on " +
                               std::to_string(result.plan.machines) + " machines";
      EXPECT_EQ(result.trouble, "") << what;
      EXPECT_EQ(result.back.size(), result.plan.bursts.size()) << what;
      // A burst is no reason to start a role again: none hangs, and none is deaf for long.
      EXPECT_EQ(result.restarts, 0) << what;
      restarts_ += result.restarts;
      for (std::size_t i = 0; i < result.back.size(); ++i) {
        const Burst& burst = result.plan.bursts[i];
        Figures& of = figures_[result.plan.rate_hz][{burst.loss_pct, burst.length_s}];
        bool all = true;
        for (const Back& back : result.back[i]) {
          EXPECT_TRUE(back.after_s && *back.after_s <= limit_s)
              << what << ": " << NameOf(back.role) << " after " << burst.length_s << " s of "
              << burst.loss_pct
              << " %: " << (back.after_s ? std::to_string(*back.after_s) + " s" : "deaf");
          all = all && back.after_s && *back.after_s <= limit_s;
          of.longest_s = std::max(of.longest_s, back.after_s.value_or(result.plan.clean_s));
        }
        ++of.bursts;
        of.back += all ? 1 : 0;
      }
    }
  }

  /// Prints one table for each rate, as in docs/real-time.md.
  void Print() const {
    Figures sum;
    for (const auto& [rate, cells] : figures_) {
      std::set<double> lengths;
      std::set<int> losses;
      for (const auto& [kind, of] : cells) {
        losses.insert(kind.first);
        lengths.insert(kind.second);
        sum.bursts += of.bursts;
        sum.back += of.back;
        sum.longest_s = std::max(sum.longest_s, of.longest_s);
      }
      std::string table = fmt::format("| {} Hz: loss |", rate);
      for (const double length_s : lengths) table += fmt::format(" {:g} s |", length_s);
      table += "\n|---|";
      for (std::size_t i = 0; i < lengths.size(); ++i) table += "---|";
      for (const int loss_pct : losses) {
        table += fmt::format("\n| {} % |", loss_pct);
        for (const double length_s : lengths) {
          const auto of = cells.find({loss_pct, length_s});
          table += of == cells.end() ? " |"
                                     : fmt::format(" {} of {}, {:.2f} s |", of->second.back,
                                                   of->second.bursts, of->second.longest_s);
        }
      }
      fmt::print("{}\n", table);
    }
    fmt::print("{} of {} bursts: every role back in time; longest {:.2f} s; {} restarts\n",
               sum.back, sum.bursts, sum.longest_s, restarts_);
  }

 private:
  std::map<int, std::map<std::pair<int, double>, Figures>> figures_;
  std::int64_t restarts_ = 0;
};

TEST_F(LossBurstInRealtimeTest, LeavesNoRoleDeaf) {
  constexpr double kClean_s = 1.5;
  const Plan plan{.rate_hz = 50,
                  .machines = 1,
                  .bursts = {{70, 1, kEverywhere}, {60, 1, kEverywhere}, {100, 0.5, kEverywhere}},
                  .clean_s = kClean_s};
  Judge(PlayAll({plan}, 1), kClean_s);
  Print();
}

/// Bursts of every kind. The parameter is their number in hundreds.
class EveryLossBurstInRealtimeTest : public LossBurstInRealtimeTest,
                                     public testing::WithParamInterface<std::size_t> {};

TEST_P(EveryLossBurstInRealtimeTest, IsOverASecondAfterTheNetworkIsClean) {
  const char* asked = std::getenv("FOGLINE_TEST_BURSTS");
  const std::size_t repeats =
      asked == nullptr ? GetParam() : static_cast<std::size_t>(std::max(1, std::atoi(asked) / 100));
  std::deque<Plan> plans;
  for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
    for (const int machines : {1, 3}) {
      for (const int rate_hz : {10, 50}) {
        for (const int loss_pct : {10, 30, 70, 90, 100}) {
          Plan plan{.rate_hz = rate_hz, .machines = machines, .bursts = {}, .clean_s = 2};
          for (const double length_s : {0.1, 0.3, 1.0, 2.0, 3.0}) {
            // Of three machines, bursts hit all of them and one of them in turn.
            const std::size_t number = plan.bursts.size();
            const bool one = machines > 1 && (repeat + number) % 2 == 1;
            plan.bursts.push_back({loss_pct, length_s, one ? number % 3 : kEverywhere});
          }
          plans.push_back(std::move(plan));
        }
      }
    }
  }
  ASSERT_FALSE(plans.empty());
  constexpr unsigned kAtOnce = 4;
  Judge(PlayAll(std::move(plans), kAtOnce), 1.0);
  Print();
}

INSTANTIATE_TEST_SUITE_P(Campaign, EveryLossBurstInRealtimeTest, testing::Values(2U));

}  // namespace
}  // namespace fogline::test
