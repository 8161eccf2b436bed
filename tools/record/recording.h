// Records the traffic of an LCM network in event logs. Publishes no messages itself.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <regex>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "common/clock.h"
#include "services/runtime/discovery/beacon.h"
#include "tools/record/log_files.h"
#include "tools/record/message_queue.h"
#include "tools/record/traffic_source.h"
#include "tools/watch/senders/senders.h"

namespace fogline::record {

struct RecordingOptions {
  std::string url;
  bool follows = false;  // also record the network of the newest announced run
  std::filesystem::path file;
  std::optional<std::regex> channels;  // record only channels whose whole name matches
  int buffer_bytes = 8 << 20;          // size of the socket's receive buffer
  Duration flush_every = milliseconds(100);
  Rotation rotation;
  Duration limit{};  // end after this time; 0: never
  /// Prints a line for the user.
  std::function<void(const std::string&)> say = [](const std::string&) {};
};

/// A recording. One thread receives messages, and another thread writes them. The queue between
/// them has no limit, so neither a burst nor a slow disk loses a message. Messages are lost only if
/// this process gets no processor time until the socket's buffer is full. These losses are counted.
class Recording {
 public:
  /// Begins the log and opens the network. @throws InputError, std::runtime_error
  explicit Recording(RecordingOptions options);
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  /// Records until a signal comes, the time limit is over, or an error occurs.
  void Run();

  /// Why the recording has ended early, such as a full disk; "" if it has not.
  const std::string& error() const { return error_; }
  /// The recording's results. Call it after Run().
  nlohmann::ordered_json Json();
  std::string Text();

 private:
  struct Counts {
    std::int64_t messages = 0;
    std::int64_t bytes = 0;
  };
  /// The number of channels that are counted separately. All further channels are counted together.
  static constexpr std::size_t kMostChannels = 1000;

  void Listen(TimePoint now, Duration longest);
  /// Takes the messages that have come on a network. @throws like TrafficSource::Drain()
  void Drain(TrafficSource& source, TimePoint now);
  void Take(const Message& message);
  bool Wanted(std::string_view channel);
  void Follow(TimePoint now);
  /// Closes the network of the followed run.
  void LeaveFollowed();
  /// The function of the thread that writes.
  void WriteAll();
  void WriteMessages();

  RecordingOptions options_;
  watch::Senders senders_;
  std::vector<std::unique_ptr<TrafficSource>> sources_;  // of the URL, then of the followed run
  std::string followed_url_;
  std::optional<runtime::BeaconListener> listener_;
  TimePoint follow_at_{};
  TimePoint began_;
  TimePoint ended_;
  std::unordered_map<std::string, bool> wanted_;  // whether a channel is recorded
  std::map<std::string, Counts, std::less<>> channels_;
  Counts all_;
  std::int64_t given_up_ = 0;
  MessageQueue queue_;
  LogFiles files_;
  std::atomic<bool> failed_ = false;  // whether the thread that writes has ended with an error
  std::string error_;                 // written by that thread before failed_ is set
  std::thread writer_;
};

}  // namespace fogline::record
