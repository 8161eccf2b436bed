#include "services/runtime/transport/udpm/backlog.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "common/process/signals_blocked.h"

namespace fogline::runtime {
namespace {

// Memory that a packet needs in addition to its bytes: the vector and its block on the heap.
constexpr std::size_t kPacketCost = 64;

void Raise(int event) {
  const std::uint64_t one = 1;
  // The counter is 0 or 1, so it cannot overflow.
  [[maybe_unused]] const ssize_t written = write(event, &one, sizeof(one));
}

void Lower(int event) {
  std::uint64_t count = 0;
  [[maybe_unused]] const ssize_t read_bytes = read(event, &count, sizeof(count));
}

}  // namespace

Backlog::Backlog(int socket, std::size_t most, bool (*wanted)(Bytes packet), std::size_t capacity)
    : socket_(socket),
      most_(most),
      wanted_(wanted),
      capacity_(capacity),
      ready_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      end_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  try {
    if (ready_ < 0 || end_ < 0) throw std::system_error(errno, std::generic_category());
    const SignalsBlocked blocked;  // signals are for the thread of the caller
    thread_ = std::jthread([this](const std::stop_token& stop) { Receive(stop); });
  } catch (...) {
    close(ready_);
    close(end_);
    throw;
  }
}

Backlog::~Backlog() {
  thread_.request_stop();
  Raise(end_);
  thread_.join();
  close(ready_);
  close(end_);
}

std::optional<Backlog::Packet> Backlog::Take() {
  const std::scoped_lock lock(mutex_);
  if (packets_.empty()) return std::nullopt;
  Packet packet = std::move(packets_.front());
  packets_.pop_front();
  bytes_ -= packet.size() + kPacketCost;
  if (packets_.empty()) Lower(ready_);
  room_.notify_one();
  return packet;
}

void Backlog::Receive(const std::stop_token& stop) {
  Packet buffer(most_);
  while (!stop.stop_requested()) {
    // With MSG_TRUNC, recv() returns the size of the whole packet, even if the buffer is too small.
    const ssize_t size = recv(socket_, buffer.data(), buffer.size(), MSG_TRUNC);
    if (size >= 0) {
      const auto bytes = static_cast<std::size_t>(size);
      const Bytes packet(buffer.data(), std::min(bytes, most_));
      if (bytes <= most_ && wanted_(packet)) Keep(packet);
      std::unique_lock lock(mutex_);
      room_.wait(lock, stop, [this] { return bytes_ < capacity_; });
      continue;
    }
    // There is no packet, or recv() has reported an error of the network. recv() reports such an
    // error only once, so the next call can succeed.
    std::array<pollfd, 2> waited{pollfd{.fd = socket_, .events = POLLIN, .revents = 0},
                                 pollfd{.fd = end_, .events = POLLIN, .revents = 0}};
    poll(waited.data(), waited.size(), -1);
  }
}

void Backlog::Keep(Bytes packet) {
  const std::scoped_lock lock(mutex_);
  packets_.emplace_back(packet.begin(), packet.end());
  bytes_ += packet.size() + kPacketCost;
  if (packets_.size() == 1) Raise(ready_);
}

}  // namespace fogline::runtime
