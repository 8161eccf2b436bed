#include "services/recorder/run_log.h"

#include <algorithm>
#include <map>

#include <fmt/core.h>

#include "scenario/loader.h"
#include "services/runtime/scenario_parts.h"
#include "services/runtime/seal.h"

namespace fogline {
namespace {

constexpr std::size_t ChannelsPerStep() {
  std::size_t count = 0;
  for (const ChannelInfo& channel : kChannels) count += channel.pace == Pace::kStep ? 1 : 0;
  return count;
}

}  // namespace

/// Puts the events of a log together to steps.
class RunLogReader::Assembler {
 public:
  explicit Assembler(const std::filesystem::path& file) : file_(file), reader_(file) {}

  const StepMessages* Next() {
    while (!Ready()) {
      const auto event = reader_.Next();
      if (!event) {
        if (!finished_) Finish();
        return nullptr;
      }
      Take(*event);
    }
    current_ = pending_.begin()->second.messages;
    pending_.erase(pending_.begin());
    if (Decode(current_[IndexOf<truth_t>()], truth_)) last_ = truth_.last != 0;
    ++run_.steps;
    return &current_;
  }

  const RunLog& run() const { return run_; }

 private:
  struct Pending {
    StepMessages messages{};
    std::size_t count = 0;
  };

  /// The next step is complete.
  bool Ready() const {
    return !pending_.empty() && pending_.begin()->first == run_.steps &&
           pending_.begin()->second.count == ChannelsPerStep();
  }

  void Take(const Event& event) {
    const std::size_t channel = Find(event.channel);
    if (channel == kNumChannels || event.data.size() < kHeaderEnd) return;
    if (channel == IndexOf<run_t>()) return TakeRun(event.data);
    if (kChannels[channel].pace != Pace::kStep) return;
    const Bytes data = Payload(event.data);
    if (parts_.empty() || data.empty() || ReadInt64(data, kRunIdOffset) != run_.run_id) {
      ++foreign_;
      return;
    }
    const std::int64_t step = ReadInt64(data, kStepOffset);
    if (step < run_.steps) return;  // a repetition
    Pending& pending = pending_[step];
    if (!pending.messages[channel].empty()) {
      if (conflict_.empty() && !std::ranges::equal(pending.messages[channel], data)) {
        conflict_ = fmt::format("step {} has two different {}", step, event.channel);
      }
      return;
    }
    pending.messages[channel] = data;
    ++pending.count;
  }

  void Finish() {
    finished_ = true;
    if (!parts_.Complete()) {
      throw InputError(
          fmt::format("{}: error: the log has no complete scenario of a run", file_.string()));
    }
    if (!parts_.HashHolds()) {
      throw InputError(fmt::format("{}: error: the scenario in the log does not match its hash",
                                   file_.string()));
    }
    run_.scenario_text = parts_.Text();
    run_.scenario_hash = parts_.hash();
    run_.scenario = ParseScenario(run_.scenario_text, file_.string());
    run_.complete = last_ && pending_.empty() && conflict_.empty();
    run_.note = reader_.torn();
    const auto note = [this](const std::string& text) {
      run_.note += run_.note.empty() ? text : "; " + text;
    };
    if (!last_) note(fmt::format("ends after step {} of {}", run_.steps - 1, run_.scenario.steps));
    if (!pending_.empty()) {
      note(fmt::format("step {} lacks {}", run_.steps, Lacking(pending_.begin()->second.messages)));
    }
    if (!conflict_.empty()) note(conflict_);
    if (foreign_ > 0) note(fmt::format("{} messages of other runs ignored", foreign_));
  }

  std::size_t Find(std::string_view name) {
    // The recorder writes channels in the order of the table: the next one is the best guess.
    for (std::size_t i = 0; i < kNumChannels; ++i) {
      const std::size_t guess = (guess_ + i) % kNumChannels;
      if (kChannels[guess].name != name) continue;
      guess_ = guess + 1;
      return guess;
    }
    return kNumChannels;
  }

  void TakeRun(Bytes data) {
    run_t run{};
    const bool is_sealed = LooksSealed(data) && Decode(WithoutSeal(data), run);
    if (!is_sealed && !Decode(data, run)) return;
    if (parts_.empty()) {
      run_.run_id = run.header.run_id;
      sealed_ = is_sealed;
    }
    if (run.header.run_id == run_.run_id && !parts_.Add(run)) ++foreign_;
  }

  /// lcm-logger writes signed messages as they come, with their signatures. Nobody can verify them
  /// here, but what has none does not belong to a signed run: it is empty then.
  Bytes Payload(Bytes data) const {
    if (!sealed_) return data;
    return LooksSealed(data) && data.size() >= kHeaderEnd + kSealBytes ? WithoutSeal(data)
                                                                       : Bytes();
  }

  static std::string Lacking(const StepMessages& messages) {
    std::string names;
    for (std::size_t i = 0; i < kNumChannels; ++i) {
      if (kChannels[i].pace != Pace::kStep || !messages[i].empty()) continue;
      names += fmt::format("{}{}", names.empty() ? "" : ", ", kChannels[i].name);
    }
    return names;
  }

  std::filesystem::path file_;
  EventLogReader reader_;
  RunLog run_;
  ScenarioParts parts_;
  std::map<std::int64_t, Pending> pending_;
  StepMessages current_{};
  std::size_t guess_ = 0;
  std::int64_t foreign_ = 0;
  bool sealed_ = false;   // the run's messages are signed
  std::string conflict_;  // the first step that has two different messages of one channel
  truth_t truth_{};
  bool last_ = false;
  bool finished_ = false;
};

RunLogReader::RunLogReader(const std::filesystem::path& file)
    : assembler_(std::make_unique<Assembler>(file)) {}
RunLogReader::~RunLogReader() = default;
const StepMessages* RunLogReader::Next() { return assembler_->Next(); }
const RunLog& RunLogReader::run() const { return assembler_->run(); }

}  // namespace fogline
