#include "services/recorder/recorder.h"

#include <fmt/core.h>

namespace fogline {
namespace {

// Steps between two acknowledgements; a few of them fit into the world's kMaxAhead.
constexpr std::int64_t kAcknowledgeEvery = kMaxAhead / 4;

}  // namespace

Recorder::Recorder(Bus& bus, std::optional<std::int64_t> run_id, const std::filesystem::path& file)
    : Node(bus, Role::kRecorder, run_id) {
  log_.emplace(file);
}

void Recorder::Configure(const Scenario& /*scenario*/) {
  std::vector<std::uint8_t> buffer;
  for (std::size_t i = 0; i < parts().parts().size(); ++i) {
    const run_t run = MakeRunPart(run_id(), run_t::PREPARE, 0, parts().hash(), parts().parts(), i);
    Encode(run, buffer);
    log_->Write(ChannelOf<run_t>().name, 0, buffer);
  }
  log_->Flush();
}

bool Recorder::Accept(std::size_t input, std::int64_t step, Arrival& arrival) {
  bool sound = false;
  ForEachStepChannel([&]<class M>(std::size_t channel) {
    if (channel != inputs()[input].channel) return;
    const M* message = arrival.As<M>();
    sound = message != nullptr;
    if constexpr (std::is_same_v<M, truth_t>) {
      if (sound && message->last) final_ = step;
    }
  });
  return sound;
}

void Recorder::Write(std::int64_t step) {
  for (const Input& input : inputs()) {
    if (!input.ring.Has(step)) continue;
    const Bytes bytes = input.ring.Get(step);
    constexpr std::size_t kTimeOffset = kStepOffset + 8;
    log_->Write(kChannels[input.channel].name, ReadInt64(bytes, kTimeOffset), bytes);
  }
}

void Recorder::Compute(std::int64_t step) {
  Write(step);
  const bool last = step == final_;
  if (last || (step + 1) % kAcknowledgeEvery == 0) {
    status().header.step = step;
    PublishStatus();
  }
}

void Recorder::OnStatusAsked(std::int64_t step, TimePoint /*now*/) {
  Expect(step);
  if (next() > step) PublishStatus();
}

void Recorder::BeforeStatus() {
  // STATUS acknowledges every step up to its own: they must be out of this process by then.
  if (log_) log_->Flush();
}

void Recorder::OnLeave() {
  // A run that ends before its last step leaves incomplete steps; what is there is kept.
  if (!log_) return;
  std::int64_t newest = -1;
  for (const Input& input : inputs()) newest = std::max(newest, input.ring.newest());
  for (std::int64_t step = next(); step <= newest; ++step) Write(step);
  log_.reset();
}

}  // namespace fogline
