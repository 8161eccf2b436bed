#include "services/runtime/node.h"

#include <sodium.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <fstream>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "scenario/loader.h"

namespace fogline {
namespace {

// How long a node waits before it asks: a few times what a step usually takes, within bounds; twice
// as long each time that it asks in vain.
constexpr int kPatienceSteps = 4;
constexpr Duration kMinPatience = milliseconds(2);
constexpr Duration kMaxFirstPatience = milliseconds(50);
constexpr Duration kMaxPatience = milliseconds(50);
// Being asked makes a node ask at once, but no more often than this.
constexpr Duration kMinBetweenAsks = milliseconds(1);
// Weight of the newest step in the smoothed duration of a step.
constexpr int kSmoothing = 8;
// A part of the scenario is asked for this often.
constexpr Duration kPartPatience = milliseconds(20);
// The runner repeats itself once a second; a role that hears nothing for so long is an orphan.
constexpr Duration kRunnerSilence = milliseconds(5000);

struct ProcessUse {
  std::int64_t cpu_ms;
  std::int64_t rss_bytes;
};

ProcessUse UseOfThisProcess() {
  timespec cpu{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
  // The second number of statm is the resident set in pages (proc(5)).
  std::int64_t pages = 0;
  if (std::ifstream statm("/proc/self/statm"); statm) statm >> pages >> pages;
  return {.cpu_ms = cpu.tv_sec * 1000 + cpu.tv_nsec / 1'000'000,
          .rss_bytes = pages * sysconf(_SC_PAGESIZE)};
}

std::string HostName() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

}  // namespace

Node::Node(Bus& bus, Role role, std::optional<std::int64_t> run_id)
    : bus_(bus), role_(role), run_id_(run_id), bound_(run_id.has_value()) {
  for (std::size_t i = 0; i < kChannels.size(); ++i) {
    const ChannelInfo& channel = kChannels[i];
    if (channel.pace != Pace::kStep) continue;
    if (channel.to.Has(role) || role == Role::kRecorder) inputs_.push_back({.channel = i});
    if (channel.from == role) {
      outputs_.push_back({.channel = i, .topic = bus_.TopicOf(channel.name), .ring = {}});
    }
  }
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    bus_.Subscribe(kChannels[inputs_[i].channel].name,
                   [this, i](Arrival& arrival) { OnInput(i, arrival); });
  }
  bus_.Subscribe(ChannelOf<run_t>().name, [this](Bytes bytes) { OnRun(bytes); });
  bus_.Subscribe(ChannelOf<resend_t>().name, [this](Bytes bytes) { OnResend(bytes); });
  status_.role = NameOf(role);
  status_.host = HostName();
  status_.pid = getpid();
  randombytes_buf(&status_.instance, sizeof(status_.instance));
  status_.version = FOGLINE_VERSION;
  status_.type_fingerprint = TypeFingerprint();
  status_.header.step = -1;
  status_.last_heard_step = -1;
}

TimePoint Node::Poll(TimePoint now) {
  if (left_) return now + kHeartbeat;
  if (status_.state != status_t::WAITING && now - runner_heard_ > kRunnerSilence) {
    Fail(fmt::format("the runner has been silent for {} s", Milliseconds(kRunnerSilence) / 1000));
    return now + kHeartbeat;
  }
  TimePoint next = PollMore(now);
  if (Running()) {
    Advance(now);
    next = std::min(next, Repair(now));
  } else if (status_.state == status_t::WAITING && !parts_.empty()) {
    if (now >= ask_at_) {
      Ask(ChannelOf<run_t>().name, parts_.FirstMissing());
      ask_at_ = now + kPartPatience;
    }
    next = std::min(next, ask_at_);
  }
  if (now >= status_at_) PublishStatus();
  return std::min(next, status_at_);
}

void Node::Leave() {
  if (left_) return;
  left_ = true;
  OnLeave();
  PublishStatus();
}

void Node::Fail(std::string error) {
  if (status_.state == status_t::FAILED) return;
  status_.error = std::move(error);
  SetState(status_t::FAILED);
  left_ = true;
  OnLeave();
}

void Node::SetState(std::int8_t state) {
  status_.state = state;
  PublishStatus();
}

void Node::PublishStatus() {
  const TimePoint now = Clock::now();
  status_at_ = now + kHeartbeat;
  if (!bound_) return;  // nobody has announced a run yet
  BeforeStatus();
  status_.header.run_id = *run_id_;
  status_.scenario_hash = parts_.hash();
  const Input* missing = waiting_since_ ? FirstMissing() : nullptr;
  if (missing != nullptr) {
    status_.waiting_for = kChannels[missing->channel].name;
    status_.last_heard_step = missing->ring.newest();
    status_.last_heard_ms = status_.last_heard_step < 0 ? 0 : Milliseconds(now - missing->heard);
    status_.waiting_ms = Milliseconds(now - *waiting_since_);
  } else {
    status_.waiting_for.clear();
  }
  ++status_.sequence;
  if (now >= use_at_) {  // asking the kernel costs more than some steps
    use_at_ = now + kHeartbeat;
    const ProcessUse use = UseOfThisProcess();
    status_.cpu_ms = use.cpu_ms;
    status_.rss_bytes = use.rss_bytes;
  }
  Encode(status_, buffer_);
  bus_.Publish(ChannelOf<status_t>().name, buffer_);
}

void Node::Ask(std::string_view channel, std::int64_t step) {
  resend_t resend{};
  resend.header = {.run_id = *run_id_, .step = step, .utime = 0};
  resend.channel = channel;
  resend.count = 1;
  resend.requester = NameOf(role_);
  Encode(resend, buffer_);
  bus_.Publish(ChannelOf<resend_t>().name, buffer_);
}

void Node::Emit(std::size_t channel, std::int64_t step, Bytes bytes) {
  const std::string_view name = kChannels[channel].name;
  if (bytes.size() > kMaxStepMessageBytes) {
    throw std::runtime_error(fmt::format("step {}: {} takes {} bytes, at most {} fit", step, name,
                                         bytes.size(), kMaxStepMessageBytes));
  }
  for (Output& output : outputs_) {
    if (output.channel != channel) continue;
    output.ring.Store(step, bytes);
    bus_.Publish(output.topic, bytes);
  }
}

void Node::OnRun(Bytes bytes) {
  run_t run{};
  if (!Decode(bytes, run)) {
    ++status_.malformed;
    return;
  }
  if (bound_ ? run.header.run_id != *run_id_ : run.phase == run_t::STOP) {
    ++status_.foreign;
    return;
  }
  run_id_ = run.header.run_id;
  bound_ = true;
  runner_heard_ = Clock::now();
  if (run.phase == run_t::STOP) {
    Leave();
  } else if (status_.state == status_t::WAITING) {
    parts_.Add(run);
    if (parts_.Complete()) Join();
  } else if (run.phase == run_t::PREPARE && run.header.step == 0) {
    PublishStatus();  // the announcement repeats: somebody has not heard us yet
  }
  if (run.phase == run_t::GO && Running()) OnGo(run, Clock::now());
}

void Node::Join() {
  if (!parts_.HashHolds()) {
    return Fail("the scenario that arrived does not match its hash");
  }
  try {
    Configure(ParseScenario(parts_.Text()));
  } catch (const std::exception& error) {
    return Fail(fmt::format("cannot take the scenario: {}", error.what()));
  }
  SetState(status_t::READY);
}

void Node::OnInput(std::size_t index, Arrival& arrival) {
  if (!Running()) return;
  const Bytes bytes = arrival.bytes();
  if (bytes.size() < kHeaderEnd) {
    ++status_.malformed;
    return;
  }
  if (ReadInt64(bytes, kRunIdOffset) != *run_id_) {
    ++status_.foreign;
    return;
  }
  Input& input = inputs_[index];
  const std::int64_t step = ReadInt64(bytes, kStepOffset);
  const std::int64_t needed = std::max<std::int64_t>(0, next_ - lead_);
  if (step < 0) {
    ++status_.out_of_window;
    return;
  }
  switch (input.ring.Classify(step, bytes, needed)) {
    case StepRing::Verdict::kDuplicate:
      ++status_.duplicates;
      return;
    case StepRing::Verdict::kOutOfWindow:
      ++status_.out_of_window;
      return;
    case StepRing::Verdict::kConflict:
      Fail(fmt::format("step {}: {} came twice with different contents: is there a second {}?",
                       step, kChannels[input.channel].name, NameOf(kChannels[input.channel].from)));
      return;
    case StepRing::Verdict::kNew:
      break;
  }
  if (!Accept(index, step, arrival)) {
    ++status_.malformed;
    return;
  }
  input.ring.Store(step, bytes);
  input.heard = arrival.time();
  Expect(step + lead_);
  Advance(arrival.time());
}

void Node::OnResend(Bytes bytes) {
  resend_t resend{};
  if (!Decode(bytes, resend)) {
    ++status_.malformed;
    return;
  }
  if (bound_ && resend.header.run_id != *run_id_) {
    ++status_.foreign;
    return;
  }
  if (!Running()) return;
  const TimePoint now = Clock::now();
  const std::int64_t step = resend.header.step;
  if (resend.channel == ChannelOf<status_t>().name) return OnStatusAsked(step, now);
  for (Output& output : outputs_) {
    if (kChannels[output.channel].name != resend.channel || step < 0) continue;
    if (output.ring.Has(step)) {
      bus_.Publish(output.topic, output.ring.Get(step));
      ++status_.repairs_served;
    } else if (step >= next_) {
      Expect(step);
      if (now - asked_ >= kMinBetweenAsks) AskForMissing(now);
    }
  }
}

bool Node::InputsReady(std::int64_t step) const {
  return step < 0 ||
         std::ranges::all_of(inputs_, [step](const Input& input) { return input.ring.Has(step); });
}

const Node::Input* Node::FirstMissing() const {
  const std::int64_t needed = next_ - lead_;
  if (needed < 0) return nullptr;
  for (const Input& input : inputs_) {
    if (!input.ring.Has(needed)) return &input;
  }
  return nullptr;
}

void Node::Advance(TimePoint now) {
  while (Running() && InputsReady(next_ - lead_) && MayCompute(next_, now)) {
    try {
      Compute(next_);
    } catch (const std::exception& error) {
      return Fail(error.what());
    }
    status_.header.step = next_;
    ++next_;
    // Steps that had to be repaired say nothing of how long a step takes (Karn & Partridge 1987).
    if (computed_at_ != TimePoint{} && asked_ < computed_at_) {
      step_time_ += ((now - computed_at_) - step_time_) / kSmoothing;
    }
    computed_at_ = now;
    waiting_since_.reset();
    if (status_.state == status_t::READY) SetState(status_t::RUNNING);
  }
}

TimePoint Node::Repair(TimePoint now) {
  if (expected_ < next_ || FirstMissing() == nullptr) return now + kHeartbeat;
  if (!waiting_since_) {
    waiting_since_ = now;
    patience_ = std::clamp(kPatienceSteps * step_time_, kMinPatience, kMaxFirstPatience);
    ask_at_ = now + patience_;
  }
  if (now >= ask_at_) {
    AskForMissing(now);
    patience_ = std::min(2 * patience_, kMaxPatience);
    ask_at_ = now + patience_;
  }
  return ask_at_;
}

void Node::AskForMissing(TimePoint now) {
  const std::int64_t needed = next_ - lead_;
  if (needed < 0) return;
  asked_ = now;
  for (const Input& input : inputs_) {
    if (input.ring.Has(needed)) continue;
    Ask(kChannels[input.channel].name, needed);
    ++status_.repairs_asked;
  }
}

}  // namespace fogline
