// The contents of the log of a run in real time, and checks of the motion of the cars.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "services/log/event_log.h"
#include "services/runtime/wire/wire.h"

namespace fogline::test {

inline constexpr double kStepS = 0.1;
inline constexpr std::int64_t kStepUs = 100'000;
// Defaults of the sections health and minimal_risk.
inline constexpr std::int64_t kRecoverSteps = 5;
inline constexpr double kDecelerationMps2 = 1;
inline constexpr double kJerkMps3 = 1;
// Rounding of numbers near 100 m.
inline constexpr double kRounding = 1e-9;

/// The messages of a log in real time, by step.
struct Log {
  explicit Log(const std::string& file) {
    log::EventLogReader reader(file);
    while (const auto event = reader.Next()) {
      Take(event->channel, event->data, truth);
      Take(event->channel, event->data, command);
      Take(event->channel, event->data, driver);
      Take(event->channel, event->data, follower);
      if (event->data.size() >= runtime::kHeaderEnd) {
        steps[std::string(event->channel)].insert(
            runtime::ReadInt64(event->data, runtime::kStepOffset));
      }
      status_t heard{};
      if (event->channel == ChannelOf<status_t>().name && runtime::Decode(event->data, heard)) {
        status.push_back(heard);
      }
    }
  }

  template <class M>
  static void Take(std::string_view channel, runtime::Bytes data,
                   std::map<std::int64_t, M>& messages) {
    M message{};
    if (channel == ChannelOf<M>().name && runtime::Decode(data, message)) {
      messages[message.header.step] = message;
    }
  }

  std::int64_t last() const { return truth.rbegin()->first; }

  /// The number of steps for which a role lacked an input that was due. The role itself counts
  /// these steps.
  std::int64_t MissesOf(const std::string& role) const {
    std::map<std::int64_t, std::int64_t> of_instance;
    for (const status_t& said : status) {
      if (said.role != role) continue;
      std::int64_t& most = of_instance[said.instance];
      most = std::max(most, said.deadline_misses);
    }
    std::int64_t misses = 0;
    for (const auto& [instance, most] : of_instance) misses += most;
    return misses;
  }

  /// The loss of a channel, from the first STATUS that reports this loss. FirstLossOf() searches
  /// from the step `from` on, and skips the STATUS of the recorder.
  struct Loss {
    std::int64_t step;  // the current step of the run
    std::string reporter;
    std::string culprit_channel;
  };
  std::optional<Loss> FirstLossOf(const std::string& channel, std::int64_t from) const {
    for (const status_t& said : status) {
      if (said.role == NameOf(Role::kRecorder) || said.header.utime < from * kStepUs) continue;
      for (std::size_t i = 0; i < said.input.size(); ++i) {
        if (said.input[i] != channel || said.input_state[i] != status_t::INPUT_LOST) continue;
        return Loss{.step = said.header.utime / kStepUs,
                    .reporter = said.role,
                    .culprit_channel = said.waiting_for};
      }
    }
    return std::nullopt;
  }

  /// The missing steps of a channel around a given step. `before` is the channel's last step before
  /// them. `back` is the channel's first step after them, or last() + 1 if the channel does not
  /// come back.
  struct Silence {
    std::int64_t before;
    std::int64_t back;
  };
  Silence SilenceAt(const std::string& channel, std::int64_t step) const {
    const std::set<std::int64_t>& there = steps.at(channel);
    const auto after = there.upper_bound(step);
    return {.before = after == there.begin() ? -1 : *std::prev(after),
            .back = after == there.end() ? last() + 1 : *after};
  }

  /// The length of the longest sequence of steps that a channel lacks, from step `from` on.
  std::int64_t LongestSilence(const std::string& channel, std::int64_t from) const {
    std::int64_t longest = 0;
    std::int64_t silent = 0;
    for (std::int64_t step = from; step <= last(); ++step) {
      silent = steps.at(channel).contains(step) ? 0 : silent + 1;
      longest = std::max(longest, silent);
    }
    return longest;
  }

