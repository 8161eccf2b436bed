// Sends datagrams to a multicast group: noise, and datagrams that resemble the messages of a run.
// No process should accept these datagrams. The program uses the genuine messages of the run as
// templates. It never sends a false message that has the right type, run and step and finite
// values, because only a signature could distinguish such a message from a genuine one.
#include <arpa/inet.h>
#include <linux/filter.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <iterator>
#include <limits>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "services/runtime/wire/wire.h"

namespace fogline::test {
namespace {

using SteadyClock = std::chrono::steady_clock;
using Buffer = std::vector<std::uint8_t>;

// The first bytes of LCM's datagrams: whole messages, and fragments of messages (lcm/udp_util.h).
constexpr std::string_view kWholeMagic = "LC02";
constexpr std::string_view kFragmentMagic = "LC03";
constexpr std::size_t kWholeHeader = 8;
// Upper limit of the size of random data, bytes: with this size, a datagram fits into one Ethernet
// frame.
constexpr std::size_t kFrame = 1400;
// The payload of the largest UDP datagram over IPv4, bytes.
constexpr std::size_t kMaxDatagram = 65507;

volatile std::sig_atomic_t stopped = 0;

void Append(Buffer& to, std::string_view text) { to.insert(to.end(), text.begin(), text.end()); }
void Append(Buffer& to, runtime::Bytes bytes) { to.insert(to.end(), bytes.begin(), bytes.end()); }
template <class Integer>
void AppendBigEndian(Buffer& to, Integer value) {
  for (int shift = 8 * (static_cast<int>(sizeof(value)) - 1); shift >= 0; shift -= 8) {
    to.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> shift));
  }
}
void WriteInt64(Buffer& to, std::size_t offset, std::int64_t value) {
  Buffer bytes;
  AppendBigEndian(bytes, value);
  std::ranges::copy(bytes, to.begin() + static_cast<std::ptrdiff_t>(offset));
}

/// The multicast group. An object sends to the group and receives the datagrams of other processes.
class Group {
 public:
  Group(const std::string& address, int port, int ttl)
      : out_(socket(AF_INET, SOCK_DGRAM, 0)), in_(socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    sockaddr_in group{};
    group.sin_family = AF_INET;
    group.sin_port = htons(static_cast<std::uint16_t>(port));
    inet_pton(AF_INET, address.c_str(), &group.sin_addr);
    const auto* there = reinterpret_cast<const sockaddr*>(&group);
    Set(out_, IPPROTO_IP, IP_MULTICAST_TTL, ttl);
    Check(connect(out_, there, sizeof(group)), "connect");
    Set(in_, SOL_SOCKET, SO_REUSEADDR, 1);
    Check(bind(in_, there, sizeof(group)), "bind");
    Set(in_, IPPROTO_IP, IP_ADD_MEMBERSHIP,
        ip_mreq{.imr_multiaddr = group.sin_addr, .imr_interface = {INADDR_ANY}});
    IgnoreOwn();
  }
  ~Group() {
    close(out_);
    close(in_);
  }
  Group(const Group&) = delete;
  Group& operator=(const Group&) = delete;

  bool Send(runtime::Bytes bytes) const { return send(out_, bytes.data(), bytes.size(), 0) >= 0; }
  /// Takes a datagram of another process. @return its bytes; empty if no datagram has come
  runtime::Bytes Receive() {
    const ssize_t size = recv(in_, heard_.data(), heard_.size(), 0);
    return {heard_.data(), static_cast<std::size_t>(std::max<ssize_t>(0, size))};
  }

