# cmake -DOUT=FILE.cc -DDIR=FOLDER -P embed.cmake: writes the function Assets() of assets.h with
# every file of the folder and of its subfolders. The assembler puts the bytes of each file
# unchanged into the program. So the program contains its page, and needs no path to the page at run
# time. Without the folder, the list of files is empty. A program with a second page gives the
# function of this page another name with -DNAME=NAME.
if(NOT NAME)
  set(NAME Assets)
endif()
set(type_html "text/html; charset=utf-8")
set(type_css "text/css; charset=utf-8")
set(type_js "text/javascript; charset=utf-8")
set(type_txt "text/plain; charset=utf-8")
set(type_json application/json)
set(type_map application/json)
set(type_webmanifest application/manifest+json)
set(type_svg image/svg+xml)
set(type_png image/png)
set(type_ico image/x-icon)
set(type_woff2 font/woff2)

file(GLOB_RECURSE files RELATIVE "${DIR}" "${DIR}/*")
list(SORT files)

set(bytes "")
set(rows "")
set(number 0)
foreach(file IN LISTS files)
  get_filename_component(end "${file}" LAST_EXT)
  string(REPLACE "." "" end "${end}")
  if(NOT DEFINED "type_${end}")
    message(FATAL_ERROR "${file}: embed.cmake knows no media type for this name")
  endif()
  set(type "${type_${end}}")
  file(SHA256 "${DIR}/${file}" hash)
  string(SUBSTRING "${hash}" 0 32 hash)
  set(begin "fogline_${NAME}_${number}_begin")
  set(behind "fogline_${NAME}_${number}_end")
  string(APPEND bytes
    "asm(\".pushsection .rodata\\n\"\n"
    "    \"${begin}: .incbin \\\"${DIR}/${file}\\\"\\n\"\n"
    "    \"${behind}: .byte 0\\n\"\n"
    "    \".popsection\\n\");\n"
    "extern \"C\" const char ${begin}[];\n"
    "extern \"C\" const char ${behind}[];\n\n")
  string(APPEND rows
    "    Asset{\"/${file}\", \"${type}\", \"\\\"${hash}\\\"\",\n"
    "          {${begin}, static_cast<std::size_t>(${behind} - ${begin})}},\n")
  math(EXPR number "${number} + 1")
endforeach()

set(source "#include <array>\n#include <cstddef>\n\n#include \"tools/web/server/assets.h\"\n\n${bytes}")
string(APPEND source "namespace fogline::web {\n\nstd::span<const Asset> ${NAME}() {\n")
if(number GREATER 0)
  string(APPEND source
    "  static const std::array assets{\n${rows}  };\n"
    "  return assets;\n")
else()
  string(APPEND source "  return {};\n")
endif()
string(APPEND source "}\n\n}  // namespace fogline::web\n")
file(WRITE "${OUT}" "${source}")
