// Checks the scenario reader with mutations of a file, the same ones each time:
//   scenario_fuzz_seeded COUNT FILE
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/fuzz/scenario_fuzz.h"

namespace {

constexpr std::uint64_t kSeed = 20'240'101;
constexpr std::size_t kMaxEdits = 4;

// Values that readers trip over.
constexpr std::string_view kValues[] = {"0",
                                        "-0",
                                        "-1",
                                        "1e400",
                                        "1e-400",
                                        "9223372036854775808",
                                        "NaN",
                                        "true",
                                        "null",
                                        "\"\"",
                                        "\"\\ud800\"",
                                        "\"\\u0000\"",
                                        "\"\xff\"",
                                        "[]",
                                        "{}",
                                        "[[[[[[[[[",
                                        "{\"a\":{\"a\":{",
                                        "\"recorded\"",
                                        "0.1",
                                        "20",
                                        "\"20\"",
                                        "[1,2,3]",
                                        "[{}]",
                                        "\"\xc3\xa4\""};

class Mutator {
 public:
  explicit Mutator(std::string text) : text_(std::move(text)), tokens_(Split(text_)) {}

  std::string Next() { return Below(2) == 0 ? WithChangedBytes() : WithChangedTokens(); }

 private:
  // Strings, words with the characters of a number, space, and each other byte alone.
  static std::vector<std::string> Split(std::string_view text) {
    std::vector<std::string> tokens;
    while (!text.empty()) {
      std::size_t size = 1;
      if (text[0] == '"') {
        size = std::min(text.find('"', 1), text.size() - 1) + 1;
      } else if (IsWord(text[0])) {
        while (size < text.size() && IsWord(text[size])) ++size;
      }
      tokens.emplace_back(text.substr(0, size));
      text.remove_prefix(size);
    }
    return tokens;
  }
  static bool IsWord(char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || c == '-' || c == '+' || c == '.';
  }

  std::size_t Below(std::size_t n) { return static_cast<std::size_t>(engine_() % n); }

  std::string WithChangedBytes() {
    std::string text = text_;
    for (std::size_t n = 1 + Below(kMaxEdits); n > 0 && !text.empty(); --n) {
      const std::size_t at = Below(text.size());
      const auto byte = static_cast<char>(Below(256));
      switch (Below(5)) {
        case 0:
          text[at] = byte;
          break;
        case 1:
          text.insert(at, 1, byte);
          break;
        case 2:
          text.erase(at, 1 + Below(8));
          break;
        case 3:
          text[at] = static_cast<char>(text[at] ^ (1 << Below(8)));
          break;
        default:
          if (Below(8) == 0) text.resize(at);
          break;
      }
    }
    return text;
  }

  // Keys and values change places, vanish, double, or become what readers trip over.
  std::string WithChangedTokens() {
    std::vector<std::string> tokens = tokens_;
    for (std::size_t n = 1 + Below(kMaxEdits); n > 0; --n) {
      std::string& token = tokens[Below(tokens.size())];
      switch (Below(4)) {
        case 0:
          token = tokens_[Below(tokens_.size())];
          break;
        case 1:
          token.clear();
          break;
        case 2:
          token += token;
          break;
        default:
          token = kValues[Below(std::size(kValues))];
          break;
      }
    }
    std::string text;
    for (const std::string& token : tokens) text += token;
    return text;
  }

  std::string text_;
  std::vector<std::string> tokens_;
  std::mt19937_64 engine_{kSeed};
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: scenario_fuzz_seeded COUNT FILE\n");
    return 2;
  }
  std::ifstream file(argv[2], std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (text.empty()) {
    std::fprintf(stderr, "%s: cannot be read\n", argv[2]);
    return 2;
  }
  Mutator mutator(std::move(text));
  const long count = std::strtol(argv[1], nullptr, 10);
  long refused = 0;
  for (long i = 0; i < count; ++i) {
    if (!fogline::DemandScenarioOrMistakes(mutator.Next())) ++refused;
  }
  std::printf("%ld mutations: %ld refused with a place, %ld accepted\n", count, refused,
              count - refused);
  // Mutations that are all refused, or all accepted, would test nothing.
  return refused > 0 && refused < count ? 0 : 1;
}
