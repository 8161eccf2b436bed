#include "services/runtime/transport/kernel_limits.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace fogline::runtime {

void SetReceiveBuffer(int socket, int bytes) {
  if (setsockopt(socket, SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof(bytes)) == 0) return;
  setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof(bytes));
}

int ReceiveBuffer(int socket) {
  int bytes = 0;
  socklen_t size = sizeof(bytes);
  getsockopt(socket, SOL_SOCKET, SO_RCVBUF, &bytes, &size);
  return bytes / 2;  // the kernel doubles the size that was asked for (socket(7))
}

int LackOfDescriptors() {
  // LCM uses ten descriptors at most: sockets, pipes, and the descriptors of its self-test. So 16
  // free descriptors are enough.
  std::array<int, 16> descriptors{};
  int error = 0;
  for (int& descriptor : descriptors) {
    descriptor = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0);
    if (descriptor < 0) error = errno;
  }
  for (const int descriptor : descriptors) {
    if (descriptor >= 0) close(descriptor);
  }
  return error;
}

}  // namespace fogline::runtime
