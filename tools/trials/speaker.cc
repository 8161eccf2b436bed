#include "tools/trials/speaker.h"

#include <chrono>
#include <exception>
#include <utility>

#include <fmt/core.h>

#include "common/clock.h"
#include "common/process/console.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/wire/trial.h"
#include "services/runtime/wire/wire.h"
#include "tools/trials/trial_log.h"

namespace fogline::trials {
namespace {

// A marker (a note of the experimenter) waits at most this long before it is sent. A person does
// not notice this time.
constexpr Duration kSendEvery = milliseconds(10);

}  // namespace

Speaker::Speaker(const std::string& url, std::int64_t run_id,
                 const runtime::TrafficOptions& traffic, trial_t base)
    : base_(std::move(base)), made_us_(UnixMicros()) {
  base_.header = {.run_id = run_id, .step = -1, .utime = 0};
  RequireReadable(base_);
  thread_ = std::thread([this, url, traffic] {
    try {
      Work(url, traffic);
    } catch (const std::exception& error) {
      Complain(
          fmt::format("fogline experiment: warning: the recorder hears no facts of the trial, "
                      "so they are added after the run: {}",
                      error.what()));
    }
  });
}

Speaker::~Speaker() { End(); }

void Speaker::Work(const std::string& url, const runtime::TrafficOptions& traffic) {
  const auto bus = runtime::OpenBus(url, traffic, Role::kRunner);
  bus->Subscribe(ChannelOf<truth_t>().name, [this](runtime::Arrival& arrival) {
    const auto* truth = arrival.As<truth_t>();
    if (truth == nullptr || truth->header.run_id != base_.header.run_id) return;
    const std::lock_guard lock(mutex_);
    step_ = truth->header.step;
    utime_ = truth->header.utime;
    Begin(UnixMicros());
  });
  std::vector<std::uint8_t> bytes;
  while (!over_) {
    bus->Wait(kSendEvery);
    const std::lock_guard lock(mutex_);
    if (step_ < 0) continue;  // before the first TRUTH, the recorder may not listen yet
    for (; sent_ < facts_.size(); ++sent_) {
      runtime::Encode(facts_[sent_], bytes);
      bus->Publish(ChannelOf<trial_t>().name, bytes);
    }
  }
}

void Speaker::Begin(std::int64_t unix_us) {
  if (!facts_.empty()) return;
  trial_t begin = base_;
  begin.kind = trial_t::BEGIN;
  begin.header.step = step_;
  begin.header.utime = utime_;
  begin.unix_us = unix_us;
  facts_.push_back(std::move(begin));
}

void Speaker::Mark(const std::string& text) {
  const std::lock_guard lock(mutex_);
  trial_t marker = base_;
  Begin(made_us_);
  marker.kind = trial_t::MARKER;
  marker.header.step = step_;
  marker.header.utime = utime_;
  marker.sequence = static_cast<std::int64_t>(facts_.size());
  marker.unix_us = UnixMicros();
  marker.text = runtime::CutForTrial(text);
  facts_.push_back(std::move(marker));
}

std::vector<trial_t> Speaker::End() {
  over_ = true;
  if (thread_.joinable()) thread_.join();
  const std::lock_guard lock(mutex_);
  Begin(made_us_);
  return facts_;
}

std::int64_t UnixMicros() {
  using std::chrono::microseconds;
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<microseconds>(now).count();
}

}  // namespace fogline::trials
