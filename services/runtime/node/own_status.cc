#include "services/runtime/node/own_status.h"

#include <sodium.h>
#include <unistd.h>

#include <algorithm>

#include "common/process/this_process.h"
#include "services/runtime/node/fire_rule.h"
#include "services/runtime/wire/build_id.h"

namespace fogline::runtime {
namespace {

// The longest error text. OwnStatus::EncodeMessage() makes it shorter if the other fields are long.
constexpr std::size_t kMaxErrorBytes = 700;
// After a failed send, the next STATUS is sent when this time has passed since the last STATUS. The
// next STATUS does not wait until kHeartbeat has passed, because the run may end earlier.
constexpr Duration kTellSends = milliseconds(20);

}  // namespace

OwnStatus::OwnStatus(Bus& bus, Role role, const RunNews& run, Work& work,
                     const std::unique_ptr<FireRule>& rule)
    : bus_(bus), run_(run), work_(work), rule_(rule) {
  message_.role = NameOf(role);
  message_.host = HostName();
  message_.pid = getpid();
  randombytes_buf(&message_.instance, sizeof(message_.instance));
  message_.version = FOGLINE_VERSION;
  message_.build_id = OwnBuildId();
  message_.type_fingerprint = TypeFingerprint();
  message_.header.step = -1;
  message_.last_heard_step = -1;
}

void OwnStatus::SetState(std::int8_t state) {
  message_.state = state;
  Publish();
}

void OwnStatus::SetError(const std::string& error) {
  message_.error = error.substr(0, kMaxErrorBytes);
}

void OwnStatus::Fail(const std::string& error) {
  if (message_.state == status_t::FAILED) return;
  SetError(error);
  SetState(status_t::FAILED);
  left_ = true;
  work_.OnLeave();
}

void OwnStatus::Leave() {
  if (left_) return;
  left_ = true;
  work_.OnLeave();
  Publish();
}

void OwnStatus::Release(const std::string& why) {
  SetError(why);
  SetState(status_t::LEFT);
}

void OwnStatus::Publish() {
  const TimePoint now = Clock::now();
  said_at_ = now;
  due_ = now + kHeartbeat;
  if (!run_.id) return;
  work_.BeforeStatus();
  message_.header.run_id = *run_.id;
  message_.scenario_hash = run_.parts.hash();
  message_.waiting_for.clear();
  if (rule_) rule_->WriteStatus(now);
  ++message_.sequence;
  const Bus::Unverified unverified = bus_.TakeUnverified();
  message_.not_signed += unverified.not_signed;
  message_.badly_signed += unverified.badly_signed;
  if (now >= use_at_) {  // not in every STATUS: this call takes longer than some steps
    use_at_ = now + kHeartbeat;
    const ProcessUse use = MeasureThisProcess();
    message_.cpu_ms = use.cpu_ms;
    message_.rss_bytes = use.rss_bytes;
  }
  message_.sends_failed = bus_.failed_sends().count;
  message_.send_error = bus_.failed_sends().error;
  EncodeMessage();
  bus_.Publish(ChannelOf<status_t>().name, buffer_);
}

void OwnStatus::EncodeMessage() {
  Encode(message_, buffer_);
  if (buffer_.size() <= kMaxMessageBytes) return;
  const std::size_t excess = buffer_.size() - kMaxMessageBytes;
  message_.error.resize(message_.error.size() - std::min(excess, message_.error.size()));
  Encode(message_, buffer_);
}

TimePoint OwnStatus::Poll(TimePoint now) {
  if (now >= due_) Publish();
  return due_;
}

bool OwnStatus::HastensForFailedSends() {
  if (bus_.failed_sends().count == message_.sends_failed) return false;
  due_ = std::min(due_, said_at_ + kTellSends);
  return true;
}

}  // namespace fogline::runtime
