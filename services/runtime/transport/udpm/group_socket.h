// A UDP socket in the multicast group of a udpm:// network. It receives the packets of the network
// without LCM, and sends nothing.
#pragma once

#include <linux/filter.h>

#include <optional>
#include <string>
#include <vector>

namespace fogline::runtime {

class GroupSocket {
 public:
  /// Opens a socket that does not block.
  /// @pre the URL is a udpm:// URL (ParseMulticastUrl)
  /// @param filter attached before the first packet comes; empty: no filter
  /// @param buffer_bytes size of the receive buffer, without CAP_NET_ADMIN at most
  ///     net.core.rmem_max; nullopt: recv_buf_size of the URL, or kWideBuffer if the URL has none
  /// @throws std::system_error if the socket cannot receive the network's packets
  GroupSocket(const std::string& url, std::vector<sock_filter> filter,
              std::optional<int> buffer_bytes = std::nullopt);
  ~GroupSocket();
  GroupSocket(const GroupSocket&) = delete;
  GroupSocket& operator=(const GroupSocket&) = delete;

  int fd() const { return fd_; }
  /// Whether the kernel has accepted the filter.
  bool filtered() const { return filtered_; }

 private:
  void Open(const std::string& url, std::vector<sock_filter> filter,
            std::optional<int> buffer_bytes);

  int fd_;
  bool filtered_ = false;
};

}  // namespace fogline::runtime
