// Takes packets out of a UDP socket in a separate thread, and stores them until the caller takes
// them. So no packet is lost while the caller is busy, or while the kernel does not run the caller.
// Without CAP_NET_ADMIN the kernel's own buffer may hold only a few hundred packets
// (net.core.rmem_max). The thread costs one more wake-up for each packet that the caller waits for.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <vector>

#include "services/runtime/wire/wire.h"

namespace fogline::runtime {

class Backlog {
 public:
  using Packet = std::vector<std::uint8_t>;

  /// @param socket a socket that does not block and that outlives this object
  /// @param most the largest packet, in bytes; longer packets are dropped
  /// @param wanted whether a packet is kept; called in the backlog's thread
  /// @param capacity in bytes; while the backlog is full, packets stay in the kernel's buffer
  /// @throws std::system_error if the kernel grants no thread or no descriptor
  Backlog(int socket, std::size_t most, bool (*wanted)(Bytes packet),
          std::size_t capacity = 64UL << 20);
  ~Backlog();
  Backlog(const Backlog&) = delete;
  Backlog& operator=(const Backlog&) = delete;

  /// Takes the oldest packet. @return the packet; nullopt if the backlog is empty
  std::optional<Packet> Take();
  /// This descriptor is readable while a packet is there.
  int fd() const { return ready_; }

 private:
  void Receive(const std::stop_token& stop);
  void Keep(Bytes packet);

  const int socket_;
  const std::size_t most_;
  bool (*const wanted_)(Bytes packet);
  const std::size_t capacity_;
  int ready_;  // an eventfd
  int end_;    // an eventfd that ends the thread's wait
  std::mutex mutex_;
  std::condition_variable_any room_;
  std::deque<Packet> packets_;
  std::size_t bytes_ = 0;  // size of packets_, with the cost of each packet
  std::jthread thread_;    // declared last, because the thread uses the other members
};

}  // namespace fogline::runtime
