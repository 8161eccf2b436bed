#include "services/runtime/node.h"

#include <sodium.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "scenario/loader.h"
#include "services/runtime/this_process.h"

namespace fogline {
namespace {

// Being asked makes a node ask at once, but no more often than this.
constexpr Duration kMinBetweenAsks = milliseconds(1);
// A part of the scenario is asked for this often.
constexpr Duration kPartPatience = milliseconds(20);
// What went wrong must fit into a STATUS with everything else.
constexpr std::size_t kMaxErrorBytes = 700;
// The runner repeats itself five times a second; a role that hears nothing for so long is an
// orphan.
constexpr Duration kRunnerSilence = milliseconds(5000);

}  // namespace

Node::Node(Bus& bus, Role role, std::optional<std::int64_t> run_id)
    : bus_(bus), role_(role), run_id_(run_id), bound_(run_id.has_value()) {
  for (std::size_t i = 0; i < kChannels.size(); ++i) {
    const ChannelInfo& channel = kChannels[i];
    if (channel.pace != Pace::kStep) continue;
    if (channel.to.Has(role) || role == Role::kRecorder) {
      inputs_.push_back({.channel = i, .fingerprint = FingerprintOf(i), .ring = {}});
    }
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
  } else if (status_.state == status_t::WAITING && bound_) {
    if (now >= part_at_) {
      Ask(ChannelOf<run_t>().name, {.first = parts_.FirstMissing(), .count = 1});
      part_at_ = now + kPartPatience;
    }
    next = std::min(next, part_at_);
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

void Node::Fail(const std::string& error) {
  if (status_.state == status_t::FAILED) return;
  status_.error = error.substr(0, kMaxErrorBytes);
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
  const Input* missing = patience_.since() ? FirstMissing() : nullptr;
  if (missing != nullptr) {
    status_.waiting_for = kChannels[missing->channel].name;
    status_.last_heard_step = missing->ring.newest();
    status_.last_heard_ms = status_.last_heard_step < 0 ? 0 : Milliseconds(now - missing->heard);
    status_.waiting_ms = Milliseconds(now - *patience_.since());
  } else {
    status_.waiting_for.clear();
  }
  ++status_.sequence;
  const Bus::Unverified unverified = bus_.TakeUnverified();
  status_.not_signed += unverified.not_signed;
  status_.badly_signed += unverified.badly_signed;
  if (now >= use_at_) {  // asking the kernel costs more than some steps
    use_at_ = now + kHeartbeat;
    const ProcessUse use = MeasureThisProcess();
    status_.cpu_ms = use.cpu_ms;
    status_.rss_bytes = use.rss_bytes;
  }
  Encode(status_, buffer_);
  bus_.Publish(ChannelOf<status_t>().name, buffer_);
}

void Node::Ask(std::string_view channel, StepRange steps) {
  resend_t resend{};
  resend.header = {.run_id = *run_id_, .step = steps.first, .utime = 0};
  resend.channel = channel;
  resend.count = static_cast<std::int32_t>(steps.count);
  resend.requester = NameOf(role_);
  Encode(resend, buffer_);
  bus_.Publish(ChannelOf<resend_t>().name, buffer_);
}

void Node::Emit(std::size_t channel, std::int64_t step, Bytes bytes) {
  const std::string_view name = kChannels[channel].name;
  if (bytes.size() > kMaxMessageBytes) {
    throw std::runtime_error(fmt::format("step {}: {} takes {} bytes, at most {} fit", step, name,
                                         bytes.size(), kMaxMessageBytes));
  }
  for (Output& output : outputs_) {
    if (output.channel != channel) continue;
    output.ring.Store(step, bytes);
    // If it is so old that it is on disk, the recorder answers for it.
    if (step > progress_ - 2 * kMaxAhead) bus_.Publish(output.topic, bytes);
  }
}

void Node::Answer(std::string_view channel, Bytes bytes, TimePoint now) {
  if (!budget_.Take(now)) return;
  bus_.Publish(channel, bytes);
  ++status_.repairs_served;
}

void Node::OnRun(Bytes bytes) {
  if (left_) return;  // and everything is closed
  run_t run{};
  if (const RefusalCounter wrong = Examine(bytes, run)) return Refuse(wrong);
  if (bound_ ? run.header.run_id != *run_id_ : run.phase == run_t::STOP) {
    return Refuse(&status_t::foreign);
  }
  if (run.progress > kMaxStep) return Refuse(&status_t::out_of_window);
  run_id_ = run.header.run_id;
  bound_ = true;
  runner_heard_ = Clock::now();
  OnProgress(run.progress);
  if (run.phase == run_t::STOP) {
    Leave();
  } else if (status_.state == status_t::WAITING) {
    if (!parts_.Add(run)) return Refuse(&status_t::malformed);
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
    return Fail(fmt::format("cannot take part: {}", error.what()));
  }
  late_ = progress_;
  SetState(status_t::READY);
}

void Node::StartAt(std::int64_t step) {
  next_ = step;
  status_.header.step = step - 1;
}

void Node::OnProgress(std::int64_t progress) {
  progress_ = std::max(progress_, progress);
  Expect(progress_);
  if (progress_ > next_ + kMaxAhead) late_ = progress_;
}

void Node::OnInput(std::size_t index, Arrival& arrival) {
  if (!Running()) return;
  const Bytes bytes = arrival.bytes();
  Input& input = inputs_[index];
  if (bytes.size() < kHeaderEnd) return Refuse(&status_t::malformed);
  if (ReadInt64(bytes, 0) != input.fingerprint) return Refuse(&status_t::wrong_type);
  if (ReadInt64(bytes, kRunIdOffset) != *run_id_) return Refuse(&status_t::foreign);
  const std::int64_t step = ReadInt64(bytes, kStepOffset);
  const std::int64_t needed = std::max<std::int64_t>(0, next_ - lead_);
  if (step < 0) return Refuse(&status_t::out_of_window);
  switch (input.ring.Classify(step, bytes, needed)) {
    case StepRing::Verdict::kDuplicate:
      ++status_.duplicates;
      return;
    case StepRing::Verdict::kOutOfWindow:
      // Who catches up hears of steps that are under way elsewhere.
      if (!CatchingUp() || step > late_ + kRingSteps) Refuse(&status_t::out_of_window);
      return;
    case StepRing::Verdict::kConflict:
      if (const RefusalCounter wrong = Wrong(index, arrival)) return Refuse(wrong);
      Fail(fmt::format("step {}: {} came twice with different contents: is there a second {}?",
                       step, kChannels[input.channel].name, NameOf(kChannels[input.channel].from)));
      return;
    case StepRing::Verdict::kNew:
      break;
  }
  if (const RefusalCounter wrong = Accept(index, step, arrival)) return Refuse(wrong);
  input.ring.Store(step, bytes);
  input.heard = arrival.time();
  Expect(step + lead_);
  if (CatchingUp()) patience_.Arrived(arrival.time());
  Advance(arrival.time());
}

void Node::OnResend(Bytes bytes) {
  resend_t resend{};
  if (const RefusalCounter wrong = Examine(bytes, resend)) return Refuse(wrong);
  if (bound_ && resend.header.run_id != *run_id_) return Refuse(&status_t::foreign);
  const std::int64_t step = resend.header.step;
  if (step < 0 || step > kMaxStep) return Refuse(&status_t::out_of_window);
  if (!Running()) return;
  const TimePoint now = Clock::now();
  if (resend.channel == ChannelOf<status_t>().name) {
    if (budget_.Take(now)) OnStatusAsked(step, now);
    return;
  }
  const StepRange steps{.first = step,
                        .count = std::clamp<std::int64_t>(resend.count, 1, kRingSteps)};
  for (Output& output : outputs_) {
    if (kChannels[output.channel].name != resend.channel) continue;
    for (std::int64_t k = step; k < step + steps.count; ++k) {
      if (output.ring.Has(k)) Answer(resend.channel, output.ring.Get(k), now);
    }
    if (step >= next_) {
      ExpectAsked(step);
      // Who catches up has asked already.
      if (!CatchingUp() && now - patience_.asked() >= kMinBetweenAsks) AskForMissing(now);
    }
  }
  OnAsked(resend.channel, steps, now);
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
    patience_.Computed(now);
    if (status_.state == status_t::READY) SetState(status_t::RUNNING);
  }
}

TimePoint Node::Repair(TimePoint now) {
  if (expected_ < next_ || FirstMissing() == nullptr) return now + kHeartbeat;
  const TimePoint ask_at = patience_.Wait(now);
  if (CatchingUp() && next_ - lead_ > asked_) {  // nothing of it can be on its way
    AskForMissing(now);
    patience_.AskedForMany(now);
  } else if (now >= ask_at) {
    AskForMissing(now);
    patience_.AskedInVain(now);
  }
  return patience_.Wait(now);
}

void Node::AskForMissing(TimePoint now) {
  const std::int64_t needed = next_ - lead_;
  if (needed < 0) return;
  patience_.Asked(now);
  // As far as is known to be under way, and as the rings can hold.
  asked_ = std::clamp(expected_ - lead_, needed, needed + kRingSteps - 2);
  for (const Input& input : inputs_) {
    const StepRange steps = Lacking(input, needed, asked_);
    if (steps.count == 0) continue;
    Ask(kChannels[input.channel].name, steps);
    ++status_.repairs_asked;
  }
}

StepRange Node::Lacking(const Input& input, std::int64_t first, std::int64_t last) const {
  if (CatchingUp()) {  // old steps come only to those who ask
    while (first <= last && input.ring.Has(first)) ++first;
    while (first <= last && input.ring.Has(last)) --last;
    return {.first = first, .count = last - first + 1};
  }
  // What comes after a gap may be on its way.
  std::int64_t count = 0;
  while (first + count <= last && !input.ring.Has(first + count)) ++count;
  return {.first = first, .count = count};
}

}  // namespace fogline
