// Lets a Java program hear LCM traffic that stays on this machine (ttl=0):
//
//   LD_PRELOAD=.../libfogline_hear_loopback.so java ...
//
// Fogline sends that traffic over loopback (services/runtime/transport/lcm_sockets.h). On Linux a socket hears a
// multicast group on every interface where any process has joined it, unless the socket has IP_MULTICAST_ALL
// switched off (see ip(7)). Java switches it off for each of its sockets, and LCM's Java library has no way
// to name an interface. So this library ignores Java's call.
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

int setsockopt(int socket, int level, int name, const void* value, socklen_t size) {
  if (level == IPPROTO_IP && name == IP_MULTICAST_ALL) return 0;
  return (int)syscall(SYS_setsockopt, socket, level, name, value, size);
}
