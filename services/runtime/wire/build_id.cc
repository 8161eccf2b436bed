#include "services/runtime/wire/build_id.h"

#include <elf.h>
#include <link.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/core.h>

namespace fogline::runtime {
namespace {

// Linkers put the program headers after the ELF header, and the notes after the program headers. So
// the first 64 KiB of a file contain everything that this code needs.
constexpr std::size_t kBeginning = 1 << 16;
// A note's name and content each begin at a multiple of this number of bytes.
constexpr std::size_t kNoteAlignment = 4;
constexpr std::string_view kNoteOwner("GNU\0", 4);

/// The structure at an offset; nullopt if the bytes end before the end of the structure.
template <class T>
std::optional<T> At(Bytes bytes, std::size_t offset) {
  if (offset > bytes.size() || bytes.size() - offset < sizeof(T)) return std::nullopt;
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

/// `size` bytes from `offset` on, or fewer if the bytes end earlier.
Bytes Part(Bytes bytes, std::size_t offset, std::size_t size) {
  const Bytes rest = bytes.subspan(std::min(offset, bytes.size()));
  return rest.first(std::min(size, rest.size()));
}

std::size_t Aligned(std::size_t size) {
  return (size + kNoteAlignment - 1) / kNoteAlignment * kNoteAlignment;
}

/// The build id among the notes of a segment; kUnknownBuild if no note contains it.
BuildId BuildIdAmong(Bytes notes) {
  while (const auto note = At<ElfW(Nhdr)>(notes, 0)) {
    const std::size_t name_end = sizeof(*note) + Aligned(note->n_namesz);
    const Bytes name = Part(notes, sizeof(*note), note->n_namesz);
    const Bytes content = Part(notes, name_end, note->n_descsz);
    const auto id = At<std::array<std::uint8_t, sizeof(BuildId)>>(content, 0);
    if (note->n_type == NT_GNU_BUILD_ID && id && std::ranges::equal(name, kNoteOwner)) {
      return ReadInt64(*id, 0);
    }
    notes = notes.subspan(std::min(name_end + Aligned(note->n_descsz), notes.size()));
  }
  return kUnknownBuild;
}

}  // namespace

BuildId BuildIdIn(Bytes file) {
  const auto header = At<ElfW(Ehdr)>(file, 0);
  if (!header || std::memcmp(header->e_ident, ELFMAG, SELFMAG) != 0) return kUnknownBuild;
  if (header->e_phentsize != sizeof(ElfW(Phdr))) return kUnknownBuild;
  for (std::size_t i = 0; i < header->e_phnum; ++i) {
    const auto segment = At<ElfW(Phdr)>(file, header->e_phoff + i * sizeof(ElfW(Phdr)));
    if (!segment) break;
    if (segment->p_type != PT_NOTE) continue;
    const BuildId id = BuildIdAmong(Part(file, segment->p_offset, segment->p_filesz));
    if (id != kUnknownBuild) return id;
  }
  return kUnknownBuild;
}

BuildId BuildIdOf(const std::filesystem::path& program) {
  std::ifstream in(program, std::ios::binary);
  std::vector<std::uint8_t> beginning(kBeginning);
  in.read(reinterpret_cast<char*>(beginning.data()), std::ssize(beginning));
  return BuildIdIn(Part(beginning, 0, static_cast<std::size_t>(in.gcount())));
}

BuildId OwnBuildId() {
  static const BuildId id = BuildIdOf("/proc/self/exe");
  return id;
}

std::string BuildText(BuildId build) {
  return build == kUnknownBuild ? "unknown"
                                : fmt::format("{:016x}", static_cast<std::uint64_t>(build));
}

}  // namespace fogline::runtime
