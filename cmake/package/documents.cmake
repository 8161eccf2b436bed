# Writes the copyright and the changelog of PACKAGE into OUT. Needs SOURCE (the source folder) and
# MAINTAINER. The changelog has the versions of CHANGELOG.md in Debian's form.
cmake_policy(VERSION 3.25)
file(MAKE_DIRECTORY "${OUT}")

file(READ "${SOURCE}/LICENSE" text)
set(text "Fogline: a distributed testbed for traded control in fog\n\n${text}")
# The pages that the programs of `fogline` make contain code of these packages.
if(PACKAGE STREQUAL "fogline")
  foreach(part IN ITEMS uplot three)
    file(READ "${SOURCE}/node_modules/${part}/LICENSE" licence)
    string(APPEND text "\n\nThe pages that fogline makes contain ${part}:\n\n${licence}")
  endforeach()
endif()
file(WRITE "${OUT}/copyright" "${text}")

find_program(AWK awk REQUIRED)
execute_process(
  COMMAND awk -v "package=${PACKAGE}" -v "maintainer=${MAINTAINER}"
          -f "${CMAKE_CURRENT_LIST_DIR}/changelog.awk" "${SOURCE}/CHANGELOG.md"
  COMMAND gzip -9n
  OUTPUT_FILE "${OUT}/changelog.gz"
  COMMAND_ERROR_IS_FATAL ANY)
