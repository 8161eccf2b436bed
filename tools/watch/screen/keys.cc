#include "tools/watch/screen/keys.h"

#include <array>
#include <utility>

namespace fogline::watch {
namespace {

constexpr char kEscape = '\033';

struct Sequence {
  std::string_view bytes;
  Key key;
};

// A terminal sends the cursor keys in one of two forms. The mode of the terminal determines the
// form.
constexpr std::array kSequences{
    Sequence{"\033[A", Key::kUp},      Sequence{"\033OA", Key::kUp},
    Sequence{"\033[B", Key::kDown},    Sequence{"\033OB", Key::kDown},
    Sequence{"\033[C", Key::kOpen},    Sequence{"\033OC", Key::kOpen},
    Sequence{"\033[D", Key::kClose},   Sequence{"\033OD", Key::kClose},
    Sequence{"\033[5~", Key::kPageUp}, Sequence{"\033[6~", Key::kPageDown},
    Sequence{"\033[H", Key::kHome},    Sequence{"\033OH", Key::kHome},
    Sequence{"\033[1~", Key::kHome},   Sequence{"\033[7~", Key::kHome},
    Sequence{"\033[F", Key::kEnd},     Sequence{"\033OF", Key::kEnd},
    Sequence{"\033[4~", Key::kEnd},    Sequence{"\033[8~", Key::kEnd},
};

std::optional<Key> KeyOf(char byte) {
  switch (byte) {
    case 'k':
      return Key::kUp;
    case 'j':
      return Key::kDown;
    case ' ':
      return Key::kPageDown;
    case 'b':
      return Key::kPageUp;
    case 'g':
      return Key::kHome;
    case 'G':
      return Key::kEnd;
    case '\t':
      return Key::kNextTable;
    case '\n':
    case '\r':
    case 'l':
      return Key::kOpen;
    case 'h':
    case '\b':
    case '\x7f':
      return Key::kClose;
    case 's':
      return Key::kSort;
    case 'r':
      return Key::kReverse;
    case 'q':
      return Key::kQuit;
    default:
      return std::nullopt;
  }
}

/// The length of the escape sequence at the front; 0 if its end has not come yet.
std::size_t LengthOfSequence(std::string_view bytes) {
  if (bytes.size() < 2) return 0;
  if (bytes[1] == 'O') return bytes.size() < 3 ? 0 : 3;
  if (bytes[1] != '[') return 1;  // the key Escape, then another key
  for (std::size_t i = 2; i < bytes.size(); ++i) {
    if (bytes[i] >= '@' && bytes[i] <= '~') return i + 1;  // the final byte
  }
  return 0;
}

}  // namespace

std::optional<Key> KeyReader::Next(bool complete) {
  while (!bytes_.empty()) {
    if (bytes_.front() != kEscape) {
      const char byte = bytes_.front();
      bytes_.erase(0, 1);
      if (const auto key = KeyOf(byte)) return key;
      continue;
    }
    std::size_t length = LengthOfSequence(bytes_);
    if (length == 0 && !complete) return std::nullopt;
    if (length == 0) length = bytes_.size();
    const std::string sequence = bytes_.substr(0, length);
    bytes_.erase(0, length);
    if (sequence.size() == 1) return Key::kClose;
    for (const Sequence& known : kSequences) {
      if (known.bytes == sequence) return known.key;
    }
  }
  return std::nullopt;
}

}  // namespace fogline::watch
