// A role whose algorithm and FireRule only count or list the calls of their functions. The test
// publishes the messages of all other processes (script.h).
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "services/runtime/node/node.h"
#include "tests/unit/services/runtime/script.h"

namespace fogline::test {

/// A role with the channels of the driver: TRUTH is the input, and DRIVER_COMMAND is the output.
class FakeRole final : public runtime::Work {
 public:
  static constexpr const char* kWaitingFor = "the test";

  /// A FireRule that accepts a message if the input has no message of its step yet. Otherwise the
  /// verdict is that of StepRing::Classify(). A test can set another verdict.
  class Rule final : public runtime::FireRule {
   public:
    explicit Rule(runtime::Parts& parts) : parts_(parts) {}

    void OnGo(const run_t& /*run*/, TimePoint /*now*/) override { ++gos; }
    void OnInput(std::size_t input, std::int64_t step, runtime::Arrival& arrival) override {
      ++heard;
      const runtime::StepRing& ring = parts_.inputs.all()[input].ring;
      const auto judged = verdict.value_or(ring.Has(step) ? ring.Classify(step, arrival.bytes(), 0)
                                                          : runtime::StepRing::Verdict::kNew);
      if (parts_.inputs.Keep(input, step, arrival, judged)) kept.push_back(step);
    }
    TimePoint Poll(TimePoint now) override {
      ++polls;
      return now + wait;
    }
    void OnProgress() override { ++news; }
    void OnAskedAhead(std::int64_t step, TimePoint /*now*/) override {
      asked_ahead.push_back(step);
    }
    void WriteStatus(TimePoint /*now*/) override { parts_.own.message().waiting_for = kWaitingFor; }

    std::optional<runtime::StepRing::Verdict> verdict;
    Duration wait = milliseconds(1000);
    int gos = 0;
    int news = 0;
    int heard = 0;
    int polls = 0;
    std::vector<std::int64_t> kept;
    std::vector<std::int64_t> asked_ahead;

   private:
    runtime::Parts& parts_;
  };

  FakeRole(runtime::Bus& bus, std::optional<std::int64_t> run_id)
      : node_(bus, Role::kDriver, run_id, *this) {}

  runtime::Node& node() override { return node_; }
  std::unique_ptr<runtime::FireRule> Join(const Scenario& /*scenario*/) override {
    ++joins;
    if (!join_error.empty()) throw std::runtime_error(join_error);
    auto made = std::make_unique<Rule>(node_.parts());
    rule = made.get();
    return made;
  }
  void Compute(std::int64_t step) override {
    if (!compute_error.empty()) throw std::runtime_error(compute_error);
    computed.push_back(step);
  }
  TimePoint Poll(TimePoint now) override {
    ++polls;
    return now + wait;
  }
  void BeforeStatus() override {
    if (before_status) before_status();
  }
  void OnLeave() override { ++leaves; }
  void OnStatusAsked(std::int64_t step) override { asked_status.push_back(step); }
  void OnAsked(std::string_view channel, runtime::StepRange steps, TimePoint /*now*/) override {
    asked.push_back(fmt::format("{} {} {}", channel, steps.first, steps.count));
  }

  Rule* rule = nullptr;  // null until the role has joined
  std::string join_error;
  std::string compute_error;
  std::function<void()> before_status;
  Duration wait = milliseconds(1000);
  int joins = 0;
  int leaves = 0;
  int polls = 0;
  std::vector<std::int64_t> computed;
  std::vector<std::int64_t> asked_status;
  std::vector<std::string> asked;

 private:
  runtime::Node node_;
};

/// The fake role alone on a bus in memory.
class FakeRoleInRun : public testing::Test {
 protected:
  /// The runner announces the run and says GO.
  void Join(std::int64_t progress = -1, double speed = 0) {
    script_.SayRun(run_t::GO, progress, speed);
  }

  Script script_;
  std::vector<resend_t>& requests_ = script_.Listen<resend_t>();
  std::vector<status_t>& status_ = script_.Listen<status_t>();
  FakeRole role_{script_.bus(), Script::kRunId};
  runtime::Parts& parts_ = role_.node().parts();
};

}  // namespace fogline::test
