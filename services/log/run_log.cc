#include "services/log/run_log.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/core.h>

#include "common/text.h"
#include "scenario/io/loader.h"
#include "services/log/log_graph.h"
#include "services/log/step_order.h"
#include "services/runtime/wire/digest.h"
#include "services/runtime/wire/message_signer.h"
#include "services/runtime/wire/scenario_parts.h"

namespace fogline::log {
/// Combines the events of a log into steps.
class RunLogReader::Assembler {
 public:
  Assembler(const std::filesystem::path& file, Compared compared)
      : file_(file), reader_(file), compared_(compared) {}

  const StepMessages* Next() {
    if (over_) return nullptr;
    over_ = true;  // remains if an exception leaves this function
    const StepMessages* const step = ReadStep();
    over_ = step == nullptr;
    return step;
  }

  const RunLog& run() const { return run_; }

 private:
  // In real time, a message may come in the log after messages of later steps. The later steps are
  // at most this many steps ahead.
  static constexpr std::int64_t kLongestOverdue = 64;

  struct Pending {
    StepMessages messages{};
    runtime::ChannelSet there;
  };

  /// The next step; nullptr at the end of the log.
  const StepMessages* ReadStep() {
    while (!Ready()) {
      const auto event = reader_.Next();
      if (!event) {
        ended_ = true;
        if (Ready()) break;
        Finish();
        return nullptr;
      }
      Take(*event);
    }
    current_ = TakeStep();
    for (const runtime::Bytes message : current_) {
      if (!message.empty()) digest_.Add(message);
    }
    if (runtime::Decode(current_[IndexOf<truth_t>()], truth_)) last_ = truth_.last != 0;
    ++run_.steps;
    return &current_;
  }

  /// Whether the next step is complete, or (in real time) no further message of this step is
  /// expected.
  bool Ready() const {
    if (pending_.empty()) return false;
    const auto& [step, next] = *pending_.begin();
    if (step == run_.steps && next.there == run_.channels) return true;
    return realtime_ && (ended_ || pending_.rbegin()->first > run_.steps + kLongestOverdue);
  }

  /// The messages of the next step. In real time, the step may have no messages.
  StepMessages TakeStep() {
    const auto next = pending_.begin();
    StepMessages messages{};
    if (next->first == run_.steps) {
      messages = next->second.messages;
      pending_.erase(next);
    }
    if (realtime_) {
      runtime::ChannelSet there;
      for (std::size_t i = 0; i < kNumChannels; ++i) there[i] = !messages[i].empty();
      realtime_->AddStep(there | ~run_.channels);  // the log lacks no channel that it does not have
    }
    return messages;
  }

  void Take(const Event& event) {
    const std::size_t channel = Find(event.channel);
    if (channel == kNumChannels && IsLogSeal(event)) return TakeSeal(event);
    if (channel == kNumChannels && event.channel == kLogGraphChannel) return TakeGraph(event);
    if (channel == kNumChannels || event.data.size() < runtime::kHeaderEnd) return;
    if (channel == IndexOf<run_t>()) return TakeRun(event.data);
    if (channel == IndexOf<status_t>()) return TakeStatus(event.data);
    if (kChannels[channel].pace != Pace::kStep) return;
    if (!parts_.empty() && !run_.channels[channel]) return;
    const runtime::Bytes data = Payload(event.data);
    if (parts_.empty() || data.empty() ||
        runtime::ReadInt64(data, runtime::kRunIdOffset) != run_.run_id) {
      ++foreign_;
      return;
    }
    const std::int64_t step = runtime::ReadInt64(data, runtime::kStepOffset);
    if (step < run_.steps) return;  // a repeated message
    if (realtime_ && step >= steps_) return;
    Pending& pending = pending_[step];
    if (!pending.messages[channel].empty()) {
      if (conflict_.empty() && !std::ranges::equal(pending.messages[channel], data)) {
        conflict_ = fmt::format("step {} has two different {}", step, event.channel);
      }
      return;
    }
    pending.messages[channel] = data;
    pending.there.set(channel);
  }

