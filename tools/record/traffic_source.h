// Source of all messages on an LCM network, in the order of their arrival.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "common/clock.h"
#include "tools/record/message_assembler.h"
#include "tools/watch/senders/senders.h"

namespace fogline::record {

class TrafficSource {
 public:
  using Use = std::function<void(const Message&)>;

  /// Begins to listen.
  /// @param buffer_bytes size of the receive buffer to ask the kernel for
  /// @param senders counts the messages of a udpm network, by their numbers; it must outlive the
  ///     source
  /// @throws InputError, std::runtime_error if the network cannot be opened
  static std::unique_ptr<TrafficSource> Open(const std::string& url, int buffer_bytes,
                                             watch::Senders& senders);
  virtual ~TrafficSource() = default;
  TrafficSource(const TrafficSource&) = delete;
  TrafficSource& operator=(const TrafficSource&) = delete;

  /// Calls `use` with each message that has come. One call of Drain() handles at most some
  /// thousands of messages.
  /// @throws std::runtime_error if the network is lost
  virtual void Drain(TimePoint now, const Use& use) = 0;
  /// A line for the user if the connection to the network was cut off or came back since the last
  /// call; otherwise "".
  virtual std::string TakeNews() = 0;
  /// A descriptor that is readable when messages have come.
  virtual int fd() const = 0;
  /// The size of the receive buffer that the kernel grants; 0: unknown.
  virtual int buffer_bytes() const = 0;
  /// Whether the messages have numbers by which a loss can be found.
  virtual bool is_numbered() const = 0;
  /// Number of messages that were given up, because fragments were missing.
  virtual std::int64_t given_up() const = 0;

 protected:
  TrafficSource() = default;
};

}  // namespace fogline::record
