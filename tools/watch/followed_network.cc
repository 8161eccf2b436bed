#include "tools/watch/followed_network.h"

#include <algorithm>
#include <utility>

#include "services/runtime/transport/lcm_url.h"
#include "tools/watch/traffic_statistics.h"

namespace fogline::watch {
namespace {

// Interval at which the program checks whether another run should be followed. It is not shorter,
// because opening a network takes time.
constexpr Duration kFollowEvery = milliseconds(100);
// After this many unknown names a network is closed and opened again.
constexpr std::int64_t kMostNames = 10'000;
// Number of announced runs with unreachable networks that are remembered.
constexpr std::size_t kMaxUnreachable = 64;

}  // namespace

FollowedNetwork::FollowedNetwork(std::string url, bool follows, runtime::Bus::Watcher watcher)
    : url_(std::move(url)),
      watcher_([watch = std::move(watcher)](std::string_view channel, runtime::Bytes bytes) {
        if (!IsHousekeeping(channel)) watch(channel, bytes);
      }) {
  Open();
  if (follows) listener_.emplace(network_->bus.url());
}

FollowedNetwork::Network::Network(const std::string& url, const runtime::Bus::Watcher& watcher,
                                  Senders& senders)
    : bus(url), tap(PacketTap::Open(bus.url(), senders)) {
  bus.SubscribeAll(watcher);
}

void FollowedNetwork::Network::Drain(TimePoint now) {
  bus.Drain();
  // The tap comes second, so it has taken the packet of each message that the bus has handled.
  if (tap) tap->Drain(now);
}

void FollowedNetwork::Open() {
  network_.reset();
  network_.emplace(url_, watcher_, senders_);
  ++generation_;
}

void FollowedNetwork::ForgetNames(std::int64_t unknown) {
  if (unknown - names_ < kMostNames) return;
  names_ = unknown;
  CloseFollowed();  // Follow() opens it again
  Open();
}

void FollowedNetwork::Handle(TimePoint now) {
  network_->Drain(now);
  DrainFollowed(now);
  Follow(now);
}

void FollowedNetwork::Follow(TimePoint now) {
  if (!listener_ || now < follow_at_) return;
  follow_at_ = now + kFollowEvery;
  listener_->Look();
  runs_ = listener_->Runs();
  const auto newest = std::ranges::find_if(runs_, [this](const runtime::Announcement& run) {
    return std::ranges::find(unreachable_, run.run_id) == unreachable_.end();
  });
  if (newest == runs_.end()) return CloseFollowed();
  std::rotate(runs_.begin(), newest, newest + 1);
  const runtime::Announcement& run = runs_.front();
  if (followed_ && runtime::SameNetwork(followed_->bus.url(), run.url)) return;
  CloseFollowed();
  if (runtime::SameNetwork(network_->bus.url(), run.url)) return;
  try {
    followed_.emplace(run.url, watcher_, senders_);
    ++generation_;
  } catch (const std::exception&) {  // the address came from the network and may be invalid
    Leave(run.run_id);
  }
}

void FollowedNetwork::DrainFollowed(TimePoint now) {
  if (!followed_) return;
  try {
    followed_->Drain(now);
  } catch (const std::exception&) {  // its relay has ended
    Leave(runs_.front().run_id);
  }
}

void FollowedNetwork::CloseFollowed() {
  if (!followed_) return;
  followed_.reset();
  ++generation_;
}

void FollowedNetwork::Leave(std::int64_t run_id) {
  CloseFollowed();
  if (unreachable_.size() == kMaxUnreachable) unreachable_.clear();
  unreachable_.push_back(run_id);
}

}  // namespace fogline::watch