 private:
  static void Check(int result, const char* what) {
    if (result != 0) throw std::system_error(errno, std::generic_category(), what);
  }
  template <class Value>
  static void Set(int fd, int level, int option, const Value& value) {
    Check(setsockopt(fd, level, option, &value, sizeof(value)), "setsockopt");
  }
  /// Makes the kernel drop the datagrams that this process itself sends. The socket filter gets a
  /// datagram without its IP header: the first bytes are the UDP header, which begins with the
  /// sender's port.
  void IgnoreOwn() const {
    sockaddr_in own{};
    socklen_t size = sizeof(own);
    Check(getsockname(out_, reinterpret_cast<sockaddr*>(&own), &size), "getsockname");
    std::array<sock_filter, 4> program{
        {BPF_STMT(BPF_LD | BPF_H | BPF_ABS, 0),
         BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, ntohs(own.sin_port), 0, 1),
         BPF_STMT(BPF_RET | BPF_K, 0), BPF_STMT(BPF_RET | BPF_K, 0xffffffff)}};
    Set(in_, SOL_SOCKET, SO_ATTACH_FILTER,
        sock_fprog{.len = program.size(), .filter = program.data()});
  }

  int out_;
  int in_;
  std::array<std::uint8_t, kMaxDatagram> heard_{};
};

/// Replaces one number of a genuine message of type M by `value`, which is infinite or NaN. Adds
/// `later` to the step of the message. @return false if `genuine` is of another type or has no
/// numbers
template <class M>
bool Poison(runtime::Bytes genuine, double value, std::uint64_t which, std::int64_t later,
            Buffer& payload) {
  M message{};
  if (!runtime::Decode(genuine, message)) return false;
  std::vector<double*> numbers;
  VisitFields(message, [&numbers](std::string_view, const auto& field) {
    using V = std::decay_t<decltype(field)>;
    if constexpr (std::is_same_v<V, double>) {
      numbers.push_back(const_cast<double*>(&field));
    } else if constexpr (std::is_same_v<V, std::span<const double>>) {
      for (const double& element : field) numbers.push_back(const_cast<double*>(&element));
    }
  });
  if (numbers.empty()) return false;
  *numbers[which % numbers.size()] = value;
  message.header.step += later;
  runtime::Encode(message, payload);
  return true;
}

/// Makes datagrams of every kind in turn, or of one kind.
class Attacker {
 public:
  Attacker(std::uint64_t seed, const std::string& only);

  /// Remembers a genuine message as a template.
  void Learn(runtime::Bytes datagram) {
    const std::string_view text(reinterpret_cast<const char*>(datagram.data()), datagram.size());
    const std::size_t end = text.find('\0', kWholeHeader);
    if (!text.starts_with(kWholeMagic) || end == std::string_view::npos) return;
    const runtime::Bytes payload = datagram.subspan(end + 1);
    if (payload.size() < runtime::kHeaderEnd) return;
    const std::string_view channel = text.substr(kWholeHeader, end - kWholeHeader);
    const auto is_channel = [channel](const auto& one) { return one.name == channel; };
    // Only messages on the channels of a run become templates. A changed announcement of a run
    // could still be a valid message, and this program must not send valid messages.
    if (std::ranges::none_of(kChannels, is_channel)) return;
    genuine_[std::string(channel)] = {payload.begin(), payload.end()};
  }

  /// The next datagram. Valid until the next call.
  const Buffer& Next() {
    const Kind& kind = kinds_[next_++ % kinds_.size()];
    datagram_.clear();
    payload_.clear();
    if (kind.needs_genuine && !genuine_.empty()) {
      const auto index = static_cast<std::ptrdiff_t>(Below(genuine_.size()));
      const auto& [channel, payload] = *std::next(genuine_.begin(), index);
      channel_ = channel;
      payload_ = payload;
    } else {
      channel_ = kChannels[Below(kChannels.size())].name;
    }
    if (kind.needs_genuine && payload_.empty()) {
      Noise();
    } else {
      (this->*kind.make)();
      ++made_[kind.name];
    }
    return datagram_;
  }

  const std::map<std::string_view, std::int64_t>& made() const { return made_; }

 private:
  struct Kind {
    std::string_view name;
    bool needs_genuine;  // make() needs a genuine message in payload_
    void (Attacker::*make)();
  };
  static const std::vector<Kind> kKinds;

