// The search for the build id in a program's file. Input: the file.
#include <elf.h>
#include <link.h>

#include <algorithm>
#include <cstring>
#include <string_view>

#include "services/runtime/wire/build_id.h"
#include "tests/fuzz/fuzz.h"

namespace fogline::fuzz {
namespace {

void DemandBytesOfTheFile(runtime::Bytes file) {
  const runtime::BuildId id = runtime::BuildIdIn(file);
  if (id == runtime::kUnknownBuild) return;
  Took();
  bool found = false;
  for (std::size_t at = 0; at + sizeof(id) <= file.size() && !found; ++at) {
    found = runtime::ReadInt64(file, at) == id;
  }
  Demand(found, "a build id stands in the file");
}

template <class T>
void Add(const T& value, Input& input) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
  input.insert(input.end(), bytes, bytes + sizeof(value));
}

void AddNote(std::uint32_t type, std::string_view name, std::size_t size, Input& input) {
  Add(ElfW(Nhdr){.n_namesz = static_cast<std::uint32_t>(name.size()),
                 .n_descsz = static_cast<std::uint32_t>(size),
                 .n_type = type},
      input);
  input.insert(input.end(), name.begin(), name.end());
  for (std::size_t i = 0; i < size; ++i) input.push_back(static_cast<std::uint8_t>(0xa0 + i));
}

/// A program file that consists of headers and notes only.
Input Program(bool with_build_id) {
  constexpr std::size_t kHashBytes = 20;
  constexpr std::string_view kGnu("GNU\0", 4);
  Input notes;
  AddNote(NT_GNU_ABI_TAG, kGnu, 16, notes);
  if (with_build_id) AddNote(NT_GNU_BUILD_ID, kGnu, kHashBytes, notes);
  ElfW(Ehdr) header{};
  std::memcpy(header.e_ident, ELFMAG, SELFMAG);
  header.e_phoff = sizeof(header);
  header.e_phentsize = sizeof(ElfW(Phdr));
  header.e_phnum = 2;
  ElfW(Phdr) load{};
  load.p_type = PT_LOAD;
  ElfW(Phdr) note{};
  note.p_type = PT_NOTE;
  note.p_offset = sizeof(header) + 2 * sizeof(ElfW(Phdr));
  note.p_filesz = notes.size();
  Input program;
  Add(header, program);
  Add(load, program);
  Add(note, program);
  program.insert(program.end(), notes.begin(), notes.end());
  return program;
}

}  // namespace

std::vector<Input> Seeds() { return {Program(true), Program(false)}; }

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fogline::fuzz::DemandBytesOfTheFile({data, size});
  return 0;
}
