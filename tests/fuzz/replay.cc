// Runs a fuzz target on its seeds, on the files of its corpus, and on mutations of both. Each
// execution uses the same mutations.
//   fuzz_NAME_replay COUNT [FILE | FOLDER]...
//   fuzz_NAME_replay --seeds FOLDER     writes the seeds there, for libFuzzer
// If an input shows a mistake, the program writes the input into the file fuzz_NAME_replay.finding
// in its own folder.
#include <sanitizer/common_interface_defs.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "tests/fuzz/fuzz.h"

namespace fogline::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kSeed = 20'240'101;
constexpr std::size_t kMaxEdits = 4;

using namespace std::string_view_literals;

// Values that parsers often handle wrongly, as texts and as big-endian numbers.
constexpr std::string_view kValues[] = {"0"sv,
                                        "-0"sv,
                                        "-1"sv,
                                        "1e400"sv,
                                        "1e-400"sv,
                                        "9223372036854775808"sv,
                                        "NaN"sv,
                                        "true"sv,
                                        "null"sv,
                                        "\"\""sv,
                                        "\"\\ud800\""sv,
                                        "\"\\u0000\""sv,
                                        "\"\xff\""sv,
                                        "[]"sv,
                                        "{}"sv,
                                        "[[[[[[[[["sv,
                                        "{\"a\":{\"a\":{"sv,
                                        "\"recorded\""sv,
                                        "0.1"sv,
                                        "20"sv,
                                        "\"20\""sv,
                                        "[1,2,3]"sv,
                                        "[{}]"sv,
                                        "\"\xc3\xa4\""sv,
                                        "\x1b[2J"sv,
                                        "\0\0\0\0"sv,
                                        "\0\0\0\1"sv,
                                        "\x7f\xff\xff\xff"sv,
                                        "\x80\0\0\0"sv,
                                        "\xff\xff\xff\xff"sv,
                                        "\x7f\xff\xff\xff\xff\xff\xff\xff"sv,
                                        "\x80\0\0\0\0\0\0\0"sv,
                                        "\x7f\xf0\0\0\0\0\0\0"sv,
                                        "\x7f\xf8\0\0\0\0\0\0"sv};

class Mutator {
 public:
  explicit Mutator(const std::vector<Input>& inputs) : inputs_(inputs) {}

  Input Next() {
    Input input = Any();
    for (std::size_t n = 1 + Below(kMaxEdits); n > 0 && !input.empty(); --n) {
      if (Below(2) == 0) {
        ChangeByte(input);
      } else {
        ChangeToken(input);
      }
    }
    return input;
  }

 private:
  std::size_t Below(std::size_t n) { return static_cast<std::size_t>(engine_() % n); }
  const Input& Any() { return inputs_[Below(inputs_.size())]; }

  static auto At(Input& input, std::size_t place) {
    return input.begin() + static_cast<std::ptrdiff_t>(place);
  }

  void ChangeByte(Input& input) {
    const std::size_t at = Below(input.size());
    const auto byte = static_cast<std::uint8_t>(Below(256));
    switch (Below(5)) {
      case 0:
        input[at] = byte;
        break;
      case 1:
        input.insert(At(input, at), byte);
        break;
      case 2:
        input.erase(At(input, at), At(input, std::min(at + 1 + Below(8), input.size())));
        break;
      case 3:
        input[at] = static_cast<std::uint8_t>(input[at] ^ (1 << Below(8)));
        break;
      default:
        if (Below(8) == 0) input.resize(at);
        break;
    }
  }

  /// Replaces a token of the input, deletes it, doubles it, or overwrites the input from the
  /// beginning of the token with one of kValues. The replacement is a token of another input, or
  /// one of kValues.
  void ChangeToken(Input& input) {
    const auto [begin, end] = Token(input);
    Input token(At(input, begin), At(input, end));
    switch (Below(5)) {
      case 0: {
        Input other = Any();
        if (other.empty()) return;
        const auto [from, to] = Token(other);
        token.assign(At(other, from), At(other, to));
        break;
      }
      case 1:
        token.clear();
        break;
      case 2:
        token.insert(token.end(), token.begin(), token.end());
        break;
      case 3: {  // overwrites in place; the length of the input stays the same
        const std::string_view value = kValues[Below(std::size(kValues))];
        const std::size_t size = std::min(value.size(), input.size() - begin);
        std::copy_n(value.begin(), size, At(input, begin));
        return;
      }
      default: {
        const std::string_view value = kValues[Below(std::size(kValues))];
        token.assign(value.begin(), value.end());
        break;
      }
    }
    input.erase(At(input, begin), At(input, end));
    input.insert(At(input, begin), token.begin(), token.end());
  }