  void Finish() {
    if (realtime_) run_.realtime = realtime_->Result();  // also if the log is refused below
    if (reader_.empty()) {
      throw InputError(fmt::format("{}: error: the log is empty: no run has begun to write it",
                                   PathText(file_)));
    }
    if (!parts_.Complete()) {
      throw InputError(
          fmt::format("{}: error: the log has no complete scenario of a run", PathText(file_)));
    }
    if (!parts_.HashHolds()) {
      throw InputError(fmt::format("{}: error: the scenario in the log does not match its hash",
                                   PathText(file_)));
    }
    run_.scenario_text = parts_.Text();
    run_.scenario_hash = parts_.hash();
    run_.scenario = ParseScenario(run_.scenario_text, file_.string());
    run_.digest = digest_.Hex();
    run_.events = reader_.head();
    const std::string alteration = Alteration();
    run_.altered = !alteration.empty();
    // In real time, the TRUTH message that has `last` may be missing.
    if (realtime_ && (run_.steps == steps_ || run_.steps == end_)) last_ = true;
    run_.ended =
        last_ && pending_.empty() && conflict_.empty() && reader_.torn().empty() && !run_.altered;
    const std::int64_t unlogged = run_.realtime ? run_.realtime->unlogged_messages : 0;
    run_.complete = run_.ended && unlogged == 0;
    run_.note = reader_.torn();
    const auto note = [this](const std::string& text) {
      run_.note += run_.note.empty() ? text : "; " + text;
    };
    if (run_.altered) note("altered: " + alteration);
    if (!last_) note(Shortage());
    if (run_.realtime && run_.realtime->missed_messages > 0) {
      note(fmt::format("real time, {} messages missing", run_.realtime->missed_messages));
      if (unlogged > 0) note(fmt::format("published, but not in the log: {}", unlogged));
    }
    if (!pending_.empty()) {
      note(fmt::format("step {} lacks {}", run_.steps, Lacking(pending_.begin()->second.messages)));
    }
    if (!conflict_.empty()) note(conflict_);
    if (foreign_ > 0) note(fmt::format("{} messages of other runs ignored", foreign_));
  }

  /// How the log differs from its seal; "" if it does not differ or has no seal.
  std::string Alteration() const {
    if (!run_.seal) return "";
    const LogSeal& seal = *run_.seal;
    if (!seal.whole) return "its seal was changed";
    if (seal.says.digest != run_.digest || seal.says.steps != run_.steps) {
      return fmt::format("the seal names digest {} of {} steps; the log has {} of {}",
                         EscapeControls(seal.says.digest), seal.says.steps, run_.digest,
                         run_.steps);
    }
    if (seal.says.scenario_hash != run_.scenario_hash) return "it was sealed with another scenario";
    if (compared_ == Compared::kRun && !run_.realtime) return "";
    return WhyNotSealedFile(seal, reader_);
  }

  std::string Shortage() const {
    if (run_.steps == 0) return fmt::format("no step of {} is complete", run_.scenario.steps);
    return fmt::format("ends after step {} of {}", run_.steps - 1, run_.scenario.steps);
  }

  std::size_t Find(std::string_view name) {
    // The recorder writes channels in the order of the table, so the channel after the last found
    // channel is the best guess.
    for (std::size_t i = 0; i < kNumChannels; ++i) {
      const std::size_t guess = (guess_ + i) % kNumChannels;
      if (kChannels[guess].name != name) continue;
      guess_ = guess + 1;
      return guess;
    }
    return kNumChannels;
  }

  void TakeRun(runtime::Bytes data) {
    run_t run{};
    const bool is_signed =
        runtime::LooksSigned(data) && runtime::Decode(runtime::WithoutSignature(data), run);
    if (!is_signed && !runtime::Decode(data, run)) return;
    if (parts_.empty()) {
      run_.run_id = run.header.run_id;
      run_.channels = StepChannelsOf(run.type_fingerprint);
      is_signed_ = is_signed;
    }
    if (run.header.run_id != run_.run_id) return;
    const bool known = parts_.Complete();
    if (!parts_.Add(run)) ++foreign_;
    if (!known && parts_.Complete() && run.realtime != 0) ExpectRealtime(run);
  }