  std::uint64_t Below(std::uint64_t limit) { return random_() % limit; }
  template <class T, std::size_t n>
  T OneOf(const std::array<T, n>& values) {
    return values[Below(n)];
  }
  void AppendNoise(Buffer& to, std::uint64_t size) {
    for (std::uint64_t i = 0; i < size; ++i) to.push_back(static_cast<std::uint8_t>(random_()));
  }
  void Wrap() {
    Append(datagram_, kWholeMagic);
    AppendBigEndian(datagram_, static_cast<std::uint32_t>(next_));
    Append(datagram_, channel_);
    datagram_.push_back(0);
    Append(datagram_, payload_);
  }

  void Noise() {
    // Half of the noise looks like a datagram of LCM whose channel name is too long or has no final
    // zero.
    if (Below(2) == 0) Append(datagram_, OneOf(std::array{kWholeMagic, kFragmentMagic}));
    AppendNoise(datagram_, Below(kFrame));
  }
  void NoiseOnAChannel() {
    payload_.clear();
    AppendNoise(payload_, Below(kFrame));
    Wrap();
  }
  void NotFinite() {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const double value =
        OneOf(std::array{kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN()});
    // The message is of the current step or of the next step.
    const auto later = static_cast<std::int64_t>(Below(2));
    const Buffer genuine = payload_;
    const std::uint64_t which = random_();
    bool made = false;
    ForEachStepChannel([&]<class M>(std::size_t index) {
      if (kChannels[index].name != channel_) return;
      made = Poison<M>(genuine, value, which, later, payload_);
    });
    if (channel_ == ChannelOf<run_t>().name) {
      made = Poison<run_t>(genuine, value, which, 0, payload_);
    }
    made ? Wrap() : Noise();
  }
  void WrongStep() {
    // In STATUS the step is the sender's newest step, and in RESEND it is the requested step. So no
    // step is wrong in these two channels. Then the datagram is noise: it has random bytes.
    if (channel_ == ChannelOf<status_t>().name || channel_ == ChannelOf<resend_t>().name) {
      return Noise();
    }
    const std::int64_t step = runtime::ReadInt64(payload_, runtime::kStepOffset);
    constexpr std::int64_t kFar = 1000;
    using Limits = std::numeric_limits<std::int64_t>;
    WriteInt64(payload_, runtime::kStepOffset,
               OneOf(std::array{std::int64_t{-1}, -step - 1, step + kFar,
                                step + (std::int64_t{1} << 32), Limits::min(), Limits::max()}));
    Wrap();
  }
  void ForeignRun() {
    WriteInt64(payload_, runtime::kRunIdOffset, static_cast<std::int64_t>(random_()));
    Wrap();
  }
  void WrongType() {
    payload_[Below(runtime::kRunIdOffset)] ^= static_cast<std::uint8_t>(1 + Below(255));
    Wrap();
  }
  void Truncated() {
    payload_.resize(Below(payload_.size()));
    Wrap();
  }
  void Oversized() {
    AppendNoise(payload_, Below(8) == 0 ? 60'000 : 1 + Below(100));
    Wrap();
  }
  void Fragment() {
    // The sizes and the offsets of the fragments contradict each other: some fragments lie beyond
    // the end of the message, or beyond 2^32.
    constexpr std::array<std::uint32_t, 7> kAbsurd{0,          1,          1000,      0x7fffffff,
                                                   0x80000000, 0xfffffc00, 0xffffffff};
    constexpr std::array<std::uint16_t, 5> kNumbers{0, 1, 2, 0x7fff, 0xffff};
    Append(datagram_, kFragmentMagic);
    AppendBigEndian(datagram_, static_cast<std::uint32_t>(Below(4)));  // number of the message
    AppendBigEndian(datagram_, OneOf(kAbsurd));                        // size of the message
    AppendBigEndian(datagram_, OneOf(kAbsurd));                        // offset of this fragment
    AppendBigEndian(datagram_, OneOf(kNumbers));                       // number of this fragment
    AppendBigEndian(datagram_, OneOf(kNumbers));                       // count of fragments
    Append(datagram_, channel_);
    datagram_.push_back(0);
    AppendNoise(datagram_, Below(kFrame));
  }
  void Request() {
    resend_t resend{};
    resend.header.run_id = runtime::ReadInt64(payload_, runtime::kRunIdOffset);
    const std::int64_t step = runtime::ReadInt64(payload_, runtime::kStepOffset);
    resend.header.step =
        OneOf(std::array{step, step + 1, step / 2, std::int64_t{0}, std::int64_t{-1}, step + 1000,
                         std::numeric_limits<std::int64_t>::max()});
    resend.count = OneOf(std::array{1, 0, -1, 64, std::numeric_limits<std::int32_t>::max(),
                                    std::numeric_limits<std::int32_t>::min()});
    resend.channel = channel_;
    resend.requester = kRoles[Below(kRoles.size())].name;
    runtime::Encode(resend, payload_);
    channel_ = ChannelOf<resend_t>().name;
    Wrap();
  }

  std::mt19937_64 random_;
  std::vector<Kind> kinds_;
  std::map<std::string, Buffer, std::less<>> genuine_;
  std::map<std::string_view, std::int64_t> made_;
  std::uint64_t next_ = 0;
  std::string_view channel_;
  Buffer payload_;
  Buffer datagram_;
};

const std::vector<Attacker::Kind> Attacker::kKinds{
    {"noise", false, &Attacker::Noise},
    {"noise_on_a_channel", false, &Attacker::NoiseOnAChannel},
    {"not_finite", true, &Attacker::NotFinite},
    {"wrong_step", true, &Attacker::WrongStep},
    {"foreign_run", true, &Attacker::ForeignRun},
    {"wrong_type", true, &Attacker::WrongType},
    {"truncated", true, &Attacker::Truncated},
    {"oversized", true, &Attacker::Oversized},
    {"fragment", false, &Attacker::Fragment},
    {"request", true, &Attacker::Request},
    {"replayed", true, &Attacker::Wrap},
};

Attacker::Attacker(std::uint64_t seed, const std::string& only) : random_(seed) {
  std::ranges::copy_if(kKinds, std::back_inserter(kinds_),
                       [&only](const Kind& kind) { return only.empty() || kind.name == only; });
  if (kinds_.empty()) throw std::invalid_argument("--only " + only + ": no such kind");
}

int Main(int argc, char** argv) {
  CLI::App app{"Throws datagrams at a multicast group that no process there may accept."};
  std::string group = "239.255.76.67";
  int port = 7667;
  int ttl = 0;
  double rate_hz = 20'000;
  double seconds = 5;
  std::uint64_t seed = 1;
  app.add_option("--group", group, "Multicast group")->capture_default_str();
  app.add_option("--port", port, "UDP port")->capture_default_str();
  app.add_option("--ttl", ttl, "0: this machine only")->capture_default_str();
  app.add_option("--rate", rate_hz, "Datagrams a second")->capture_default_str();
  app.add_option("--seconds", seconds, "For so long, or until SIGTERM")->capture_default_str();
  std::string only;
  app.add_option("--only", only, "One kind alone, such as request");
  app.add_option("--seed", seed, "Another seed, other datagrams")->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  std::signal(SIGTERM, [](int) { stopped = 1; });
  Group network(group, port, ttl);
  Attacker attacker(seed, only);
  std::int64_t sent = 0;
  const auto began = SteadyClock::now();
  double elapsed_s = 0;
  while (stopped == 0 && elapsed_s < seconds) {
    for (runtime::Bytes heard = network.Receive(); !heard.empty(); heard = network.Receive()) {
      attacker.Learn(heard);
    }
    // If this process got no processor time for a while, the loop now sends the datagrams that are
    // due. So the rate is right on average.
    while (static_cast<double>(sent) < rate_hz * elapsed_s && stopped == 0) {
      network.Send(attacker.Next());
      ++sent;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    elapsed_s = std::chrono::duration<double>(SteadyClock::now() - began).count();
  }
  fmt::print("{{\"sent\": {}, \"seconds\": {:.3f}", sent, elapsed_s);
  for (const auto& [name, count] : attacker.made()) fmt::print(", \"{}\": {}", name, count);
  fmt::print("}}\n");
  return 0;
}

}  // namespace
}  // namespace fogline::test

int main(int argc, char** argv) { return fogline::test::Main(argc, argv); }