  /// Returns begin and end of a token: a string in quotation marks, a word of characters that
  /// numbers have, or up to 64 bytes of any kind.
  std::pair<std::size_t, std::size_t> Token(Input& input) {
    std::size_t begin = Below(input.size());
    const auto in_word = [&input](std::size_t at) {
      return at < input.size() && IsWord(input[at]);
    };
    if (input[begin] == '"') {
      const auto close = std::find(At(input, begin + 1), input.end(), '"');
      return {begin, static_cast<std::size_t>(close - input.begin()) + (close != input.end())};
    }
    if (!in_word(begin)) return {begin, std::min(begin + 1 + Below(64), input.size())};
    std::size_t end = begin + 1;
    while (begin > 0 && in_word(begin - 1)) --begin;
    while (in_word(end)) ++end;
    return {begin, end};
  }
  static bool IsWord(std::uint8_t c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || c == '-' || c == '+' || c == '.';
  }

  const std::vector<Input>& inputs_;
  std::mt19937_64 engine_{kSeed};
};

Input ContentOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    fmt::print(stderr, "{}: cannot be read\n", file.string());
    std::exit(2);
  }
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The files of a folder in the order of their names, or the file itself.
std::vector<fs::path> FilesIn(const fs::path& path) {
  if (!fs::is_directory(path)) return {path};
  std::vector<fs::path> files{fs::directory_iterator(path), {}};
  std::ranges::sort(files);
  return files;
}

std::string finding_path;
runtime::Bytes running;

void SaveFinding() {
  std::ofstream out(finding_path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(running.data()),
            static_cast<std::streamsize>(running.size()));
  out.close();
  fmt::print(stderr, "the input is in {}\n", finding_path);
}

/// @return whether the target accepted the input
bool Run(const Input& input) {
  // The block has exactly the input's size, so a sanitizer sees a read beyond the input's end.
  const std::vector<std::uint8_t> exact(input.begin(), input.end());
  running = exact;
  const long before = Taken();
  LLVMFuzzerTestOneInput(exact.data(), exact.size());
  return Taken() > before;
}

int Replay(long count, const std::vector<fs::path>& paths) {
  std::vector<Input> inputs = Seeds();
  for (const fs::path& path : paths) {
    for (const fs::path& file : FilesIn(path)) inputs.push_back(ContentOf(file));
  }
  const auto known_taken = std::ranges::count_if(inputs, Run);
  Mutator mutator(inputs);
  long taken = 0;
  for (long i = 0; i < count; ++i) taken += Run(mutator.Next()) ? 1 : 0;
  fmt::print("{} inputs: {} taken; {} mutations: {} taken, {} refused\n", inputs.size(),
             known_taken, count, taken, count - taken);
  return taken > 0 && taken < count ? 0 : 1;
}

int WriteSeeds(const fs::path& folder) {
  fs::create_directories(folder);
  int number = 0;
  for (const Input& seed : Seeds()) {
    std::ofstream out(folder / fmt::format("seed-{}", number++), std::ios::binary);
    out.write(reinterpret_cast<const char*>(seed.data()),
              static_cast<std::streamsize>(seed.size()));
    if (!out) return 1;
  }
  return 0;
}

}  // namespace
}  // namespace fogline::fuzz

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.size() == 2 && arguments[0] == "--seeds") {
    return fogline::fuzz::WriteSeeds(arguments[1]);
  }
  if (arguments.empty() || arguments[0].starts_with("-")) {
    fmt::print(stderr, "usage: {0} COUNT [FILE | FOLDER]...\n       {0} --seeds FOLDER\n", argv[0]);
    return 2;
  }
  fogline::fuzz::finding_path = std::string(argv[0]) + ".finding";
  __sanitizer_set_death_callback(fogline::fuzz::SaveFinding);
  std::signal(SIGABRT, [](int) { fogline::fuzz::SaveFinding(); });
  return fogline::fuzz::Replay(std::strtol(arguments[0].c_str(), nullptr, 10),
                               {arguments.begin() + 1, arguments.end()});
}
