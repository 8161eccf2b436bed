// The code that all fuzz targets share. A target is one file, NAME_fuzz.cc. The file defines
// Seeds() and the function that libFuzzer calls again and again with different bytes. This function
// ends the program if an invariant does not hold. fuzz_NAME_replay calls the function with the same
// bytes in each execution (replay.cc).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "services/runtime/wire/wire.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace fogline::fuzz {

using Input = std::vector<std::uint8_t>;

/// The inputs with which the fuzzing of a target begins. The target makes them with the code that
/// makes such bytes in a run. So the inputs always have the current message types and formats.
std::vector<Input> Seeds();

/// Ends the program with the text `what` if `holds` is false.
void Demand(bool holds, const char* what);

/// Counts an input that the target does not refuse; each target calls Took() for such inputs. A
/// target that refuses all mutations of its inputs, or takes all of them, tests nothing, and
/// replay.cc then fails.
void Took();
/// The number of calls of Took() so far.
long Taken();

/// A file in memory, for code that reads files.
class MemoryFile {
 public:
  explicit MemoryFile(runtime::Bytes content = {});
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  /// The path is valid during the lifetime of this object.
  std::filesystem::path path() const;
  Input Content() const;

 private:
  int fd_;
};

/// Splits an input into parts, from front to back. After the end of the input, Byte() returns 0 and
/// Datagram() returns an empty datagram.
class Cutter {
 public:
  explicit Cutter(runtime::Bytes input) : rest_(input) {}

  bool empty() const { return rest_.empty(); }
  std::uint8_t Byte();
  /// Returns the next datagram. In the input, a datagram has its length in two bytes, big endian,
  /// and then its bytes. The returned datagram is shorter than this length if the input ends, or if
  /// the length exceeds the limit for messages.
  runtime::Bytes Datagram();

 private:
  runtime::Bytes rest_;
};

/// Appends a datagram to `input` in the form that Datagram() reads.
void AddDatagram(runtime::Bytes bytes, Input& input);

/// Whether a text may be written to any terminal: it has no control characters except line feeds.
bool Printable(std::string text);

}  // namespace fogline::fuzz
