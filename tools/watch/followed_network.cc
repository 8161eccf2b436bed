#include "tools/watch/followed_network.h"

#include <algorithm>
#include <utility>

#include "services/runtime/transport/lcm_url.h"
#include "tools/watch/traffic_statistics.h"

namespace fogline::watch {
namespace {

// Interval at which the program checks whether another run should be followed. A shorter interval
// would cost too much time, because opening a network takes time.
constexpr Duration kFollowEvery = milliseconds(100);
// LCM's library stores every channel name. So after this many messages on channels with unknown
// names, the program closes the network of the URL and opens it again, to forget the names.
constexpr std::int64_t kMostNames = 10'000;
// The program remembers at most this many announced runs whose networks are unreachable.
constexpr std::size_t kMaxUnreachable = 64;

}  // namespace

FollowedNetwork::FollowedNetwork(std::string url, Following following,
                                 runtime::Bus::Watcher watcher)
    : url_(std::move(url)),
      following_(following),
      watcher_([this, watch = std::move(watcher)](std::string_view channel, runtime::Bytes bytes) {
        if (channel == runtime::kWaitingChannel) waiting_.Hear(bytes, Clock::now());
        if (!IsHousekeeping(channel)) watch(channel, bytes);
      }) {
  Open();
  if (following_ != Following::kNothing) listener_.emplace(network_->bus.url());
  // Every run announces itself at least once in kBeaconEvery. So the program waits a little longer
  // than this before it looks for a run. It then knows all runs, and follows the newest one.
  if (following_ == Following::kFirstRun) {
    follow_at_ = Clock::now() + runtime::kBeaconEvery + kFollowEvery;
  }
}

FollowedNetwork::Network::Network(const std::string& url, const runtime::Bus::Watcher& watcher)
    : bus(url) {
  bus.SubscribeAll(watcher);
  replaced = bus.replaced();
}

bool FollowedNetwork::Network::Drain(TimePoint now) {
  bus.Drain();
  // The bus is read before the tap. So the tap takes the packets of all messages that the bus has
  // handled.
  if (tap) tap->Drain(now);
  return bus.replaced() != std::exchange(replaced, bus.replaced());
}

void FollowedNetwork::Open() {
  network_.reset();
  network_.emplace(url_, watcher_);
  network_->tap = Tap(network_->bus.url());
  ++generation_;
}

std::unique_ptr<PacketTap> FollowedNetwork::Tap(const std::string& url) {
  try {
    return PacketTap::Open(url, senders_);
  } catch (const std::runtime_error& error) {  // without a tap, losses are not counted
    tap_trouble_ = error.what();
    return nullptr;
  }
}

void FollowedNetwork::ForgetNames(std::int64_t unknown) {
  if (unknown - names_ < kMostNames) return;
  names_ = unknown;
  // Only LCM's library collects names. It may receive on the network of the URL, but not on the
  // network of a followed run: a run is announced only if LCM's library does not receive on its
  // network (runtime::MayBeAnnounced()).
  if (network_->bus.LcmReceives()) Open();
}

void FollowedNetwork::Handle(TimePoint now) {
  if (network_->Drain(now)) ++generation_;
  DrainFollowed(now);
  Follow(now);
}

void FollowedNetwork::Follow(TimePoint now) {
  if (!listener_ || now < follow_at_) return;
  follow_at_ = now + kFollowEvery;
  listener_->Look();
  runs_ = listener_->Runs();
  if (following_ == Following::kFirstRun && run_) {
    const auto own = std::ranges::find(runs_, run_->run_id, &runtime::Announcement::run_id);
    if (own != runs_.end()) {
      run_ = *own;
      runs_.erase(own);
    }
    runs_.insert(runs_.begin(), *run_);
    return;
  }
  const auto newest = std::ranges::find_if(runs_, [this](const runtime::Announcement& run) {
    return std::ranges::find(unreachable_, run.run_id) == unreachable_.end();
  });
  if (newest == runs_.end()) {
    run_.reset();
    return CloseFollowed();
  }
  std::rotate(runs_.begin(), newest, newest + 1);
  run_ = runs_.front();
  if (followed_ && runtime::SameNetwork(followed_->bus.url(), run_->url)) return;
  CloseFollowed();
  if (!runtime::SameNetwork(network_->bus.url(), run_->url)) OpenFollowed();
}

void FollowedNetwork::OpenFollowed() {
  try {
    followed_.emplace(run_->url, watcher_);
    followed_->tap = Tap(followed_->bus.url());
    ++generation_;
  } catch (const std::exception&) {  // the address came from the network and may be invalid
    Leave();
  }
}

void FollowedNetwork::DrainFollowed(TimePoint now) {
  if (!followed_ || followed_->lost) return;
  try {
    if (followed_->Drain(now)) ++generation_;
  } catch (const std::exception&) {  // the relay of this network has ended
    if (following_ == Following::kNewestRun) return Leave();
    followed_->lost = true;
    ++generation_;
  }
}

void FollowedNetwork::CloseFollowed() {
  if (!followed_) return;
  followed_.reset();
  ++generation_;
}

void FollowedNetwork::Leave() {
  CloseFollowed();
  if (unreachable_.size() == kMaxUnreachable) unreachable_.clear();
  unreachable_.push_back(run_->run_id);
  run_.reset();
}

}  // namespace fogline::watch