  /// The recorder writes the graph before all steps. Signed traffic has no graph, because no
  /// process sends one.
  void TakeGraph(const Event& event) {
    if (parts_.empty() || is_signed_ || run_.steps > 0 || !pending_.empty()) return;
    try {
      const runtime::ChannelSet channels = ReadLogGraph(event, run_.run_id);
      if (channels.any()) run_.channels = channels;
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: error: {}", PathText(file_), error.what()));
    }
  }

  void TakeSeal(const Event& event) {
    LogHead before = reader_.head();
    before.bytes -= static_cast<std::int64_t>(SizeInFile(event));
    --before.events;
    LogSeal seal = ReadLogSeal(event, before);
    const bool others = seal.whole && seal.says.header.run_id != run_.run_id;
    if (others) ++foreign_;
    if (!others && !run_.seal) run_.seal = std::move(seal);
  }

  void ExpectRealtime(const run_t& run) {
    const Scenario scenario = ParseScenario(parts_.Text(), file_.string());
    steps_ = scenario.steps;
    // A message that came before the scenario can claim any step.
    pending_.erase(pending_.lower_bound(steps_), pending_.end());
    realtime_.emplace(run.pace, std::llround(scenario.step_s * 1e6), scenario.steps);
  }

  void TakeStatus(runtime::Bytes event) {
    const runtime::Bytes data = Payload(event);
    status_t status{};
    if (!realtime_ || !runtime::Decode(data, status) || status.header.run_id != run_.run_id) return;
    realtime_->Add(status);
    const bool is_done = status.role == NameOf(Role::kWorld) && status.state == status_t::DONE;
    if (is_done) end_ = status.header.step + 1;
  }

  /// The payload of a message. lcm-logger writes signed messages with their signatures. This reader
  /// cannot verify the signatures. In a signed run a message without a signature does not belong to
  /// the run, so its payload is empty here.
  runtime::Bytes Payload(runtime::Bytes data) const {
    if (!is_signed_) return data;
    return runtime::LooksSigned(data) &&
                   data.size() >= runtime::kHeaderEnd + runtime::kSignatureBytes
               ? runtime::WithoutSignature(data)
               : runtime::Bytes();
  }

  std::string Lacking(const StepMessages& messages) const {
    std::string names;
    for (std::size_t i = 0; i < kNumChannels; ++i) {
      if (!run_.channels[i] || !messages[i].empty()) continue;
      names += fmt::format("{}{}", names.empty() ? "" : ", ", kChannels[i].name);
    }
    return names;
  }

  std::filesystem::path file_;
  EventLogReader reader_;
  Compared compared_;
  runtime::Digest digest_;
  RunLog run_;
  runtime::ScenarioParts parts_;
  std::map<std::int64_t, Pending> pending_;
  StepMessages current_{};
  std::size_t guess_ = 0;
  std::int64_t foreign_ = 0;
  bool is_signed_ = false;  // whether the run's messages are signed
  std::string conflict_;    // names the first step with two different messages of one channel
  truth_t truth_{};
  bool last_ = false;
  bool over_ = false;   // no further step comes: the log has ended, or an error was thrown
  bool ended_ = false;  // the log has no further event
  std::optional<RealtimeAccumulator> realtime_;
  std::int64_t steps_ = 0;  // number of steps of the scenario, in real time
  std::int64_t end_ = -1;   // number of steps of a world that is done, in real time; -1: unknown
};

RunLogReader::RunLogReader(const std::filesystem::path& file, Compared compared)
    : assembler_(std::make_unique<Assembler>(file, compared)) {}
RunLogReader::~RunLogReader() = default;
const StepMessages* RunLogReader::Next() { return assembler_->Next(); }
const RunLog& RunLogReader::run() const { return assembler_->run(); }

}  // namespace fogline::log
