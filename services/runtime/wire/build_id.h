// The build of the program that a process runs. The linker computes a hash of everything that it
// links, and writes this hash into the program (the program's GNU build id). So two programs of the
// same name have the same build id only if they have the same code. The build id distinguishes
// builds but proves nothing: a process may report any number.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "services/runtime/wire/wire.h"

namespace fogline::runtime {

/// The first 8 bytes of a program's GNU build id.
using BuildId = std::int64_t;
/// Stands for the build id of a program that has no build id or does not report it.
inline constexpr BuildId kUnknownBuild = 0;

/// The build id in the first bytes of a program's file (ELF, of this machine's byte order);
/// kUnknownBuild if these bytes contain no build id. The bytes must include the notes of the file,
/// because one of them contains the build id.
BuildId BuildIdIn(Bytes file);
/// The build id of a program's file; kUnknownBuild if the file cannot be read or has no build id.
BuildId BuildIdOf(const std::filesystem::path& program);
/// The build id of this process, even if the program's file has been replaced since the start of
/// the process.
BuildId OwnBuildId();

/// 16 hexadecimal digits, or "unknown".
std::string BuildText(BuildId build);

}  // namespace fogline::runtime
