# cmake -DOUT=FILE -DLCM_FILES="a.lcm;b.lcm" -P message_fields.cmake
# Writes a header with VisitFields(message, visit) for every message type. Code that compares,
# checks or exports messages needs the names of the fields. The generated C++ types do not contain
# these names.
set(text "// Made from lcmtypes/*.lcm; do not edit.\n#pragma once\n\n#include <span>\n#include <vector>\n\n")
set(body "")
foreach(file IN LISTS LCM_FILES)
  get_filename_component(type "${file}" NAME_WE)
  string(APPEND text "#include \"fogline/${type}.hpp\"\n")
  string(APPEND body
    "template <class Visit>\nvoid VisitFields(const ${type}& m, Visit&& visit) {\n")
  file(READ "${file}" source)
  string(REGEX REPLACE "//[^\n]*" "" source "${source}")
  string(REGEX REPLACE "const [^;]*;" "" source "${source}")
  string(REGEX MATCHALL "[a-z0-9_]+ +[a-z0-9_]+(\\[[a-z0-9_]+\\])*;" fields "${source}")
  foreach(field IN LISTS fields)
    if(field STREQUAL "")
      continue()
    endif()
    string(REGEX MATCH "^[a-z0-9_]+ +([a-z0-9_]+)(.*)$" _ "${field}")
    set(name "${CMAKE_MATCH_1}")
    set(dims "${CMAKE_MATCH_2}")
    if(name STREQUAL "fogline")
      continue()
    elseif(dims MATCHES "\\]\\[")
      string(APPEND body "  visit(\"${name}\", std::span(&m.${name}[0][0], sizeof(m.${name}) / sizeof(m.${name}[0][0])));\n")
    elseif(dims MATCHES "\\[")
      string(APPEND body "  visit(\"${name}\", ListOf(m.${name}));\n")
    else()
      string(APPEND body "  visit(\"${name}\", m.${name});\n")
    endif()
  endforeach()
  string(APPEND body "}\n\n")
endforeach()
# A list has the type std::span<const T>, also if the message has a fixed number of elements.
set(list_of
"template <class T>
std::span<const T> ListOf(const std::vector<T>& list) {
  return list;
}
template <class T, std::size_t n>
std::span<const T> ListOf(const T (&list)[n]) {
  return list;
}

")
file(WRITE "${OUT}"
  "${text}\nnamespace fogline {\n\n${list_of}${body}}  // namespace fogline\n")
