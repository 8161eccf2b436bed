// A bad network for a process that is started with this library preloaded: datagrams that it sends are
// lost, sent twice, or held back behind the next one, by the chances in FOGLINE_TEST_NETWORK, in per
// cent: "LOSS,DUPLICATE,REORDER". LCM's self-test passes, or no process would begin.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

typedef ssize_t (*send_function)(int, const struct msghdr*, int);

enum { kMaxDatagram = 65536 };

static unsigned Chance(void) {
  // xorshift64 (Marsaglia 2003), another sequence in each process.
  static uint64_t state;
  if (state == 0) state = 0x9e3779b97f4a7c15ULL ^ ((uint64_t)getpid() << 20);
  state ^= state << 13;
  state ^= state >> 7;
  state ^= state << 17;
  return (unsigned)((state >> 20) % 100);
}

static size_t Flatten(const struct msghdr* message, char* bytes) {
  size_t size = 0;
  for (size_t i = 0; i < message->msg_iovlen; ++i) {
    const struct iovec* part = &message->msg_iov[i];
    if (size + part->iov_len > kMaxDatagram) return 0;
    memcpy(bytes + size, part->iov_base, part->iov_len);
    size += part->iov_len;
  }
  return size;
}

ssize_t sendmsg(int socket, const struct msghdr* message, int flags) {
  static send_function real;
  static unsigned loss, duplicate, reorder;
  static char held[kMaxDatagram];
  static size_t held_size;
  static char now[kMaxDatagram];
  if (real == NULL) {
    real = (send_function)dlsym(RTLD_NEXT, "sendmsg");
    const char* chances = getenv("FOGLINE_TEST_NETWORK");
    if (chances != NULL) sscanf(chances, "%u,%u,%u", &loss, &duplicate, &reorder);
  }
  const size_t size = Flatten(message, now);
  if (size == 0 || memmem(now, size, "LCM_SELF_TEST", 13) != NULL) return real(socket, message, flags);
  if (Chance() < loss) return (ssize_t)size;
  if (held_size == 0 && Chance() < reorder) {
    memcpy(held, now, size);
    held_size = size;
    return (ssize_t)size;
  }
  ssize_t sent = real(socket, message, flags);
  if (Chance() < duplicate) sent = real(socket, message, flags);
  if (held_size > 0) {
    struct iovec part = {.iov_base = held, .iov_len = held_size};
    struct msghdr late = *message;
    late.msg_iov = &part;
    late.msg_iovlen = 1;
    real(socket, &late, flags);
    held_size = 0;
  }
  return sent;
}
