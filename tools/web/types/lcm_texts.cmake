# cmake -DOUT=FILE.cc -DLCM_FILES="a.lcm;b.lcm" -P lcm_texts.cmake: writes the definition of
# LcmTexts() in lcm_texts.h, with each file as a raw string. So the program knows the types of its
# build, and needs no path to the files at run time.
set(texts "")
foreach(file IN LISTS LCM_FILES)
  get_filename_component(name "${file}" NAME)
  file(READ "${file}" text)
  string(APPEND texts "    {\"${name}\", R\"lcm(${text})lcm\"},\n")
endforeach()
file(WRITE "${OUT}" "// Made from lcmtypes/*.lcm; do not edit.
#include \"tools/web/types/lcm_texts.h\"

namespace fogline::web {
namespace {

constexpr LcmText kTexts[] = {
${texts}};

}  // namespace

std::span<const LcmText> LcmTexts() { return kTexts; }

}  // namespace fogline::web
")
