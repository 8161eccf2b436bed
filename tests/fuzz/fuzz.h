// What every fuzz target is made of. A target is one file, NAME_fuzz.cc: Seeds(), and the function
// that libFuzzer calls with ever other bytes, which ends the program when an invariant does not
// hold. fuzz_NAME_replay calls it with the same bytes each time (replay.cc).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "services/runtime/wire.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace fogline::fuzz {

using Input = std::vector<std::uint8_t>;

/// Each target's inputs to begin with, made by whatever makes them in a run: they are of the
/// present message types and formats however these change.
std::vector<Input> Seeds();

/// Ends the program with what does not hold.
void Demand(bool holds, const char* what);

/// To be called when an input is not refused. Inputs that are all refused, or all taken, would test
/// nothing.
void Took();
/// Calls of Took() so far.
long Taken();

/// A file in memory, for what reads files.
class MemoryFile {
 public:
  explicit MemoryFile(Bytes content = {});
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  /// As long as this object lives.
  std::filesystem::path path() const;
  Input Content() const;

 private:
  int fd_;
};

/// Takes an input apart from front to back; beyond the end there are zeros and nothing.
class Cutter {
 public:
  explicit Cutter(Bytes input) : rest_(input) {}

  bool empty() const { return rest_.empty(); }
  std::uint8_t Byte();
  /// A datagram: two bytes of length, big endian, and so many bytes as far as they are there and
  /// may be published.
  Bytes Datagram();

 private:
  Bytes rest_;
};

/// Adds what Datagram() takes.
void AddDatagram(Bytes bytes, Input& input);

/// Whether a text may be written to any terminal: no control characters but line feeds.
bool Printable(std::string text);

}  // namespace fogline::fuzz
