// Which build of a program a process is. The linker writes a hash of all that it links into the
// program (its GNU build id), so two programs of one name share it only if their code is the same.
// It tells builds apart, and proves nothing: a process may say what it likes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "services/runtime/wire.h"

namespace fogline {

/// The first 8 bytes of a program's GNU build id.
using BuildId = std::int64_t;
/// Of a program without one, or that does not say it.
inline constexpr BuildId kUnknownBuild = 0;

/// The build id in the beginning of a program's file (ELF, of this machine's byte order), with its
/// notes.
BuildId BuildIdIn(Bytes file);
/// That of a program's file.
BuildId BuildIdOf(const std::filesystem::path& program);
/// That of this process, also when its file has been replaced since it was started.
BuildId OwnBuildId();

/// 16 hexadecimal digits, or "unknown".
std::string BuildText(BuildId build);

}  // namespace fogline
