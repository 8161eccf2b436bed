// Recording in real time: the world does not wait for the recorder. Steps are written in order as
// soon as they are complete; what is missing is asked for as long as its producer can still have
// it, and a step that stays incomplete is written as it is. That a step is under way of which
// nothing has come is known from the runner. Each STATUS goes into the log as well,
// behind the step in which it came: how the roles were is part of what happened.
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <vector>

#include "services/runtime/realtime_rule.h"

namespace fogline {

class RecordRule final : public RealtimeRule {
 public:
  RecordRule(Node& node, const Scenario& scenario, double speed, std::int64_t run_id);

  StepRing::Verdict Classify(std::size_t input, std::int64_t step, Bytes bytes) override;
  void OnInput(std::size_t input, std::int64_t step, TimePoint time) override;
  void OnProgress() override;
  /// Late is only what the log does not have: `unlogged_messages` is counted with that.
  void WriteStatus(TimePoint now) override;

  /// Hands out what came in this step or before, once.
  void TakeStatus(std::int64_t step, const std::function<void(Bytes)>& use);

 private:
  /// What is known of a step that is not written yet.
  struct Open {
    std::int64_t step = -1;
    TimePoint seen{};  // its first message
    int asked = 0;
    TimePoint asked_at{};
  };
  struct Heard {
    std::int64_t step;  // under way when it came
    std::vector<std::uint8_t> bytes;
  };

  /// Messages of an input that came when their step was written, each counted once.
  struct Refused {
    std::int64_t count = 0;
    std::array<std::int64_t, kRingSteps> steps{};  // plus one: those that were counted last
  };

  TimePoint Fire(TimePoint now) override;
  /// Steps up to this one are under way: those of which nothing has come are late from now on.
  void OpenUpTo(std::int64_t step, TimePoint now);
  Open& OpenAt(std::int64_t step, TimePoint now);
  bool Complete(std::int64_t step) const;
  /// Nothing more will come.
  bool GivenUp(std::int64_t step, TimePoint now);
  void AskForHoles(TimePoint now);
  void ListenToStatus();

  std::int64_t run_id_;
  std::array<Open, kRingSteps> open_{};
  std::array<Refused, kNumChannels> refused_{};  // by input
  std::deque<Heard> heard_;
  TimePoint ask_at_{};
  bool listening_ = false;
};

}  // namespace fogline
