// Runs in real time on networks that lose many messages for a while. When the network loses no more
// messages, every role must be in time again, no matter which messages were lost. If a run
// succeeds, its log must be complete.
#pragma once

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
#include "tests/integration/realtime/not_whole.h"
#include "tests/support/network_test.h"

namespace fogline::test {

inline constexpr const char* kBurstUrl = "udpm://239.255.76.67:7700?ttl=1";

struct Burst {
  int loss_pct;
  double length_s;
  std::size_t where;  // index of the machine that loses messages, or kEverywhere
};
inline constexpr std::size_t kEverywhere = 99;

/// A run with several bursts of loss, one after the other.
struct BurstPlan {
  int rate_hz;
  int machines;
  std::vector<Burst> bursts;
  double clean_s;  // the time after each burst, without loss
};

/// The time from the end of a burst until a role was in time again; no value if the role was never
/// in time again. A role is in time if it publishes a step within a period after the world began
/// the step. The world is in time if it begins a step within two periods after the previous step.
/// The recorder is in time if it has written a step that began after the burst.
struct BackAfterBurst {
  Role role;
  std::optional<double> after_s;
};

struct PlayedBursts {
  BurstPlan plan;
  std::vector<std::vector<BackAfterBurst>> back;  // by burst
  std::string trouble;                            // "" if the run ended in an allowed way
  std::int64_t restarts = 0;
};

/// Machines that can lose all kinds of datagrams for a while.
class BurstMachines {
 public:
  explicit BurstMachines(int count) {
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

/// Records, on the runner's machine, the times at which the steps of each role arrive.
class BurstListener {
 public:
  BurstListener(const Machine& machine, Duration period) : period_(period) {
    machine.Enter([this] {
      bus_.emplace(kBurstUrl);
      ForEachStepChannel([this]<class M>(std::size_t channel) {
        bus_->Subscribe(kChannels[channel].name, [this, channel](runtime::Arrival& arrival) {
          const std::int64_t step = runtime::ReadInt64(arrival.bytes(), runtime::kStepOffset);
          Heard(kChannels[channel].from, step, arrival.time());
        });
      });
      bus_->Subscribe(ChannelOf<status_t>().name, [this](runtime::Arrival& arrival) {
        const auto* status = arrival.As<status_t>();
        if (status == nullptr || status->role != NameOf(Role::kRecorder)) return;
        // The recorder does not send STATUS in every period. So the recorder counts as back if the
        // last step that it has written began after the burst.
        if (began_.contains(status->header.step)) back_.try_emplace(Role::kRecorder, Clock::now());
      });
    });
  }

  void ListenUntil(TimePoint end) {
    for (TimePoint now = Clock::now(); now < end; now = Clock::now()) bus_->Wait(end - now);
    bus_->Drain();
  }
  bool WaitForStep(std::int64_t step, const Background& run) {
    const TimePoint end = Clock::now() + kPatience;
    while (newest_ < step && Clock::now() < end && IsAlive(run.pid())) {
      bus_->Wait(milliseconds(20));
    }
    return newest_ >= step;
  }
  /// Forgets all steps so far. Since() then counts only steps that begin later.
  void Forget() {
    bus_->Drain();  // messages that have come, and that are not handled yet
    began_.clear();
    back_.clear();
  }
  std::vector<BackAfterBurst> Since(TimePoint clean) const {
    std::vector<BackAfterBurst> all;
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
      if (step <= newest_) return;  // the world has sent the step again
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
  explicit BurstRun(BurstPlan plan)
      : plan_(std::move(plan)),
        machines_(plan_.machines),
        listener_(machines_[0], std::chrono::duration_cast<Duration>(
                                    std::chrono::duration<double>(1.0 / plan_.rate_hz))) {}

  PlayedBursts Play() {
    PlayedBursts result{.plan = plan_};
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
      result.trouble = "ended before its last burst was over: " + run.Err() + run.Out();
      return result;
    }
    Judge(run, result);
    return result;
  }

 private:
  static constexpr double kRest_s = 2;  // seconds without bursts, at both ends of the run
  // Time for the commands that begin and end a burst on each machine, while other runs use the
  // processors.
  static constexpr double kCommands_s = 3;

  /// The command line of the run. In a burst of loss each car may stop by itself, and the cars may
  /// hit each other. So the run continues after a collision.
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
            "--set",
            "/world/end_on_collision=false",
            "--lcm-url",
            kBurstUrl,
            "--log",
            folder_.File("run.lcm")};
  }
  void StartRoles(std::deque<Background>& roles, std::vector<std::string>& command) const {
    const std::map<Role, std::size_t> places{{Role::kWorld, 1},  {Role::kRadar, 2},
                                             {Role::kLidar, 1},  {Role::kFusion, 2},
                                             {Role::kDriver, 1}, {Role::kArbitrator, 2}};
    for (const auto& [role, place] : places) {
      const std::string name(NameOf(role));
      roles.emplace_back(machines_[place].On({Program("fogline-" + name), "--lcm-url", kBurstUrl}));
      command.insert(command.end(), {"--external", name});
    }
  }
  std::vector<BackAfterBurst> Suffer(const Burst& burst) {
    const TimePoint begin = Clock::now();
    machines_.Begin(burst);
    listener_.ListenUntil(begin + Periods(burst.length_s));
    machines_.End(burst);
    const TimePoint clean = Clock::now();
    listener_.Forget();
    listener_.ListenUntil(clean + Periods(plan_.clean_s));
    return listener_.Since(clean);
  }
  static Duration Periods(double seconds) {
    return duration_cast<Duration>(std::chrono::duration<double>(seconds));
  }
  /// Checks that the run either succeeded with a whole log or failed with an error text.
  void Judge(Background& run, PlayedBursts& result) const {
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
  BurstPlan plan_;
  BurstMachines machines_;
  BurstListener listener_;
};

/// Executes plans, `at_once` of them at the same time. This is possible because a run waits for
/// most of its time.
inline std::vector<PlayedBursts> PlayAll(std::deque<BurstPlan> plans, unsigned at_once) {
  std::vector<PlayedBursts> results;
  std::mutex mutex;
  const auto work = [&] {
    while (true) {
      std::unique_lock lock(mutex);
      if (plans.empty()) return;
      BurstPlan plan = plans.front();
      plans.pop_front();
      lock.unlock();
      PlayedBursts result;
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
struct BurstFigures {
  int bursts = 0;
  int back = 0;  // bursts after which every role was in time again within the limit
  double longest_s = 0;
};

class LossBurstInRealtimeTest : public NetworkTest {
 protected:
  /// Expects that every role was back within the limit after every burst, and that every run ended
  /// in an allowed way.
  void Judge(const std::vector<PlayedBursts>& results, double limit_s) {
    for (const PlayedBursts& result : results) {
      const std::string what = std::to_string(result.plan.rate_hz) + " Hz on " +
                               std::to_string(result.plan.machines) + " machines";
      EXPECT_EQ(result.trouble, "") << what;
      EXPECT_EQ(result.back.size(), result.plan.bursts.size()) << what;
      // A burst makes no role hang, and no role deaf for long. So the runner must not start a role
      // again.
      EXPECT_EQ(result.restarts, 0) << what;
      restarts_ += result.restarts;
      for (std::size_t i = 0; i < result.back.size(); ++i) {
        const Burst& burst = result.plan.bursts[i];
        BurstFigures& of = figures_[result.plan.rate_hz][{burst.loss_pct, burst.length_s}];
        bool all = true;
        for (const BackAfterBurst& back : result.back[i]) {
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
    BurstFigures sum;
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
  std::map<int, std::map<std::pair<int, double>, BurstFigures>> figures_;
  std::int64_t restarts_ = 0;
};

}  // namespace fogline::test
