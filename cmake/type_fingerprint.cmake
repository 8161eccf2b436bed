# cmake -DOUT=FILE -DLCM_FILES="a.lcm;b.lcm" -P type_fingerprint.cmake
# Writes a header with TypeFingerprint(), a number computed from all message types of a run. With
# this header, a program that uses only Fogline's types can report the types that it was built with.
set(includes "")
set(hashes "")
foreach(file IN LISTS LCM_FILES)
  get_filename_component(type "${file}" NAME_WE)
  # The fingerprint does not cover these types, because their messages are not part of a run. So a
  # role that was built without these types can take part in a run.
  if(type MATCHES "^(beacon|log_graph|log_priority|log_seal|wall_clock)_t$")
    continue()
  endif()
  string(APPEND includes "#include \"fogline/${type}.hpp\"\n")
  string(APPEND hashes "      ${type}::getHash(),\n")
endforeach()
file(WRITE "${OUT}" "// Made from lcmtypes/*.lcm; do not edit.
#pragma once

#include <cstdint>

${includes}
namespace fogline {

/// One number that two builds share only if all message types of a run agree.
inline std::int64_t TypeFingerprint() {
  const std::int64_t hashes[] = {
${hashes}  };
  std::uint64_t fingerprint = 0;
  for (const std::int64_t hash : hashes) {
    fingerprint = ((fingerprint << 5) | (fingerprint >> 59)) ^ static_cast<std::uint64_t>(hash);
  }
  return static_cast<std::int64_t>(fingerprint);
}

}  // namespace fogline
")
