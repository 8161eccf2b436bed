// Lets a Java program receive LCM traffic that stays on this machine (ttl=0):
//
//   LD_PRELOAD=.../libfogline_hear_loopback.so java ...
//
// Fogline sends this traffic over loopback (services/runtime/transport/lcm_sockets.h). On Linux the
// socket option IP_MULTICAST_ALL is on by default (see ip(7)). With this option a socket receives a
// multicast group on every interface where any process has joined the group. Java switches the
// option off for each of its sockets, and LCM's Java library cannot choose an interface. So this
// library ignores Java's call.
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

int setsockopt(int socket, int level, int name, const void* value, socklen_t size) {
  if (level == IPPROTO_IP && name == IP_MULTICAST_ALL) return 0;
  return (int)syscall(SYS_setsockopt, socket, level, name, value, size);
}