  std::map<std::int64_t, truth_t> truth;
  std::map<std::int64_t, arbitration_t> command;
  std::map<std::int64_t, driver_command_t> driver;
  std::map<std::int64_t, follower_command_t> follower;
  std::map<std::string, std::set<std::int64_t>> steps;  // by channel
  std::vector<status_t> status;
};

/// @return the message of a step, nullptr if there is none
template <class M>
const M* Find(const std::map<std::int64_t, M>& messages, std::int64_t step) {
  const auto at = messages.find(step);
  return at == messages.end() ? nullptr : &at->second;
}

/// One of the cars in a TRUTH.
struct Car {
  double speed_mps;
  double acceleration_mps2;
};
inline Car Host(const truth_t& truth) {
  return {truth.host_speed_mps, truth.host_acceleration_mps2};
}
inline Car Follower(const truth_t& truth) {
  return {truth.follower_speed_mps.at(0), truth.follower_acceleration_mps2.at(0)};
}

/// Checks that a process applies, in each step, the value in the message of this step. If the
/// message is missing or late, the process must keep the value of the previous step. The log shows
/// which messages exist. The process reports how many messages were late.
class Obedience {
 public:
  /// @param role the role of this process
  Obedience(const Log& log, const std::string& role) : role_(role), misses_(log.MissesOf(role)) {}
  ~Obedience() {
    EXPECT_LE(late_, misses_) << role_ << " does not say how often it was not in time";
  }
  Obedience(const Obedience&) = delete;
  Obedience& operator=(const Obedience&) = delete;

  void Expect(std::int64_t step, double done, std::optional<double> told, double held) {
    if (told && std::abs(done - *told) <= kRounding) return;
    if (told) ++late_;
    EXPECT_NEAR(done, held, kRounding) << role_ << " neither obeys nor holds on at step " << step;
  }

 private:
  std::string role_;
  std::int64_t misses_;
  std::int64_t late_ = 0;
};

/// Expects that the host follows the command of each step. While the human drives, the command must
/// be the acceleration of DRIVER_COMMAND.
inline void ExpectCommandsAreCarriedOut(const Log& log, std::int64_t from, std::int64_t to) {
  Obedience world(log, "world");
  Obedience arbitrator(log, "arbitrator");
  for (std::int64_t step = from; step < to; ++step) {
    ASSERT_TRUE(log.truth.contains(step + 1)) << step;
    const arbitration_t* command = Find(log.command, step);
    world.Expect(step, log.truth.at(step + 1).host_acceleration_mps2,
                 command ? std::optional(command->acceleration_mps2) : std::nullopt,
                 log.truth.at(step).host_acceleration_mps2);
    const driver_command_t* human = Find(log.driver, step);
    if (command == nullptr || command->mode != arbitration_t::HUMAN || human == nullptr) continue;
    const driver_command_t* before = Find(log.driver, step - 1);
    arbitrator.Expect(step, command->acceleration_mps2, human->acceleration_mps2,
                      before ? before->acceleration_mps2 : human->acceleration_mps2);
  }
}

/// Expects that the following car follows its command in each step.
inline void ExpectFollowerObeys(const Log& log, std::int64_t from, std::int64_t to) {
  Obedience world(log, "world");
  for (std::int64_t step = from; step < to; ++step) {
    const follower_command_t* told = Find(log.follower, step);
    world.Expect(step, Follower(log.truth.at(step + 1)).acceleration_mps2,
                 told ? std::optional(told->acceleration_mps2.at(0)) : std::nullopt,
                 Follower(log.truth.at(step)).acceleration_mps2);
  }
}

/// Expects that a car brakes to standstill from `step` on, and stays there. The limits of its
/// deceleration and jerk are kDecelerationMps2 and kJerkMps3.
inline void ExpectStandstillWithinLimits(const Log& log, std::int64_t step,
                                         Car (*car)(const truth_t&)) {
  EXPECT_EQ(car(log.truth.at(log.last())).speed_mps, 0) << "does not stand at the end";
  bool stood = false;
  for (std::int64_t k = step; k < log.last(); ++k) {
    const Car before = car(log.truth.at(k));
    const Car after = car(log.truth.at(k + 1));
    const double jerk = (after.acceleration_mps2 - before.acceleration_mps2) / kStepS;
    EXPECT_LE(std::abs(jerk), kJerkMps3 + kRounding) << "step " << k;
    // A car that brakes harder than the limit at the beginning releases the brake gradually.
    EXPECT_GE(after.acceleration_mps2,
              std::min(-kDecelerationMps2, before.acceleration_mps2) - kRounding)
        << "step " << k;
    EXPECT_TRUE(!stood || after.speed_mps == 0) << "drives off at step " << k;
    stood = stood || after.speed_mps == 0;
  }
}

inline void ExpectNoCollision(const Log& log) {
  for (const auto& [step, truth] : log.truth) {
    ASSERT_EQ(truth.collision, truth_t::COLLISION_NONE) << "step " << step;
  }
}

/// Expects that `holds` accepts the mode of each command in these steps.
template <class Predicate>
void ExpectMode(const Log& log, std::int64_t from, std::int64_t to, Predicate&& holds,
                const char* what) {
  for (auto at = log.command.lower_bound(from); at != log.command.lower_bound(to); ++at) {
    EXPECT_TRUE(holds(at->second.mode)) << what << " at step " << at->first << ", but mode is "
                                        << static_cast<int>(at->second.mode);
  }
}

}  // namespace fogline::test
