#include "services/runtime/wire/channel_filter.h"

#include <lcm/lcm.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string_view>

#include <fmt/core.h>

#include "services/runtime/wire/message_signer.h"

namespace fogline::runtime {
namespace {

// A filter of a UDP socket sees the datagram from the UDP header on.
constexpr std::uint32_t kMagicOffset = 8;
constexpr std::uint32_t kChannelOffset = kMagicOffset + 8;
constexpr auto kMaxDatagram = static_cast<std::uint32_t>(kChannelOffset + kLongestChannel + 1 +
                                                         kMaxMessageBytes + kSignatureBytes);

static_assert(kLongestChannel == LCM_MAX_CHANNEL_NAME_LENGTH);

constexpr std::uint32_t kWholeDatagram = 0xffffffff;
constexpr std::uint32_t kNothing = 0;

sock_filter Load(std::size_t size, std::size_t offset) {
  const unsigned width = size == 4 ? BPF_W : size == 2 ? BPF_H : BPF_B;
  return BPF_STMT(static_cast<std::uint16_t>(BPF_LD | BPF_ABS | width),
                  static_cast<std::uint32_t>(offset));
}

/// Converts the distance of a jump to the one byte in which an instruction stores the distance.
/// @throws std::logic_error if the distance does not fit into one byte
std::uint8_t Jump(std::size_t instructions) {
  if (instructions > std::numeric_limits<std::uint8_t>::max()) {
    throw std::logic_error(fmt::format("a filter would jump over {} instructions", instructions));
  }
  return static_cast<std::uint8_t>(instructions);
}

/// Skips `skip` instructions if the value that was loaded last is not `value`.
sock_filter SkipUnless(std::uint32_t value, std::size_t skip) {
  return BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0, Jump(skip));
}

/// Skips `skip` instructions if the value that was loaded last is `value`.
sock_filter SkipIf(std::uint32_t value, std::size_t skip) {
  return BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, Jump(skip), 0);
}

sock_filter Take(std::uint32_t bytes) { return BPF_STMT(BPF_RET | BPF_K, bytes); }

std::uint32_t BigEndian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (const char byte : bytes) value = (value << 8) | static_cast<std::uint8_t>(byte);
  return value;
}

/// Appends instructions that compare the datagram with `text` at offset `at`. If the datagram
/// differs, the filter skips the rest of these instructions and the next `then` instructions.
void AppendText(std::string_view text, std::size_t at, std::size_t then,
                std::vector<sock_filter>& program) {
  struct Piece {
    std::size_t offset;
    std::size_t size;
  };
  std::vector<Piece> pieces;
  for (std::size_t offset = 0; offset < text.size();) {
    const std::size_t left = text.size() - offset;
    const std::size_t size = left >= 4 ? 4 : left >= 2 ? 2 : 1;
    pieces.push_back({offset, size});
    offset += size;
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto [offset, size] = pieces[i];
    const std::size_t rest = 2 * (pieces.size() - 1 - i) + then;
    program.push_back(Load(size, at + offset));
    program.push_back(SkipUnless(BigEndian(text.substr(offset, size)), rest));
  }
}

/// Appends instructions for one wanted channel: they accept or drop a datagram of this channel. For
/// a datagram of another channel, the program continues after these instructions.
void AppendWanted(const Wanted& wanted, std::vector<sock_filter>& program) {
  const std::string_view name(wanted.channel.c_str(), wanted.channel.size() + 1);  // with final 0
  std::vector<sock_filter> contents;
  if (wanted.share < 1) {
    constexpr double kRandomMax = 4294967295.0;
    const auto limit = static_cast<std::uint32_t>(std::max(0.0, wanted.share) * kRandomMax);
    contents.push_back(Load(4, static_cast<std::uint32_t>(SKF_AD_OFF + SKF_AD_RANDOM)));
    contents.push_back(BPF_JUMP(BPF_JMP | BPF_JGT | BPF_K, limit, 0, 1));
    contents.push_back(Take(kNothing));
  }
  for (const std::string& text : wanted.contents.texts) {
    AppendText(text, kChannelOffset + name.size() + wanted.contents.offset, 1, contents);
    contents.push_back(Take(kWholeDatagram));
  }
  contents.push_back(Take(wanted.contents.texts.empty() ? kWholeDatagram : kNothing));
  AppendText(name, kChannelOffset, contents.size(), program);
  program.insert(program.end(), contents.begin(), contents.end());
}

/// The beginning of every filter: drops a datagram that is not a whole LCM message, or that is too
/// large.
std::vector<sock_filter> WholeMessages() {
  return {
      BPF_STMT(BPF_LD | BPF_W | BPF_LEN, 0),
      BPF_JUMP(BPF_JMP | BPF_JGT | BPF_K, kMaxDatagram, 2, 0),  // drops longer datagrams
      Load(4, kMagicOffset),
      SkipIf(kLcmMessage, 1),  // continues with the channels
      Take(kNothing),
  };
}

}  // namespace

std::vector<sock_filter> ChannelFilter(std::vector<Wanted> wanted) {
  std::vector<sock_filter> program = WholeMessages();
  // If a filter reads beyond the end of a datagram, the kernel drops the datagram. Therefore short
  // names are compared first. A name that is compared before the matching name is at most as long
  // as the matching name. So its comparison stays within the datagram.
  std::ranges::stable_sort(wanted, {}, [](const Wanted& one) { return one.channel.size(); });
  for (const Wanted& one : wanted) AppendWanted(one, program);
  program.push_back(Take(kNothing));
  return program;
}

std::vector<sock_filter> AnyChannelFilter() {
  std::vector<sock_filter> program = WholeMessages();
  // Looks for the 0 after the channel's name. If the filter reads beyond the end of a datagram, the
  // datagram is dropped.
  constexpr std::size_t kPlaces = kLongestChannel + 1;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    program.push_back(Load(1, kChannelOffset + i));
    program.push_back(SkipIf(0, 2 * (kPlaces - 1 - i) + 1));
  }
  program.push_back(Take(kNothing));
  program.push_back(Take(kWholeDatagram));
  return program;
}

bool AttachFilter(int socket, std::vector<sock_filter> program) {
  if (program.size() > BPF_MAXINSNS) {
    throw std::logic_error(fmt::format("a filter of {} instructions", program.size()));
  }
  const sock_fprog filter{.len = static_cast<unsigned short>(program.size()),
                          .filter = program.data()};
  return setsockopt(socket, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof(filter)) == 0;
}

}  // namespace fogline::runtime
